// How long and how wide a set of points is.
#pragma once

#include <array>
#include <vector>

#include "mansard/geometry/points.hpp"

namespace mansard::geometry {

struct Extent {
  double width = 0, length = 0;     ///< m; width ≤ length
  std::array<Point2, 4> corners{};  ///< counterclockwise
};

/// The rectangle of the smallest area around the points, of several with one area the narrowest; 0 for
/// points on one line. Cost: O(n log n) and O(n) for each corner of their hull.
[[nodiscard]] auto extent_of(std::vector<Point2> points) -> Extent;

}  // namespace mansard::geometry
