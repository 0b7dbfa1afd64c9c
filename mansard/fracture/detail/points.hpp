// Points on the grid. Only differences of coordinates are ever rounded or compared, so that whatever is computed here
// is the same bit for bit after a shift by whole metres, and turned or mirrored with the plane.
#pragma once

#include <algorithm>
#include <cmath>

#include "mansard/geometry/points.hpp"

namespace mansard::fracture::detail {

using geometry::Box2;
using geometry::Point2;
using geometry::Segment2;

/// Vertices lie on multiples of this, metres: fine beside any snap, coarse enough for differences to be exact.
inline constexpr double grid = 0x1.0p-24;
/// Coordinates up to this, metres, leave the grid five bits to spare.
inline constexpr double farthest = 1e7;

[[nodiscard]] inline auto to_grid(double metres) -> double { return std::nearbyint(metres / grid) * grid; }
[[nodiscard]] inline auto to_grid(Point2 p) -> Point2 { return {to_grid(p.x), to_grid(p.y)}; }
[[nodiscard]] inline auto square(double value) -> double { return value * value; }
[[nodiscard]] inline auto squared_distance(Point2 a, Point2 b) -> double { return geometry::dot(b - a, b - a); }
[[nodiscard]] inline auto distance(Point2 a, Point2 b) -> double { return std::sqrt(squared_distance(a, b)); }

/// Where along the segment the point's foot lies, in 0 … 1.
[[nodiscard]] inline auto foot_parameter(const Segment2& s, Point2 p) -> double {
  const Point2 d = s.end - s.start;
  const double squared = geometry::dot(d, d);
  return squared > 0 ? std::clamp(geometry::dot(p - s.start, d) / squared, 0.0, 1.0) : 0;
}
[[nodiscard]] inline auto squared_distance(const Segment2& s, Point2 p) -> double {
  const double t = foot_parameter(s, p);
  return squared_distance(s.start + t * (s.end - s.start), p);
}
/// The grid point nearest to the one at parameter t.
[[nodiscard]] inline auto at(const Segment2& s, double t) -> Point2 { return s.start + to_grid(t * (s.end - s.start)); }
/// Where along `s` the line through `other` crosses it. The two must not be parallel.
[[nodiscard]] inline auto crossing_parameter(const Segment2& s, const Segment2& other) -> double {
  const Point2 d = other.end - other.start;
  return geometry::cross(other.start - s.start, d) / geometry::cross(s.end - s.start, d);
}

}  // namespace mansard::fracture::detail
