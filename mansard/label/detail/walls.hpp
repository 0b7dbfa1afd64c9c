// Walls that stand against each other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

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

/// All faces that `is_wall` of a solid's face says are walls, sorted by the box's west side.
[[nodiscard]] auto walls_of(std::span<const model::Solid> solids, const std::vector<std::vector<bool>>& is_wall)
    -> std::vector<Wall>;

/// The share of the wall's area that faces opposite walls of other solids within party_distance. Measured in
/// vertical strips of at most party_strip, on the wall's own vertical plane; overlapping neighbours count once.
[[nodiscard]] auto covered_share(const Wall& wall, std::span<const Wall> walls, std::span<const model::Solid> solids,
                                 const Options& options) -> double;

}  // namespace mansard::label::detail
