// Dormers and other structures on roofs, as a grid sees them from above.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "mansard/evaluate/detail/degree.hpp"
#include "mansard/evaluate/detail/grid.hpp"
#include "mansard/evaluate/form.hpp"
#include "mansard/geometry/angles.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::evaluate {
namespace {

using detail::degree;
using geometry::Point2;

/// One building seen from above.
struct View {
  detail::Grid grid;
  std::vector<double> z;              ///< NaN where the building is not seen
  std::vector<std::uint32_t> plane;   ///< no_plane where something else is seen
  std::vector<std::uint32_t> dormer;  ///< 1 + the part, where a part with that role is seen; else 0

  [[nodiscard]] auto at(std::int64_t i, std::int64_t j) const -> std::size_t {
    return static_cast<std::size_t>(j * grid.columns + i);
  }
  [[nodiscard]] auto has(std::int64_t i, std::int64_t j) const -> bool {
    return i >= 0 && j >= 0 && i < grid.columns && j < grid.rows;
  }
};

struct FromAbove {
  model::ModelSurface surface;
  rays::Scene scene;
  std::vector<geometry::Box2> boxes;        ///< of the buildings
  std::vector<std::uint32_t> dormer_parts;  ///< 1 + the part, of all parts with that role; else 0

  explicit FromAbove(const model::Model& model)
      : surface(model::surface_of(model)), scene(surface.mesh), boxes(model.buildings.size()) {
    for (std::size_t t = 0; t < surface.mesh.triangles.size(); ++t)
      for (const auto v : surface.mesh.triangles[t]) boxes[surface.buildings[t]].add(xy(surface.mesh.vertices[v]));
    for (const auto& building : model.buildings)
      for (const auto& part : building.parts)
        dormer_parts.push_back(part.role == "dormer" ? static_cast<std::uint32_t>(dormer_parts.size() + 1) : 0);
  }
};

auto view_of(std::uint32_t building, const FromAbove& model, const RoofPlanes& planes, double spacing) -> View {
  View view{detail::grid_over(model.boxes[building], spacing), {}, {}, {}};
  const auto cells = static_cast<std::size_t>(view.grid.rows * view.grid.columns);
  view.z.assign(cells, std::numeric_limits<double>::quiet_NaN());
  view.plane.assign(cells, no_plane);
  view.dormer.assign(cells, 0);
  for (std::int64_t j = 0; j < view.grid.rows; ++j)
    for (std::int64_t i = 0; i < view.grid.columns; ++i) {
      const auto seen = model.scene.seen_from_above(view.grid.centre(i, j));
      if (!seen || model.surface.buildings[seen->triangle] != building) continue;
      const auto cell = view.at(i, j);
      view.z[cell] = seen->z;
      view.plane[cell] = planes.plane_of_face[model.surface.faces[seen->triangle]];
      view.dormer[cell] = model.dormer_parts[model.surface.parts[seen->triangle]];
    }
  return view;
}

using Cells = std::vector<std::pair<std::int64_t, std::int64_t>>;  // row, column
constexpr std::array<std::pair<int, int>, 4> sides{{{0, 1}, {1, 0}, {0, -1}, {-1, 0}}};

/// The cells that are connected with this one by its sides, all of which `in` accepts; marked in `seen`.
template <class In>
auto connected(const View& view, std::int64_t i, std::int64_t j, std::vector<bool>& seen, In in) -> Cells {
  Cells cells{{j, i}};
  seen[view.at(i, j)] = true;
  for (std::size_t k = 0; k < cells.size(); ++k)
    for (const auto& [dj, di] : sides) {
      const auto row = cells[k].first + dj, column = cells[k].second + di;
      if (!view.has(column, row) || seen[view.at(column, row)] || !in(column, row)) continue;
      seen[view.at(column, row)] = true;
      cells.emplace_back(row, column);
    }
  std::ranges::sort(cells);
  return cells;
}

/// The share of the boundary of these cells beyond which the plane is seen.
auto surrounded(const View& view, const Cells& cells, std::uint32_t plane) -> double {
  std::size_t boundary = 0, on_plane = 0;
  for (const auto& [j, i] : cells)
    for (const auto& [dj, di] : sides) {
      const auto row = j + dj, column = i + di;
      if (std::ranges::binary_search(cells, std::pair(row, column))) continue;
      ++boundary;
      if (view.has(column, row) && view.plane[view.at(column, row)] == plane) ++on_plane;
    }
  return boundary > 0 ? static_cast<double>(on_plane) / static_cast<double>(boundary) : 0;
}

auto structure(const View& view, const Cells& cells, bool dormer, std::uint32_t building) -> RoofStructure {
  RoofStructure out{dormer, building, {}};
  for (const auto& [j, i] : cells)
    out.places.push_back({view.grid.column + i, view.grid.row + j, view.z[view.at(i, j)]});
  return out;
}

/// Where the parts called dormers are seen.
void add_labelled(const View& view, std::uint32_t building, std::vector<bool>& taken, std::vector<RoofStructure>& out) {
  std::map<std::uint32_t, Cells> of_part;
  for (std::int64_t j = 0; j < view.grid.rows; ++j)
    for (std::int64_t i = 0; i < view.grid.columns; ++i)
      if (const auto cell = view.at(i, j); view.dormer[cell] > 0) {
        of_part[view.dormer[cell]].emplace_back(j, i);
        taken[cell] = true;
      }
  for (const auto& [part, cells] : of_part) out.push_back(structure(view, cells, true, building));
}

/// What rises from one plane.
void add_above(const View& view, const RoofPlane& plane, std::uint32_t number, std::vector<bool>& taken,
               std::vector<RoofStructure>& out) {
  constexpr double reach = 3;  // m; how far a structure that cuts the plane's border may extend beyond it
  const double area = view.grid.spacing * view.grid.spacing;
  const auto height = [&](std::int64_t i, std::int64_t j) {
    const Point2 p = view.grid.centre(i, j);
    const double at =
        plane.point.z -
        (plane.normal.x * (p.x - plane.point.x) + plane.normal.y * (p.y - plane.point.y)) / plane.normal.z;
    return view.z[view.at(i, j)] - at;
  };
  const auto rises = [&](std::int64_t i, std::int64_t j) {
    const auto cell = view.at(i, j);
    return view.plane[cell] != number && height(i, j) >= structure_rise;  // not where nothing is seen
  };
  const auto box = geometry::bounds(plane.plan).grown(reach);
  const auto near = detail::grid_over(box, view.grid.spacing);
  std::vector<bool> seen(taken);
  for (std::int64_t j = std::max<std::int64_t>(0, near.row - view.grid.row);
       j < std::min(view.grid.rows, near.row + near.rows - view.grid.row); ++j)
    for (std::int64_t i = std::max<std::int64_t>(0, near.column - view.grid.column);
         i < std::min(view.grid.columns, near.column + near.columns - view.grid.column); ++i) {
      if (seen[view.at(i, j)] || !rises(i, j)) continue;
      const auto cells = connected(view, i, j, seen, rises);
      const double size = area * static_cast<double>(cells.size());
      if (size < structure_least_area || size > structure_most_area) continue;
      if (std::ranges::any_of(cells, [&](const auto& c) { return height(c.second, c.first) > structure_height; }))
        continue;
      if (surrounded(view, cells, number) < 0.5) continue;
      for (const auto& [row, column] : cells) taken[view.at(column, row)] = true;
      out.push_back(structure(view, cells, plane.normal.z < geometry::cosine(dormer_pitch * degree), plane.building));
    }
}

}  // namespace

auto roof_structures_of(const model::Model& model, const RoofPlanes& planes, double grid)
    -> std::vector<RoofStructure> {
  constexpr double least_plan = 4;  // m²; smaller planes surround nothing
  const FromAbove above(model);
  std::vector<std::vector<std::uint32_t>> planes_of(model.buildings.size());
  for (std::uint32_t p = 0; p < planes.planes.size(); ++p)
    if (const auto& plane = planes.planes[p];
        plane.area * plane.normal.z >= least_plan && plane.normal.z > geometry::cosine(twin_most_pitch * degree))
      planes_of[plane.building].push_back(p);
  std::vector<std::vector<RoofStructure>> of_building(model.buildings.size());
  base::parallel_for(of_building.size(), [&](std::size_t b) {
    const auto building = static_cast<std::uint32_t>(b);
    const auto view = view_of(building, above, planes, grid);
    std::vector<bool> taken(view.z.size(), false);
    add_labelled(view, building, taken, of_building[b]);
    for (const auto p : planes_of[b]) add_above(view, planes.planes[p], p, taken, of_building[b]);
  });
  std::vector<RoofStructure> out;
  for (auto& own : of_building) std::ranges::move(own, std::back_inserter(out));
  return out;
}

}  // namespace mansard::evaluate
