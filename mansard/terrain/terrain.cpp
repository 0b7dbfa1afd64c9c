#include "mansard/terrain/terrain.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "mansard/geometry/box_index.hpp"
#include "mansard/model/file_grid.hpp"
#include "mansard/solid/unite.hpp"
#include "mansard/terrain/detail/plan.hpp"
#include "mansard/terrain/detail/simplify.hpp"
#include "mansard/terrain/detail/steps.hpp"

namespace mansard::terrain {
namespace {

auto quanta(double metres) -> std::int64_t { return std::llround(metres * model::quanta_per_metre); }

void add_ground(const model::LabelledSolid& model, Ground& out) {
  for (std::size_t f = 0; f < model.solid.faces.size(); ++f) {
    if (model.classes[f] != model::FaceClass::ground) continue;
    for (const auto& loop : model.solid.faces[f].loops) {
      GroundRing ring;
      // Faces of the ground look down; from above they go the other way round.
      for (auto i = loop.rbegin(); i != loop.rend(); ++i) {
        const auto& v = model.solid.vertices[*i];
        const std::array<std::int64_t, 2> at{quanta(v.x), quanta(v.y)};
        if (!ring.corners.empty() && ring.corners.back() == at) continue;
        ring.corners.push_back(at);
        ring.heights.push_back(quanta(v.z));
      }
      while (ring.corners.size() > 1 && ring.corners.back() == ring.corners.front()) {
        ring.corners.pop_back();
        ring.heights.pop_back();
      }
      if (ring.corners.size() >= 3) out.rings.push_back(std::move(ring));
    }
  }
}

}  // namespace

auto ground_of(const model::Building& building) -> Ground {
  Ground out{building.id, {}};
  if (!building.solids.empty()) {
    for (const auto& solid : building.solids) add_ground(solid.model, out);
    return out;
  }
  std::vector<const model::LabelledSolid*> parts;
  for (const auto& part : building.parts)
    if (!part.model.solid.faces.empty()) parts.push_back(&part.model);
  if (!parts.empty())
    for (const auto& one : solid::unite(parts).solids) add_ground(one.model, out);
  return out;
}

auto area_around(std::span<const Ground> grounds, const Options& options) -> geometry::Box2 {
  geometry::Box2 box;
  for (const auto& ground : grounds)
    for (const auto& ring : ground.rings)
      for (const auto& corner : ring.corners)
        box.add({static_cast<double>(corner[0]) / model::quanta_per_metre,
                 static_cast<double>(corner[1]) / model::quanta_per_metre});
  if (box.empty()) return box;
  box = box.grown(options.margin);
  // Whole cells from a whole metre on.
  box.least = {std::floor(box.least.x), std::floor(box.least.y)};
  const auto end = [&](double least, double most) {
    return least + options.cell * std::ceil((most - least) / options.cell - 1e-9);
  };
  box.most = {end(box.least.x, box.most.x), end(box.least.y, box.most.y)};
  return box;
}

auto make(const Heights& heights, std::span<const Ground> grounds, const Options& options, const base::Run& run)
    -> base::Result<Terrain> {
  auto plan = detail::plan_of(heights.grid, grounds);
  if (!plan) return plan.failure();
  detail::simplify(*plan, heights, options.tolerance, run);
  if (run.cancelled()) return base::error("cancelled", "stopped on request; nothing was written");
  auto out = detail::surface_of(*plan);
  out.warnings.insert(out.warnings.begin(), plan->warnings.begin(), plan->warnings.end());
  constexpr double much = 0.1;
  if (plan->filled > much)
    out.warnings.push_back(base::warning(
        "terrain-filled", "the heights of " + std::to_string(std::lround(100 * plan->filled)) +
                              " % of the terrain are not known and are continued from around them; check whether what "
                              "it is made from covers the buildings and --terrain-margin around them"));
  std::vector<Ground> met;
  for (std::size_t g = 0; g < grounds.size(); ++g)
    if (!plan->left_out[g]) met.push_back(grounds[g]);
  const auto found = joints(out, met);
  if (found.open > 0 || found.faults > 0)
    return base::error("terrain-join", "the terrain does not meet the ground of the buildings along " +
                                           std::to_string(found.open + found.faults) +
                                           " edges; please report this with the data");
  return out;
}

namespace {

using Flat = std::array<std::int64_t, 2>;
using Edge = std::pair<Place, Place>;

/// An edge of a ground.
struct GroundEdge {
  Flat from{}, to{};
  std::int64_t z = 0;
  double covered = 0;  ///< of its length, squared units
  bool shared = false;

