#include "mansard/extrude/detail/intersect.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mansard/extrude/detail/measure.hpp"
#include "mansard/geometry/predicates.hpp"

namespace mansard::extrude::detail {
namespace {

using geometry::Point2;
using geometry::Point3;

/// A coordinate plane on which the triangle keeps its area (exactly: its corners do not become collinear).
class Flattening {
 public:
  Flattening(Point3 a, Point3 b, Point3 c) {
    const Point3 n = cross(b - a, c - a);
    const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
    axis_ = z >= x && z >= y ? 2 : (x >= y ? 0 : 1);
  }
  [[nodiscard]] auto operator()(Point3 p) const -> Point2 {
    return axis_ == 2 ? Point2{p.x, p.y} : (axis_ == 0 ? Point2{p.y, p.z} : Point2{p.z, p.x});
  }

 private:
  int axis_;
};

auto in_triangle(Point2 a, Point2 b, Point2 c, Point2 p) -> bool {
  const int x = geometry::orientation(a, b, p), y = geometry::orientation(b, c, p), z = geometry::orientation(c, a, p);
  return (x >= 0 && y >= 0 && z >= 0) || (x <= 0 && y <= 0 && z <= 0);
}

/// Whether a side of the triangle surely has the segment on its far side, seen along one axis: then they are apart, and
/// nothing exact is needed. Neighbouring faces in one plane would need it most.
auto surely_apart(Point2 p, Point2 q, std::array<Point2, 3> triangle) -> bool {
  if (cross(triangle[1] - triangle[0], triangle[2] - triangle[0]) < 0) std::swap(triangle[1], triangle[2]);
  constexpr double bound = 1e-14;  // far above the 8 roundings of 2^-53 each
  for (std::size_t i = 0; i < 3; ++i) {
    const Point2 side = triangle[(i + 1) % 3] - triangle[i];
    const auto beyond = [&](Point2 v) {
      const Point2 to = v - triangle[i];
      const double l = side.x * to.y, r = side.y * to.x;
      return l - r < -bound * (std::abs(l) + std::abs(r));
    };
    if (beyond(p) && beyond(q)) return true;
  }
  return false;
}

/// Closed segment against closed triangle.
auto pierces(Point3 p, Point3 q, Point3 a, Point3 b, Point3 c) -> bool {
  const Flattening seen(a, b, c);
  if (surely_apart(seen(p), seen(q), {seen(a), seen(b), seen(c)})) return false;
  const int sp = above(a, b, c, p), sq = above(a, b, c, q);
  if (sp * sq > 0) return false;
  if (sp == 0 && sq == 0) {
    const auto& flat = seen;
    const geometry::Segment2 s{flat(p), flat(q)};
    return in_triangle(flat(a), flat(b), flat(c), s.start) || in_triangle(flat(a), flat(b), flat(c), s.end) ||
           geometry::meet(s, {flat(a), flat(b)}) || geometry::meet(s, {flat(b), flat(c)}) ||
           geometry::meet(s, {flat(c), flat(a)});
  }
  const int x = above(p, q, a, b), y = above(p, q, b, c), z = above(p, q, c, a);
  return (x >= 0 && y >= 0 && z >= 0) || (x <= 0 && y <= 0 && z <= 0);
}

}  // namespace

auto intersect(const std::vector<Point3>& vertices, const Corners& s, const Corners& t) -> bool {
  std::vector<std::uint32_t> shared;
  for (const std::uint32_t v : s)
    if (std::ranges::find(t, v) != t.end()) shared.push_back(v);
  const auto at = [&](std::uint32_t v) { return vertices[v]; };

  if (shared.size() == 3) return true;
  if (shared.size() == 2) {
    // Along the common edge is as it should be, unless one lies flat on the other.
    const auto third = [&](const Corners& c) {
      return *std::ranges::find_if(c, [&](std::uint32_t v) { return v != shared[0] && v != shared[1]; });
    };
    const Point3 a = at(shared[0]), b = at(shared[1]), p = at(third(s)), q = at(third(t));
    const Flattening flat(a, b, p);
    if (geometry::orientation(flat(a), flat(b), flat(p)) != geometry::orientation(flat(a), flat(b), flat(q)))
      return false;
    return above(a, b, p, q) == 0;
  }
  if (shared.size() == 1) {
    // Beyond the common corner the triangles meet if and only if the side across from it in one meets the other.
    const auto across = [&](const Corners& c) {
      const auto i = std::ranges::find(c, shared[0]) - c.begin();
      return std::array{at(c[(i + 1) % 3]), at(c[(i + 2) % 3])};
    };
    const auto a = across(s), b = across(t);
    return pierces(a[0], a[1], at(t[0]), at(t[1]), at(t[2])) || pierces(b[0], b[1], at(s[0]), at(s[1]), at(s[2]));
  }
  for (std::size_t i = 0; i < 3; ++i)
    if (pierces(at(s[i]), at(s[(i + 1) % 3]), at(t[0]), at(t[1]), at(t[2])) ||
        pierces(at(t[i]), at(t[(i + 1) % 3]), at(s[0]), at(s[1]), at(s[2])))
      return true;
  return false;
}

auto first_intersection(const std::vector<Point3>& vertices, const std::vector<Corners>& triangles,
                        const std::vector<std::uint32_t>& face_of) -> std::array<std::size_t, 2> {
  struct Box {
    Point3 least, most;
    std::size_t triangle;
  };
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Point3 a = vertices[triangles[i][0]], b = vertices[triangles[i][1]], c = vertices[triangles[i][2]];
    boxes.push_back({{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::min({a.z, b.z, c.z})},
                     {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}), std::max({a.z, b.z, c.z})},
                     i});
  }
  std::ranges::sort(boxes, [](const Box& p, const Box& q) {
    return p.least.x != q.least.x ? p.least.x < q.least.x : p.triangle < q.triangle;
  });
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (std::size_t j = i + 1; j < boxes.size() && boxes[j].least.x <= boxes[i].most.x; ++j) {
      const Box &p = boxes[i], &q = boxes[j];
      if (p.least.y > q.most.y || q.least.y > p.most.y || p.least.z > q.most.z || q.least.z > p.most.z) continue;
      if (face_of[p.triangle] == face_of[q.triangle]) continue;
      if (intersect(vertices, triangles[p.triangle], triangles[q.triangle])) return {p.triangle, q.triangle};
    }
  return {triangles.size(), triangles.size()};
}

}  // namespace mansard::extrude::detail
