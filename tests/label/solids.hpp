// Solids made by hand.
#pragma once

#include <vector>

#include "mansard/extrude/extrude.hpp"
#include "mansard/geometry/polygon.hpp"

namespace solids {

using mansard::geometry::Point2;
using mansard::geometry::Point3;
using mansard::model::Face;
using mansard::model::FaceKind;
using mansard::model::Solid;
using Ring = mansard::geometry::Ring;

inline auto add_face(Solid& solid, std::vector<std::uint32_t> loop, FaceKind kind) -> void {
  Point3 normal;
  for (std::size_t i = 0; i < loop.size(); ++i)
    normal = normal + cross(solid.vertices[loop[i]], solid.vertices[loop[(i + 1) % loop.size()]]);
  solid.faces.push_back({{std::move(loop)}, kind, {}, mansard::geometry::normalised(normal)});
}

/// A prism with flat top over a counter-clockwise ring: walls in the order of the edges, then base, then cap.
inline auto prism(const Ring& ring, double base, double top) -> Solid {
  Solid solid;
  const auto n = static_cast<std::uint32_t>(ring.size());
  for (const double z : {base, top})
    for (const Point2 p : ring) solid.vertices.push_back({p.x, p.y, z});
  std::vector<std::uint32_t> down, up;
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    add_face(solid, {i, next, n + next, n + i}, FaceKind::side);
    down.insert(down.begin(), i);
    up.push_back(n + i);
  }
  add_face(solid, down, FaceKind::base);
  add_face(solid, up, FaceKind::cap);
  return solid;
}

inline auto box(Point2 least, Point2 most, double base, double top) -> Solid {
  return prism({least, {most.x, least.y}, most, {least.x, most.y}}, base, top);
}

/// Ridge along x in the middle: south, east, north, west walls, south and north roofs, base.
inline auto gable(Point2 least, Point2 most, double base, double gutter, double ridge) -> Solid {
  Solid solid;
  const double middle = (least.y + most.y) / 2;
  for (const double z : {base, gutter})
    for (const Point2 p : {least, Point2{most.x, least.y}, most, Point2{least.x, most.y}})
      solid.vertices.push_back({p.x, p.y, z});
  solid.vertices.push_back({least.x, middle, ridge});  // 8
  solid.vertices.push_back({most.x, middle, ridge});   // 9
  add_face(solid, {0, 1, 5, 4}, FaceKind::side);
  add_face(solid, {1, 2, 6, 9, 5}, FaceKind::side);
  add_face(solid, {2, 3, 7, 6}, FaceKind::side);
  add_face(solid, {3, 0, 4, 8, 7}, FaceKind::side);
  add_face(solid, {4, 5, 9, 8}, FaceKind::side);
  add_face(solid, {6, 7, 8, 9}, FaceKind::side);
  add_face(solid, {3, 2, 1, 0}, FaceKind::base);
  return solid;
}

/// Turned about the origin, then shifted.
inline auto moved(Solid solid, double angle, Point3 by) -> Solid {
  const double c = std::cos(angle), s = std::sin(angle);
  const auto turn = [&](Point3 p) { return Point3{c * p.x - s * p.y, s * p.x + c * p.y, p.z}; };
  for (auto& v : solid.vertices) v = turn(v) + by;
  for (auto& face : solid.faces) face.normal = turn(face.normal);
  return solid;
}

}  // namespace solids
