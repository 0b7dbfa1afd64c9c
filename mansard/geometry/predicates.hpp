// Exact decisions in the plane.
#pragma once

#include "mansard/geometry/points.hpp"

namespace mansard::geometry {

/// The sign of the area of a, b, c: +1 a left turn, −1 a right turn, 0 collinear. Exact for all finite doubles.
[[nodiscard]] auto orientation(Point2 a, Point2 b, Point2 c) -> int;

/// Whether two closed segments have a point in common. Exact.
[[nodiscard]] auto meet(const Segment2& a, const Segment2& b) -> bool;

}  // namespace mansard::geometry
