// Points and vectors in the plane and in space: double, metres, x east, y north, z up.
#pragma once

#include <algorithm>
#include <cmath>
#include <compare>
#include <limits>

namespace mansard::geometry {

struct Point2 {
  double x = 0, y = 0;
  friend auto operator<=>(const Point2&, const Point2&) = default;
  friend constexpr auto operator+(Point2 a, Point2 b) -> Point2 { return {a.x + b.x, a.y + b.y}; }
  friend constexpr auto operator-(Point2 a, Point2 b) -> Point2 { return {a.x - b.x, a.y - b.y}; }
  friend constexpr auto operator*(double k, Point2 a) -> Point2 { return {k * a.x, k * a.y}; }
};

struct Point3 {
  double x = 0, y = 0, z = 0;
  friend auto operator<=>(const Point3&, const Point3&) = default;
  friend constexpr auto operator+(Point3 a, Point3 b) -> Point3 { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr auto operator-(Point3 a, Point3 b) -> Point3 { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr auto operator*(double k, Point3 a) -> Point3 { return {k * a.x, k * a.y, k * a.z}; }
};

[[nodiscard]] constexpr auto dot(Point2 a, Point2 b) -> double { return a.x * b.x + a.y * b.y; }
[[nodiscard]] constexpr auto dot(Point3 a, Point3 b) -> double { return a.x * b.x + a.y * b.y + a.z * b.z; }
[[nodiscard]] constexpr auto cross(Point2 a, Point2 b) -> double { return a.x * b.y - a.y * b.x; }
[[nodiscard]] constexpr auto cross(Point3 a, Point3 b) -> Point3 {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[nodiscard]] inline auto length(Point2 a) -> double { return std::hypot(a.x, a.y); }
[[nodiscard]] inline auto length(Point3 a) -> double { return std::sqrt(dot(a, a)); }
/// The vector scaled to length 1; the zero vector stays zero.
template <class P>
[[nodiscard]] auto normalised(P a) -> P {
  const double l = length(a);
  return l > 0 ? (1 / l) * a : a;
}
[[nodiscard]] constexpr auto xy(Point3 a) -> Point2 { return {a.x, a.y}; }
/// Turned by 90° to the left: the interior side of a counter-clockwise ring's edge.
[[nodiscard]] constexpr auto left_of(Point2 direction) -> Point2 { return {-direction.y, direction.x}; }

struct Segment2 {
  Point2 start, end;
  friend auto operator<=>(const Segment2&, const Segment2&) = default;
};

/// An axis-parallel box; empty until something is put in.
struct Box2 {
  Point2 least{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Point2 most{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

  void add(Point2 p) {
    least = {std::min(least.x, p.x), std::min(least.y, p.y)};
    most = {std::max(most.x, p.x), std::max(most.y, p.y)};
  }
  [[nodiscard]] auto empty() const -> bool { return least.x > most.x; }
  [[nodiscard]] auto grown(double by) const -> Box2 { return {least - Point2{by, by}, most + Point2{by, by}}; }
  [[nodiscard]] auto overlaps(const Box2& o) const -> bool {
    return least.x <= o.most.x && o.least.x <= most.x && least.y <= o.most.y && o.least.y <= most.y;
  }
  [[nodiscard]] auto contains(Point2 p) const -> bool {
    return p.x >= least.x && p.x <= most.x && p.y >= least.y && p.y <= most.y;
  }
};

}  // namespace mansard::geometry
