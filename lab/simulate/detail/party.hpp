// Where buildings stand wall to wall.
#pragma once

#include <vector>

#include "lab/simulate/simulate.hpp"

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

/// What of a building can be shared.
struct Standing {
  std::vector<geometry::Polygon> outlines;           ///< of what stands on the ground
  std::vector<std::vector<geometry::Point3>> walls;  ///< outer loops
};
[[nodiscard]] auto standing_of(const model::Building& building) -> Standing;

/// The party walls of buildings: stretches that their outlines share within `apart` metres.
[[nodiscard]] auto party_walls_of(const std::vector<Standing>& buildings, double apart) -> std::vector<PartyWall>;

inline constexpr double solids_touch = 0.02;  ///< m; solids keep their corners to within that

}  // namespace mansard::simulate::detail
