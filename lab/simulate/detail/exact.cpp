#include "lab/simulate/detail/exact.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "lab/simulate/detail/raising.hpp"
#include "mansard/base/stopped.hpp"
#include "mansard/geometry/box_index.hpp"

namespace mansard::simulate::detail {
namespace {

using geometry::Box2;
using geometry::Point2;
using geometry::Point3;
using geometry::Polygon;

constexpr double touching = 0.01;   // m; faces that are nearer to each other than this have nothing between them
constexpr double opposite = -0.99;  // cosine of the normals of such faces, from which they look at each other
constexpr double sliver = 1e-4;     // m²; what is left of a triangle is at least this
constexpr double square = 2;        // m; of the ground

/// A plane with two axes in it, in which a triangle is a polygon.
struct Plane {
  Point3 origin, u, v, normal;
  [[nodiscard]] auto flat(Point3 p) const -> Point2 { return {dot(p - origin, u), dot(p - origin, v)}; }
  [[nodiscard]] auto space(Point2 p) const -> Point3 { return origin + p.x * u + p.y * v; }
  [[nodiscard]] auto off(Point3 p) const -> double { return std::abs(dot(p - origin, normal)); }
};

using Corners = std::array<Point3, 3>;

auto corners_of(const geometry::Mesh& mesh, std::size_t t) -> Corners {
  const auto& triangle = mesh.triangles[t];
  return {mesh.vertices[triangle[0]], mesh.vertices[triangle[1]], mesh.vertices[triangle[2]]};
}

auto across(const Corners& c) -> Point3 { return cross(c[1] - c[0], c[2] - c[0]); }

auto plane_of(const Corners& c) -> Plane {
  const Point3 normal = normalised(across(c)), u = normalised(c[1] - c[0]);
  return {c[0], u, cross(normal, u), normal};
}

auto polygon_of(const Plane& plane, const Corners& c, bool turned) -> Polygon {
  Polygon out{{plane.flat(c[0]), plane.flat(c[1]), plane.flat(c[2])}, {}};
  if (turned) std::swap(out.outer[1], out.outer[2]);
  return out;
}

/// Adds triangles to a scan; vertices that have the same place are one.
class Builder {
 public:
  void add(const Corners& corners, Class kind, std::uint32_t building) {
    geometry::Triangle triangle{};
    std::ranges::transform(corners, triangle.begin(), [&](Point3 p) { return vertex(p); });
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) return;
    scan_.mesh.triangles.push_back(triangle);
    scan_.classes.push_back(kind);
    scan_.buildings.push_back(building);
  }
  [[nodiscard]] auto take() -> Scan { return std::move(scan_); }

 private:
  auto vertex(Point3 p) -> std::uint32_t {
    const auto [at, fresh] = numbers_.emplace(p, static_cast<std::uint32_t>(scan_.mesh.vertices.size()));
    if (fresh) scan_.mesh.vertices.push_back(p);
    return at->second;
  }

