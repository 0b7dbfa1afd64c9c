// Scans of planned buildings: the top surface of raised plans, sampled on a grid with noise.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "mansard/base/run.hpp"
#include "mansard/extrude/extrude.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/rays/rays.hpp"
#include "mansard/refine/refine.hpp"
#include "mansard/solid/solid.hpp"

namespace scans {

using namespace mansard;
using geometry::Point2;
using model::Plan;
using model::Profile;

constexpr double ground = 3.0;  // z

inline auto wall(double height) -> Profile { return {{0, 0}, {0, height}}; }
inline auto roof(double gutter, double slope) -> Profile { return {{0, 0}, {0, gutter}, {1, gutter + slope}}; }

inline auto rectangle(double x, double y, double length, double width) -> geometry::Ring {
  return {{x, y}, {x + length, y}, {x + length, y + width}, {x, y + width}};
}

/// A profile per edge of the ring.
inline auto plan(geometry::Ring ring, std::vector<Profile> profiles, double cap) -> Plan {
  Plan out;
  for (std::uint32_t i = 0; i < ring.size(); ++i) out.outer.profile_of_edge.push_back(i);
  out.outer.points = std::move(ring);
  out.profiles = std::move(profiles);
  out.base = ground;
  out.cap = cap;
  return out;
}

/// The plans' top surface every 0.2 m, with noise of that many metres both ways, and the ground around them.
inline auto scanned(const std::vector<Plan>& plans, double noise = 0.04) -> geometry::Mesh {
  geometry::Mesh solids;
  geometry::Box2 box;
  for (const auto& p : plans) {
    const auto raised = extrude::raise(p);
    const auto pieces = solid::triangulate(raised->solid);
    const auto first = static_cast<std::uint32_t>(solids.vertices.size());
    solids.vertices.insert(solids.vertices.end(), raised->solid.vertices.begin(), raised->solid.vertices.end());
    for (const auto& t : pieces->triangles) solids.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    for (const Point2 at : p.outer.points) box.add(at);
  }
  const rays::Scene truth(solids);
  constexpr double step = 0.2;
  box = box.grown(2);
  const auto columns = static_cast<std::uint32_t>((box.most.x - box.least.x) / step) + 1;
  const auto rows = static_cast<std::uint32_t>((box.most.y - box.least.y) / step) + 1;
  base::Random random(5);
  geometry::Mesh mesh;
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const Point2 at{box.least.x + step * i, box.least.y + step * j};
      mesh.vertices.push_back({at.x, at.y, truth.top(at).value_or(ground) + random.uniform(-noise, noise)});
    }
  for (std::uint32_t j = 0; j + 1 < rows; ++j)
    for (std::uint32_t i = 0; i + 1 < columns; ++i) {
      const std::uint32_t a = j * columns + i;
      mesh.triangles.push_back({a, a + 1, a + columns});
      mesh.triangles.push_back({a + 1, a + columns + 1, a + columns});
    }
  return mesh;
}
inline auto scan(const std::vector<Plan>& plans, double noise = 0.04) -> rays::Scene {
  return rays::Scene(scanned(plans, noise));
}

/// What a draft knows before: walls all around and a height.
inline auto flat_draft(geometry::Ring ring, double height, std::size_t owner = 0) -> refine::Draft {
  std::vector<Profile> profiles(ring.size(), wall(height));
  return {owner, plan(std::move(ring), std::move(profiles), height), {height}, {}};
}

inline auto top_of(const model::Solid& solid) -> double {
  double top = -1e9;
  for (const auto v : solid.vertices) top = std::max(top, v.z);
  return top;
}

inline auto pitched_sides(const Plan& p) -> std::vector<std::size_t> {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < p.outer.points.size(); ++i)
    if (p.profiles[p.outer.profile_of_edge[i]].back().inward > 0) out.push_back(i);
  return out;
}

/// Root mean square of the differences between two solids' top surfaces, over the ring; m.
inline auto difference(const std::vector<refine::Part>& parts, const std::vector<Plan>& truth, double margin = 0.6)
    -> double {
  const auto scene = [](const std::vector<model::Solid>& solids) {
    geometry::Mesh mesh;
    for (const auto& solid : solids) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.insert(mesh.vertices.end(), solid.vertices.begin(), solid.vertices.end());
      const auto pieces = solid::triangulate(solid);
      for (const auto& t : pieces->triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    return rays::Scene(mesh);
  };
  std::vector<model::Solid> made, wanted;
  for (const auto& part : parts) made.push_back(part.raised.solid);
  for (const auto& p : truth) wanted.push_back(extrude::raise(p)->solid);
  const rays::Scene a = scene(made), b = scene(wanted);
  double sum = 0;
  std::size_t count = 0;
  for (const auto& p : truth) {
    const auto polygon = model::polygon_of(p);
    const auto box = geometry::bounds(polygon.outer);
    for (double y = box.least.y; y < box.most.y; y += 0.25)
      for (double x = box.least.x; x < box.most.x; x += 0.25) {
        if (!geometry::contains(polygon, Point2{x, y}) || geometry::boundary_distance(polygon, {x, y}) < margin)
          continue;
        const double d = a.top({x, y}).value_or(ground) - b.top({x, y}).value_or(ground);
        sum += d * d;
        ++count;
      }
  }
  return std::sqrt(sum / static_cast<double>(count));
}

}  // namespace scans
