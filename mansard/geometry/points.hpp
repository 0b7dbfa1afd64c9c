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
[[nodiscard]] inline auto length(Point2 a) -> double { return std::sqrt(dot(a, a)); }
[[nodiscard]] inline auto length(Point3 a) -> double { return std::sqrt(dot(a, a)); }
/// The vector scaled to length 1; the zero vector stays zero.
template <class P>
[[nodiscard]] auto normalised(P a) -> P {
  const double l = length(a);
  return l > 0 ? (1 / l) * a : a;
}
[[nodiscard]] constexpr auto xy(Point3 a) -> Point2 { return {a.x, a.y}; }
[[nodiscard]] constexpr auto xy(Point2 a) -> Point2 { return a; }
/// Turned by 90° to the left: the interior side of a counter-clockwise ring's edge.
[[nodiscard]] constexpr auto left_of(Point2 direction) -> Point2 { return {-direction.y, direction.x}; }

struct Segment2 {
  Point2 start, end;
  friend auto operator<=>(const Segment2&, const Segment2&) = default;
};

/// A rectangle along the axes; empty until points are added.
struct Box2 {
  Point2 least{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Point2 most{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

  /// Of a range of points, in plan or in space.
  template <class Points>
  [[nodiscard]] static auto of(const Points& points) -> Box2 {
    Box2 box;
    for (const auto& p : points) box.add(xy(p));
    return box;
  }
  [[nodiscard]] static auto of(const Segment2& segment) -> Box2 {
    Box2 box;
    box.add(segment.start);
    box.add(segment.end);
    return box;
  }
  void add(Point2 p) {
    least = {std::min(least.x, p.x), std::min(least.y, p.y)};
    most = {std::max(most.x, p.x), std::max(most.y, p.y)};
  }
  void include(const Box2& o) {
    least = {std::min(least.x, o.least.x), std::min(least.y, o.least.y)};
    most = {std::max(most.x, o.most.x), std::max(most.y, o.most.y)};
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

/// The same in space.
struct Box3 {
  Point3 least{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
               std::numeric_limits<double>::infinity()};
  Point3 most{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
              -std::numeric_limits<double>::infinity()};

  template <class Points>
  [[nodiscard]] static auto of(const Points& points) -> Box3 {
    Box3 box;
    for (const Point3& p : points) box.add(p);
    return box;
  }
  void add(Point3 p) {
    least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
    most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
  }
  void include(const Box3& o) {
    least = {std::min(least.x, o.least.x), std::min(least.y, o.least.y), std::min(least.z, o.least.z)};
    most = {std::max(most.x, o.most.x), std::max(most.y, o.most.y), std::max(most.z, o.most.z)};
  }
  [[nodiscard]] auto empty() const -> bool { return least.x > most.x; }
  [[nodiscard]] auto plan() const -> Box2 { return {xy(least), xy(most)}; }
  [[nodiscard]] auto overlaps(const Box3& o) const -> bool {
    return plan().overlaps(o.plan()) && least.z <= o.most.z && o.least.z <= most.z;
  }
};

}  // namespace mansard::geometry
