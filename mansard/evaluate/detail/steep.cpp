#include "mansard/evaluate/detail/steep.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mansard/geometry/angles.hpp"
#include "mansard/geometry/change.hpp"

namespace mansard::evaluate::detail {
namespace {

using geometry::Point2;
using geometry::Point3;

constexpr double off = 0.15, inset = 0.25;  // m; a scan's noise, and the width over which it melts edges
constexpr double turned = 20 * std::numbers::pi / 180;

/// The axes of a plane: level, and up the slope.
struct Axes {
  Point3 origin, level, up;

  explicit Axes(const RoofPlane& plane) : origin(plane.point) {
    level = normalised(cross(Point3{0, 0, 1}, plane.normal));
    up = cross(plane.normal, level);
  }
  [[nodiscard]] auto on(Point3 p) const -> Point2 { return {dot(p - origin, level), dot(p - origin, up)}; }
};

auto drawn(const model::ModelFace& face, const Axes& axes) -> base::Result<std::vector<geometry::Polygon>> {
  return geometry::make_valid(
      geometry::oriented(geometry::polygon_of(face.loops, [&](Point3 p) { return axes.on(p); })));
}

}  // namespace

auto carried(const RoofPlane& plane, const std::vector<const model::ModelFace*>& faces, const geometry::Mesh& scan,
             const std::vector<Point3>& normals) -> base::Result<double> {
  const Axes axes(plane);
  std::vector<geometry::Polygon> pieces;
  std::vector<Point3> corners;
  for (const auto* face : faces) {
    const auto flat = drawn(*face, axes);
    if (!flat) return flat.failure();
    pieces.insert(pieces.end(), flat->begin(), flat->end());
    corners.insert(corners.end(), face->loops[0].begin(), face->loops[0].end());
  }
  const auto whole = geometry::unite(pieces);
  if (!whole) return whole.failure();
  const auto inside = [&](Point3 p) {
    if (std::abs(dot(p - plane.point, plane.normal)) > off) return false;
    const auto at = axes.on(p);
    return std::ranges::any_of(
        *whole, [&](const auto& one) { return contains(one, at) && geometry::boundary_distance(one, at) > inset; });
  };
  const auto box = geometry::Box3::of(corners);
  const auto around = box.plan().grown(off);
  double sum = 0;
  for (std::size_t t = 0; t < scan.triangles.size(); ++t) {
    const auto& triangle = scan.triangles[t];
    const Point3 a = scan.vertices[triangle[0]], b = scan.vertices[triangle[1]], c = scan.vertices[triangle[2]];
    if (!around.contains(xy(a)) && !around.contains(xy(b)) && !around.contains(xy(c))) continue;
    if (std::abs(dot(normals[t], plane.normal)) < geometry::cosine(turned)) continue;
    const double share = length(cross(b - a, c - a)) / 6;
    for (const auto p : {a, b, c})
      if (around.contains(xy(p)) && inside(p)) sum += share;
  }
  return sum;
}

}  // namespace mansard::evaluate::detail
