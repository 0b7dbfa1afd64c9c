#include "mansard/evaluate/detail/steep.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "mansard/base/run.hpp"
#include "mansard/geometry/angles.hpp"
#include "mansard/geometry/change.hpp"
#include "mansard/geometry/mesh_part.hpp"

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

auto around(const SteepPlane& steep) -> geometry::Box2 {
  geometry::Box2 box;
  for (const auto* face : steep.faces)
    for (const Point3 p : face->loops[0]) box.add(xy(p));
  return box.grown(off);
}

/// By those triangles of the scan.
auto carried_by(const SteepPlane& steep, const std::vector<std::uint32_t>& triangles, const geometry::Mesh& scan)
    -> base::Result<double> {
  const RoofPlane& plane = *steep.plane;
  const Axes axes(plane);
  std::vector<geometry::Polygon> pieces;
  for (const auto* face : steep.faces) {
    const auto flat = drawn(*face, axes);
    if (!flat) return flat.failure();
    pieces.insert(pieces.end(), flat->begin(), flat->end());
  }
  const auto whole = geometry::unite(pieces);
  if (!whole) return whole.failure();
  const auto inside = [&](Point3 p) {
    if (std::abs(dot(p - plane.point, plane.normal)) > off) return false;
    const auto at = axes.on(p);
    return std::ranges::any_of(
        *whole, [&](const auto& one) { return contains(one, at) && geometry::boundary_distance(one, at) > inset; });
  };
  const auto box = around(steep);
  double sum = 0;
  for (const auto t : triangles) {
    const auto& triangle = scan.triangles[t];
    const Point3 a = scan.vertices[triangle[0]], b = scan.vertices[triangle[1]], c = scan.vertices[triangle[2]];
    const Point3 twice = cross(b - a, c - a);
    if (std::abs(dot(normalised(twice), plane.normal)) < geometry::cosine(turned)) continue;
    for (const auto p : {a, b, c})
      if (box.contains(xy(p)) && inside(p)) sum += length(twice) / 6;
  }
  return sum;
}

}  // namespace

auto carried(std::span<const SteepPlane> planes, const geometry::Mesh& scan) -> std::vector<base::Result<double>> {
  std::vector<geometry::Box2> boxes;
  boxes.reserve(planes.size());
  for (const auto& one : planes) boxes.push_back(around(one));
  const auto near = geometry::triangles_near(scan, boxes);
  std::vector<base::Result<double>> out(planes.size(), 0.0);
  base::parallel_for(planes.size(), [&](std::size_t i) { out[i] = carried_by(planes[i], near[i], scan); });
  return out;
}

}  // namespace mansard::evaluate::detail
