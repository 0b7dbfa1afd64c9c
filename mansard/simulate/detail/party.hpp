// Where buildings stand wall to wall.
#pragma once

#include <vector>

#include "mansard/simulate/simulate.hpp"

namespace mansard::simulate::detail {

/// An edge of one of several outlines; `owner` says whose.
struct Side {
  geometry::Segment2 line;  ///< the interior on the left
  std::size_t owner = 0;
};

/// All edges of the polygons' rings.
void add_sides(const geometry::Polygon& polygon, std::size_t owner, std::vector<Side>& sides);

/// A stretch that sides of two owners share, running opposite ways within `apart` metres of each other.
struct Shared {
  std::size_t a = 0, b = 0;  ///< sides, a's owner below b's
  geometry::Segment2 line;   ///< along a
};
/// Ordered by a, then b. Stretches shorter than 0.2 m are left out.
[[nodiscard]] auto shared_sides(const std::vector<Side>& sides, double apart) -> std::vector<Shared>;

/// The party walls of a city with models.
[[nodiscard]] auto party_walls_of(const write::City& city) -> std::vector<PartyWall>;

}  // namespace mansard::simulate::detail
