// Walls that stand against each other.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mansard/geometry/box_index.hpp"
#include "mansard/geometry/points.hpp"
#include "mansard/label/label.hpp"
#include "mansard/model/solid.hpp"

namespace mansard::label::detail {

/// A wall face and where it is.
struct Wall {
  std::uint32_t solid = 0, face = 0;
  geometry::Box2 box;        ///< in plan
  geometry::Point2 outward;  ///< unit, horizontal
};

/// Those of some walls that face one part of the circle, and where they are.
struct Facing {
  std::vector<std::uint32_t> walls;  ///< by the number in the index
  geometry::BoxIndex places;
};

struct Walls {
  std::vector<Wall> all;
  std::array<Facing, 16> facing;  ///< from south over west and north back to south
};

/// All faces that `is_wall` of a solid's face says are walls, by solid and face.
[[nodiscard]] auto walls_of(std::span<const model::Solid> solids, const std::vector<std::vector<bool>>& is_wall)
    -> Walls;

/// The share of the wall's area that faces opposite walls of other solids within party_distance. Measured in
/// vertical strips of at most party_strip, on the wall's own vertical plane; overlapping neighbours count once.
[[nodiscard]] auto covered_share(const Wall& wall, const Walls& walls, std::span<const model::Solid> solids,
                                 const Options& options) -> double;

}  // namespace mansard::label::detail