  Scan scan_;
  std::map<Point3, std::uint32_t> numbers_;
};

/// What of a triangle no other one covers. Where that cannot be computed, all of it: nothing is lost then.
auto uncovered(const Surface& surface, std::uint32_t t, const geometry::BoxIndex& boxes) -> std::vector<Corners> {
  const Corners corners = corners_of(surface.mesh, t);
  const Plane plane = plane_of(corners);
  std::vector<Polygon> covers;
  for (const auto other : boxes.overlapping(Box2::of(corners).grown(touching))) {
    const Corners facing = corners_of(surface.mesh, other);
    if (dot(normalised(across(facing)), plane.normal) > opposite) continue;
    if (std::ranges::any_of(facing, [&](Point3 p) { return plane.off(p) > touching; })) continue;
    covers.push_back(polygon_of(plane, facing, true));
  }
  if (covers.empty()) return {corners};
  std::vector<Polygon> left{polygon_of(plane, corners, false)};
  for (const auto& cover : covers) {
    std::vector<Polygon> less;
    for (const auto& polygon : left) {
      const auto rest = geometry::subtract(polygon, cover);
      if (!rest) return {corners};
      less.insert(less.end(), rest->begin(), rest->end());
    }
    std::erase_if(less, [](const Polygon& p) { return geometry::area(p) < sliver; });
    left = std::move(less);
  }
  if (left.size() == 1 && left[0] == polygon_of(plane, corners, false)) return {corners};
  const auto placed = [&](Point2 p) {
    const auto* own = std::ranges::find_if(corners, [&](Point3 corner) { return plane.flat(corner) == p; });
    return own == corners.end() ? plane.space(p) : *own;
  };
  std::vector<Corners> out;
  for (const auto& polygon : left) {
    const auto triangles = geometry::triangulate(polygon);
    if (!triangles) return {corners};
    std::vector<Point2> points = polygon.outer;
    for (const auto& hole : polygon.holes) points.insert(points.end(), hole.begin(), hole.end());
    for (const auto& [a, b, c] : *triangles) out.push_back({placed(points[a]), placed(points[b]), placed(points[c])});
  }
  return out;
}

/// What of the ground the buildings take, and at which height.
struct Base {
  Polygon outline;
  std::vector<Corners> floors;
};

/// Where along the outline a point is on the base: its height there.
auto height_on(const Base& base, Point2 p) -> std::optional<double> {
  constexpr double near = 0.001;  // m
  if (geometry::boundary_distance(base.outline, p) > near) return std::nullopt;
  for (const auto& floor : base.floors)
    for (std::size_t i = 0; i < 3; ++i) {
      const Point3 a = floor[i], b = floor[(i + 1) % 3];
      const geometry::Segment2 edge{xy(a), xy(b)};
      if (geometry::distance(edge, p) > near) continue;
      return a.z + std::clamp(geometry::parameter(edge, p), 0.0, 1.0) * (b.z - a.z);
    }
  return std::nullopt;
}

/// One for each polygon of the union of a building's floors; a floor is on the ground where `grounded`.
auto bases_of(const Surface& surface, const std::vector<bool>& grounded) -> base::Result<std::vector<Base>> {
  std::map<std::uint32_t, std::vector<Corners>> floors;
  for (std::size_t t = 0; t < grounded.size(); ++t)
    if (grounded[t]) floors[surface.buildings[t]].push_back(corners_of(surface.mesh, t));
  std::vector<Base> bases;
  for (const auto& [building, triangles] : floors) {
    std::vector<Polygon> pieces;
    for (const auto& c : triangles) {
      Polygon piece{{xy(c[0]), xy(c[1]), xy(c[2])}, {}};
      if (geometry::signed_area(piece.outer) == 0) continue;
      pieces.push_back(geometry::oriented(std::move(piece)));
    }
    auto outline = geometry::unite(pieces);
    if (!outline) return outline.error();
    for (auto& polygon : *outline) bases.push_back({std::move(polygon), triangles});
  }
  return bases;
}

/// One square of the ground, without the bases.
auto ground_of(const Polygon& cell, const std::vector<Base>& bases, const geometry::BoxIndex& boxes,
               const Terrain& terrain) -> base::Result<std::vector<Corners>> {
  const auto near = boxes.overlapping(geometry::bounds(cell.outer).grown(touching));
  std::vector<Polygon> left{cell};
  for (const auto b : near) {
    std::vector<Polygon> less;
    for (const auto& polygon : left) {
      auto rest = geometry::subtract(polygon, bases[b].outline);
      if (!rest) return rest.error();
      less.insert(less.end(), rest->begin(), rest->end());
    }
    std::erase_if(less, [](const Polygon& p) { return geometry::area(p) < sliver; });
    left = std::move(less);
  }
  // Of several bases at one place the lowest: the ground does not cover a wall.
  const auto raised = [&](Point2 p) {
    std::optional<double> z;
    for (const auto b : near)
      if (const auto here = height_on(bases[b], p); here && (!z || *here < *z)) z = here;
    return Point3{p.x, p.y, z ? *z : terrain.at(p)};
  };
  std::vector<Corners> out;
  for (const auto& polygon : left) {
    const auto triangles = geometry::triangulate(polygon);
    if (!triangles) return triangles.error();
    std::vector<Point2> points = polygon.outer;
    for (const auto& hole : polygon.holes) points.insert(points.end(), hole.begin(), hole.end());
    for (const auto& [a, b, c] : *triangles) out.push_back({raised(points[a]), raised(points[b]), raised(points[c])});
  }
  return out;
}

auto boxes_of(const Surface& surface) -> std::vector<Box2> {
  std::vector<Box2> boxes;
  for (std::size_t t = 0; t < surface.mesh.triangles.size(); ++t)
    boxes.push_back(Box2::of(corners_of(surface.mesh, t)));
  return boxes;
}

}  // namespace

auto exact_scan(const Surface& surface, const Terrain& terrain, const Box2& area, const base::Run& run)
    -> base::Result<Scan> {
  const auto grounded = on_ground(surface);
  const geometry::BoxIndex faces(boxes_of(surface));
  std::vector<std::vector<Corners>> seen(surface.mesh.triangles.size());
  base::parallel_for(seen.size(), [&](std::size_t t) {
    const bool flat = across(corners_of(surface.mesh, t)) == Point3{};
    if (!run.cancelled() && !grounded[t] && !flat) seen[t] = uncovered(surface, static_cast<std::uint32_t>(t), faces);
  });

  const auto bases = bases_of(surface, grounded);
  if (!bases) return bases.error();
  std::vector<Box2> extents;
  for (const auto& base : *bases) extents.push_back(geometry::bounds(base.outline.outer));
  const geometry::BoxIndex outlines(extents);
  const auto columns = static_cast<std::size_t>(std::ceil((area.most.x - area.least.x) / square));
  const auto rows = static_cast<std::size_t>(std::ceil((area.most.y - area.least.y) / square));
  std::vector<base::Result<std::vector<Corners>>> strips(rows, std::vector<Corners>{});
  base::parallel_for(rows, [&](std::size_t row) {
    for (std::size_t column = 0; column < columns && !run.cancelled() && strips[row]; ++column) {
      const auto at = [&](std::size_t i, std::size_t j) {
        return area.least + square * Point2{static_cast<double>(column + i), static_cast<double>(row + j)};
      };
      const Polygon cell{{at(0, 0), at(1, 0), at(1, 1), at(0, 1)}, {}};
      auto more = ground_of(cell, *bases, outlines, terrain);
      if (more) strips[row]->insert(strips[row]->end(), more->begin(), more->end());
      else strips[row] = more.failure();
    }
  });
  if (run.cancelled()) return base::stopped();

  Builder builder;
  for (std::size_t t = 0; t < seen.size(); ++t)
    for (const auto& corners : seen[t])
      builder.add(corners, surface.classes[t] == Class::ground ? Class::roof : surface.classes[t],
                  surface.buildings[t]);
  for (const auto& strip : strips) {
    if (!strip) return strip.error();
    for (const auto& corners : *strip) builder.add(corners, Class::ground, Scan::none);
  }
  return builder.take();
}

}  // namespace mansard::simulate::detail
