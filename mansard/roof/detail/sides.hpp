// The straight sides of an outline, and which of them are ends.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "mansard/geometry/polygon.hpp"
#include "mansard/roof/roof.hpp"

namespace mansard::roof::detail {

/// A stretch of a ring without a real turn: edges first … first + count − 1, counted round the ring.
struct Side {
  std::size_t ring = 0;  ///< 0 the outer one, 1 … the holes
  std::size_t first = 0, count = 1;
  geometry::Point2 start, end;
  geometry::Point2 inward;  ///< unit
  double length = 0;        ///< m
};

[[nodiscard]] auto ring_of(const geometry::Polygon& polygon, std::size_t ring) -> const geometry::Ring&;

/// Ring by ring, in order. Turns under `side_turn` radians are none.
[[nodiscard]] auto sides_of(const geometry::Polygon& polygon, double side_turn) -> std::vector<Side>;

/// The smallest box around the outline, whatever its angle.
struct Extent {
  geometry::Point2 axis;         ///< unit, along the longer side
  double length = 0, width = 0;  ///< m, length ≥ width
};
[[nodiscard]] auto extent_of(const std::vector<Side>& sides) -> Extent;

/// Whether the outline fills its smallest box but for a little, and has no courtyard.
[[nodiscard]] auto nearly_rectangle(const geometry::Polygon& polygon, const Extent& extent, const Options& options)
    -> bool;

/// Per side: whether it looks along the axis rather than across it.
[[nodiscard]] auto ends_by_axis(const std::vector<Side>& sides, geometry::Point2 axis) -> std::vector<bool>;

/// Per side: whether it ends a wing: convex and about square at both corners, and so that its hip would be a whole
/// triangle, which no other side cuts into. Short ones first, never two neighbours.
[[nodiscard]] auto ends_of_wings(const geometry::Polygon& polygon, const std::vector<Side>& sides,
                                 const Options& options) -> std::vector<bool>;

}  // namespace mansard::roof::detail
