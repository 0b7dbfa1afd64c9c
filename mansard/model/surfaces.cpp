#include "mansard/model/surfaces.hpp"

#include <array>
#include <cmath>

#include "mansard/geometry/change.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::model {
namespace {

using geometry::Point2;
using geometry::Point3;

/// The plane that a face is cut into triangles in: the two axes it is least foreshortened along, turned so that its
/// outer loop is counter-clockwise.
auto drawn(const ModelFace& face) -> geometry::Polygon {
  const Point3 n = area_vector(face.loops.front());
  const auto on = [&](Point3 p) -> Point2 {
    if (std::abs(n.z) >= std::abs(n.x) && std::abs(n.z) >= std::abs(n.y)) return {n.z > 0 ? p.x : -p.x, p.y};
    if (std::abs(n.x) >= std::abs(n.y)) return {n.x > 0 ? p.y : -p.y, p.z};
    return {n.y > 0 ? p.z : -p.z, p.x};
  };
  return geometry::polygon_of(face.loops, on);
}

/// Triangles over the corners of all loops in order; none for a face that crosses itself.
auto triangles_of(const ModelFace& face) -> std::vector<geometry::Triangle> {
  if (face.loops.size() == 1 && face.loops.front().size() == 3) return {{0, 1, 2}};
  auto cut = geometry::triangulate(drawn(face));
  return cut ? std::move(*cut) : std::vector<geometry::Triangle>();
}

}  // namespace

auto area_vector(const std::vector<geometry::Point3>& loop) -> geometry::Point3 {
  Point3 sum;
  for (std::size_t i = 0; i + 1 < loop.size(); ++i) sum = sum + cross(loop[i] - loop[0], loop[i + 1] - loop[0]);
  return sum;
}

auto to_string(SurfaceClass kind) -> std::string_view {
  static constexpr std::array<std::string_view, surface_class_count> names{"wall", "roof", "ground", "other"};
  return names[static_cast<std::size_t>(kind)];
}

auto surface_of(const Model& model) -> ModelSurface {
  ModelSurface out;
  std::uint32_t building = 0, part = 0, face_number = 0;
  for (const auto& b : model.buildings) {
    for (const auto& p : b.parts) {
      for (const auto& face : p.faces) {
        const auto first = static_cast<std::uint32_t>(out.mesh.vertices.size());
        const auto triangles = triangles_of(face);
        if (triangles.empty()) ++out.lost;
        for (const auto& loop : face.loops) out.mesh.vertices.insert(out.mesh.vertices.end(), loop.begin(), loop.end());
        for (const auto& t : triangles) {
          out.mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
          out.classes.push_back(face.kind);
          out.buildings.push_back(building);
          out.parts.push_back(part);
          out.faces.push_back(face_number);
        }
        ++face_number;
      }
      ++part;
    }
    ++building;
  }
  return out;
}

auto part_of(const ModelSurface& surface, const std::vector<bool>& buildings) -> ModelSurface {
  ModelSurface out;
  const auto& mesh = surface.mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!buildings[surface.buildings[t]]) continue;
    const auto first = static_cast<std::uint32_t>(out.mesh.vertices.size());
    for (const auto v : mesh.triangles[t]) out.mesh.vertices.push_back(mesh.vertices[v]);
    out.mesh.triangles.push_back({first, first + 1, first + 2});
    out.classes.push_back(surface.classes[t]);
    out.buildings.push_back(surface.buildings[t]);
    out.parts.push_back(surface.parts[t]);
    out.faces.push_back(surface.faces[t]);
  }
  return out;
}

}  // namespace mansard::model
