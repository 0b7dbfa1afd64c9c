#include "mansard/terrain/detail/plan.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mansard/geometry/box_index.hpp"
#include "mansard/model/file_grid.hpp"

namespace mansard::terrain::detail {
namespace {

struct Edge {
  Site from, to;
  std::size_t ground = 0;
};

auto cross_inside(const Edge& a, const Edge& b) -> bool {
  const auto sign = [](std::int64_t v) { return (v > 0) - (v < 0); };
  return sign(twice_area(a.from, a.to, b.from)) * sign(twice_area(a.from, a.to, b.to)) < 0 &&
         sign(twice_area(b.from, b.to, a.from)) * sign(twice_area(b.from, b.to, a.to)) < 0;
}

/// Grounds with an edge that crosses one of a ground before them, or is one of it: they overlap.
/// Whether a place is within a ground, and not on its outline. Exact: differences of coordinates are below 2³⁰.
auto is_within(const std::array<std::int64_t, 2>& p, const Ground& ground) -> bool {
  bool inside = false;
  for (const auto& ring : ground.rings)
    for (std::size_t i = 0; i < ring.corners.size(); ++i) {
      const auto &a = ring.corners[i], &b = ring.corners[(i + 1) % ring.corners.size()];
      const std::int64_t side = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
      const auto [left, right] = std::minmax(a[0], b[0]);
      const auto [low, high] = std::minmax(a[1], b[1]);
      if (side == 0 && p[0] >= left && p[0] <= right && p[1] >= low && p[1] <= high) return false;
      if ((a[1] <= p[1]) != (b[1] <= p[1]) && (side > 0) == (b[1] > a[1])) inside = !inside;
    }
  return inside;
}

auto overlapping(std::span<const Ground> grounds) -> std::vector<bool> {
  std::vector<Edge> edges;
  std::vector<geometry::Box2> boxes;
  for (std::size_t g = 0; g < grounds.size(); ++g)
    for (const auto& ring : grounds[g].rings)
      for (std::size_t i = 0; i < ring.corners.size(); ++i) {
        const auto &a = ring.corners[i], &b = ring.corners[(i + 1) % ring.corners.size()];
        edges.push_back({{a[0], a[1]}, {b[0], b[1]}, g});
        geometry::Box2 box;
        for (const auto& end : {a, b}) box.add({static_cast<double>(end[0]), static_cast<double>(end[1])});
        boxes.push_back(box);
      }
  const geometry::BoxIndex index(boxes);
  std::vector<bool> out(grounds.size(), false);
  for (std::size_t e = 0; e < edges.size(); ++e)
    for (const auto other : index.overlapping(boxes[e])) {
      if (other >= e) break;
      const auto &a = edges[e], &b = edges[other];
      if (out[a.ground] || out[b.ground]) continue;
      const bool same = a.from == b.from && a.to == b.to;
      if (same || cross_inside(a, b)) out[a.ground] = true;
    }
  // Outlines that only touch where corners are on edges overlap, too, where a corner is within the other ground.
  std::vector<geometry::Box2> extents(grounds.size());
  for (std::size_t g = 0; g < grounds.size(); ++g)
    for (const auto& ring : grounds[g].rings)
      for (const auto& corner : ring.corners)
        extents[g].add({static_cast<double>(corner[0]), static_cast<double>(corner[1])});
  const geometry::BoxIndex extent_index(extents);
  for (std::size_t g = 0; g < grounds.size(); ++g)
    for (const auto& ring : grounds[g].rings)
      for (const auto& corner : ring.corners) {
        const geometry::Point2 at{static_cast<double>(corner[0]), static_cast<double>(corner[1])};
        for (const std::size_t other : extent_index.overlapping({at, at}))
          if (other != g && !out[g] && !out[other] && is_within(corner, grounds[other])) out[std::max(g, other)] = true;
      }
  return out;
}

/// The vertices along a segment that was fixed.
auto chain(const Triangulation& net, std::uint32_t a, std::uint32_t b) -> std::vector<std::uint32_t> {
  std::vector<std::uint32_t> out{a};
  const auto& sites = net.sites();
  while (a != b) {
    std::uint32_t ahead = Triangulation::none;
    for (const auto t : net.around(a))
      for (const auto v : net.triangles()[t].corner) {
        if (v == a || twice_area(sites[a], sites[b], sites[v]) != 0) continue;
        const auto dx = sites[b].x - sites[a].x, dy = sites[b].y - sites[a].y;
        if ((sites[v].x - sites[a].x) * dx + (sites[v].y - sites[a].y) * dy > 0) ahead = v;
      }
    if (ahead == Triangulation::none) return {};
    out.push_back(ahead);
    a = ahead;
  }
  return out;
}

void flood(Plan& plan) {
  const auto& triangles = plan.net.triangles();
  plan.inside.assign(triangles.size(), false);
  std::vector<std::uint32_t> open;
  for (const auto& [edge, height] : plan.outline)
    if (const auto at = plan.net.left_of(edge.first, edge.second)) open.push_back(at->first);
  while (!open.empty()) {
    const auto t = open.back();
    open.pop_back();
    if (plan.inside[t]) continue;
    plan.inside[t] = true;
    for (std::size_t i = 0; i < 3; ++i)
      if (!triangles[t].fixed[i] && triangles[t].beyond[i] != Triangulation::none)
        open.push_back(triangles[t].beyond[i]);
  }
}

}  // namespace

auto site_of(const model::HeightGrid& grid, std::size_t column, std::size_t row) -> Site {
  const auto at = [](double first, double cell, std::size_t number) {
    return std::llround((first + cell * static_cast<double>(number)) * model::quanta_per_metre);
  };
  return {at(grid.centre.x, grid.cell, column), at(grid.centre.y, grid.cell, row)};
}

auto height_at(const model::HeightGrid& grid, Site site) -> std::int64_t {
  const auto& last = site_of(grid, grid.columns - 1, grid.rows - 1);
  const auto& first = site_of(grid, 0, 0);
  const Site within{std::clamp(site.x, first.x, last.x), std::clamp(site.y, first.y, last.y)};
  const auto z = grid.at({static_cast<double>(within.x) / model::quanta_per_metre,
                          static_cast<double>(within.y) / model::quanta_per_metre});
  if (z) return std::llround(*z * model::quanta_per_metre);
  // By rounding, a hair outside: the nearest node.
  const auto node = [](double p, double from, double cell, std::size_t count) {
    return static_cast<std::size_t>(std::clamp(std::round((p - from) / cell), 0.0, static_cast<double>(count - 1)));
  };
  const auto i = node(static_cast<double>(within.x) / model::quanta_per_metre, grid.centre.x, grid.cell, grid.columns);
  const auto j = node(static_cast<double>(within.y) / model::quanta_per_metre, grid.centre.y, grid.cell, grid.rows);
  return std::llround((static_cast<double>(grid.values[j * grid.columns + i]) - grid.base) * model::quanta_per_metre);
}

auto plan_of(const model::HeightGrid& grid, std::span<const Ground> grounds) -> base::Result<Plan> {
  const Site least = site_of(grid, 0, 0), most = site_of(grid, grid.columns - 1, grid.rows - 1);
  if (most.x - least.x >= widest || most.y - least.y >= widest)
    return base::error(
        "terrain-extent",
        "the terrain would be wider than 53 km; run smaller areas with --bbox, or lower --terrain-margin");
  Plan plan{Triangulation(least, most), {}, {}, {}, {}, overlapping(grounds), 0, {}};
  for (std::uint32_t v = 0; v < 4; ++v) plan.heights.push_back(height_at(grid, plan.net.sites()[v]));
  plan.on_outline.assign(4, false);
  // Corners from west to east in strips, so that each is near the one before it.
  struct Corner {
    Site at;
    std::int64_t z;
  };
  std::vector<Corner> corners;
  for (std::size_t g = 0; g < grounds.size(); ++g)
    if (!plan.left_out[g])
      for (const auto& ring : grounds[g].rings)
        for (std::size_t i = 0; i < ring.corners.size(); ++i)
          corners.push_back({{ring.corners[i][0], ring.corners[i][1]}, ring.heights[i]});
  constexpr std::int64_t strip = 500'000;  // 50 m
  std::ranges::sort(corners, {}, [&](const Corner& c) {
    const auto row = (c.at.y - least.y) / strip;
    return std::tuple(row, row % 2 == 0 ? c.at.x : -c.at.x, c.at.y, c.z);
  });
  for (const auto& corner : corners) {
    const auto v = plan.net.insert(corner.at);
    if (v == Triangulation::none) continue;
    if (v >= plan.heights.size()) {
      plan.heights.push_back(corner.z);
      plan.on_outline.push_back(true);
    }
  }
  const auto vertex = [&](const std::array<std::int64_t, 2>& at) { return plan.net.insert({at[0], at[1]}); };
  for (std::size_t g = 0; g < grounds.size(); ++g) {
    if (plan.left_out[g]) continue;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> own;
    for (const auto& ring : grounds[g].rings)
      for (std::size_t i = 0; i < ring.corners.size(); ++i) {
        const auto a = vertex(ring.corners[i]), b = vertex(ring.corners[(i + 1) % ring.corners.size()]);
        if (plan.left_out[g] || !plan.net.fix(a, b)) {
          plan.left_out[g] = true;
          continue;
        }
        const auto along = chain(plan.net, a, b);
        for (std::size_t k = 0; k + 1 < along.size(); ++k) {
          const std::pair edge{along[k], along[k + 1]};
          if (plan.outline.emplace(edge, ring.heights[i]).second) own.push_back(edge);
          else plan.left_out[g] = true;
        }
      }
    // An outline with gaps would let the outside in.
    if (plan.left_out[g])
      for (const auto& edge : own) plan.outline.erase(edge);
  }
  std::size_t count = 0;
  for (std::size_t g = 0; g < grounds.size(); ++g)
    if (plan.left_out[g]) {
      if (++count <= 20)
        plan.warnings.push_back(base::warning("terrain-overlap",
                                              "its ground overlaps that of another building, so the terrain does not "
                                              "follow its outline; repair the footprints",
                                              grounds[g].id));
    }
  flood(plan);
  return plan;
}

}  // namespace mansard::terrain::detail