  [[nodiscard]] auto along(const Flat& p) const -> double {
    return static_cast<double>(to[0] - from[0]) * static_cast<double>(p[0] - from[0]) +
           static_cast<double>(to[1] - from[1]) * static_cast<double>(p[1] - from[1]);
  }
  [[nodiscard]] auto has_on_line(const Flat& p) const -> bool {
    return (to[0] - from[0]) * (p[1] - from[1]) == (to[1] - from[1]) * (p[0] - from[0]);
  }
  /// How much of it an edge in the other direction covers.
  [[nodiscard]] auto covered_by(const Flat& p, const Flat& q) const -> double {
    if (!has_on_line(p) || !has_on_line(q)) return 0;
    return std::min(along(p), along(to)) - std::max(along(q), 0.0);
  }
};

auto box_of(const Flat& p, const Flat& q) -> geometry::Box2 {
  geometry::Box2 box;
  for (const auto& end : {p, q}) box.add({static_cast<double>(end[0]), static_cast<double>(end[1])});
  return box;
}

auto in_plan(const Place& p) -> Flat { return {p[0], p[1]}; }

auto is_on_border(const geometry::Box2& area, const Edge& edge) -> bool {
  const auto both = [&](std::size_t axis, double side) {
    return edge.first[axis] == quanta(side) && edge.second[axis] == quanta(side);
  };
  return both(0, area.least.x) || both(0, area.most.x) || both(1, area.least.y) || both(1, area.most.y);
}

}  // namespace

auto joints(const Terrain& terrain, std::span<const Ground> grounds) -> Joints {
  Joints out;
  std::map<Edge, int> edges;
  for (const auto& t : terrain.triangles)
    for (std::size_t i = 0; i < 3; ++i) ++edges[{terrain.vertices[t[i]], terrain.vertices[t[(i + 1) % 3]]}];
  std::vector<GroundEdge> ground_edges;
  std::vector<geometry::Box2> boxes;
  for (const auto& ground : grounds)
    for (const auto& ring : ground.rings)
      for (std::size_t i = 0; i < ring.corners.size(); ++i) {
        const auto &a = ring.corners[i], &b = ring.corners[(i + 1) % ring.corners.size()];
        ground_edges.push_back({a, b, ring.heights[i]});
        boxes.push_back(box_of(a, b));
      }
  const geometry::BoxIndex index(boxes);
  // Every border of the terrain is that of the area, upright between two heights, or along a ground.
  for (const auto& [edge, count] : edges) {
    if (count != 1) ++out.faults;
    if (edges.contains({edge.second, edge.first}) || is_on_border(terrain.area, edge)) continue;
    const Flat p = in_plan(edge.first), q = in_plan(edge.second);
    if (p == q) continue;
    bool met = false;
    for (const auto g : index.overlapping(box_of(p, q))) {
      auto& ground = ground_edges[g];
      const double some = ground.covered_by(p, q);
      if (some <= 0 || ground.z != edge.first[2] || ground.z != edge.second[2]) continue;
      if (ground.along(q) < 0 || ground.along(p) > ground.along(ground.to)) continue;
      ground.covered += some;
      met = true;
      if (ground.from == q && ground.to == p) ++out.joined;
    }
    if (!met) ++out.faults;
  }
  for (std::size_t g = 0; g < ground_edges.size(); ++g) {
    auto& ground = ground_edges[g];
    const double whole = ground.along(ground.to), nearly = whole * (1 - 1e-9);
    if (ground.covered >= nearly) {
      // One piece was counted above already.
      if (!edges.contains({{ground.to[0], ground.to[1], ground.z}, {ground.from[0], ground.from[1], ground.z}}))
        ++out.split;
      continue;
    }
    for (const auto other : index.overlapping(boxes[g]))
      ground.covered += std::max(0.0, ground.covered_by(ground_edges[other].from, ground_edges[other].to));
    if (ground.covered >= nearly) ++out.shared;
    else ++out.open;
  }
  return out;
}

namespace {

auto in_metres(const Place& v) -> geometry::Point3 {
  return {static_cast<double>(v[0]) / model::quanta_per_metre, static_cast<double>(v[1]) / model::quanta_per_metre,
          static_cast<double>(v[2]) / model::quanta_per_metre};
}

}  // namespace

auto mesh_of(const Terrain& terrain) -> geometry::Mesh {
  geometry::Mesh mesh;
  for (const auto& v : terrain.vertices) mesh.vertices.push_back(in_metres(v));
  mesh.triangles = terrain.triangles;
  return mesh;
}

auto mesh_below(const Terrain& terrain) -> geometry::Mesh {
  geometry::Mesh mesh;
  std::map<Place, std::uint32_t> numbers;
  for (const auto& triangle : terrain.below) {
    auto& corners = mesh.triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [entry, added] = numbers.try_emplace(triangle[i], static_cast<std::uint32_t>(mesh.vertices.size()));
      if (added) mesh.vertices.push_back(in_metres(triangle[i]));
      corners[i] = entry->second;
    }
  }
  return mesh;
}

}  // namespace mansard::terrain
