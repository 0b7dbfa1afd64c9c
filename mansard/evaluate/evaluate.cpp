#include "mansard/evaluate/evaluate.hpp"
#include "mansard/solid/append_surface.hpp"
#include "mansard/solid/solid.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mansard/evaluate/detail/sums.hpp"
#include "mansard/evaluate/walls.hpp"

namespace mansard::evaluate {
namespace {

using detail::Grid;
using detail::Sums;
using detail::Where;
using geometry::Box2;

/// The solids' surfaces as one mesh, without those that cannot be cut into triangles; `lost` is how many they are.
auto surface_of(std::span<const model::LabelledSolid> model, std::size_t& lost) -> geometry::Mesh {
  geometry::Mesh mesh;
  for (const auto& labelled : model) lost += solid::append_surface(labelled.solid, mesh) ? 0 : 1;
  return mesh;
}

auto empty_map(const Grid& cells) -> ErrorMap {
  ErrorMap map;
  map.origin = cells.centre(0, 0);
  map.grid = cells.spacing;
  map.columns = static_cast<std::size_t>(cells.columns);
  map.rows = static_cast<std::size_t>(cells.rows);
  map.difference.assign(map.columns * map.rows, std::numeric_limits<float>::quiet_NaN());
  return map;
}

}  // namespace

auto option_list(Options& o) -> base::OptionList {
  base::OptionList list("evaluate");
  list.number("grid", o.grid, "m", {0.01, 10}, "Distance between the samples of the vertical error.")
      .source("paper: 0.25 m");
  list.number("margin", o.margin, "m", {0, 100},
              "Width of the strip around the footprints' bounding box in which errors are measured.")
      .source("paper: the bounding box");
  list.number("inset", o.inset, "m", {0, 100},
              "Depth inside the footprints at which the scores `inside` begin; 0 does not measure them.")
      .source("docs/evaluate.md: strip in which smoothed corners and errors of surveys dominate");
  return list;
}

auto compare(std::span<const model::LabelledSolid> model, const rays::Scene& mesh,
             std::span<const geometry::Polygon> footprints, double ground, const Options& options, const base::Run& run)
    -> Comparison {
  std::size_t lost = 0;
  auto out = compare(surface_of(model, lost), mesh, footprints, ground, options, run);
  out.lost = lost;
  return out;
}

auto compare(const geometry::Mesh& surface, const rays::Scene& mesh, std::span<const geometry::Polygon> footprints,
             double ground, const Options& options, const base::Run& run) -> Comparison {
  run.report("evaluate", {}, 0);
  const rays::Scene top(surface);
  const detail::Plan plan(footprints, options.inset);

  // Errors are measured over the footprints' bounding box, as in the paper; what is invented may lie outside it.
  Box2 box = geometry::bounds(footprints).grown(options.margin);
  const Box2 model_box = Box2::of(surface.vertices);
  if (footprints.empty()) box = model_box.grown(options.margin);
  const Grid inner = detail::grid_over(box, options.grid);
  box.include(model_box);
  const Grid outer = detail::grid_over(box, options.grid);

  Comparison out;
  ErrorMap& map = out.map = empty_map(inner);
  std::vector<Sums> rows(static_cast<std::size_t>(outer.rows));
  base::parallel_for(rows.size(), [&](std::size_t row) {
    if (run.cancelled()) return;
    const auto j = static_cast<std::int64_t>(row);
    Sums& sums = rows[row];
    const auto depth = plan.depths(outer, j);
    detail::each_cell(outer, j, Where::everywhere, plan.cover, top, mesh, [&](const detail::Cell& cell) {
      if (cell.built && !cell.inside) ++sums.invented;
      if (!cell.built && cell.inside) ++sums.missed;
      const std::int64_t column = outer.column + cell.column - inner.column, line = outer.row + j - inner.row;
      if (column < 0 || line < 0 || column >= inner.columns || line >= inner.rows || !cell.scanned) return;
      const double difference = cell.built.value_or(ground) - *cell.scanned;
      if (cell.inside) sums.add_inside(difference, depth[static_cast<std::size_t>(cell.column)]);
      if (cell.built) {
        sums.add_built(difference);
        map.difference[static_cast<std::size_t>(line * inner.columns + column)] = static_cast<float>(difference);
      }
    });
  });

  Sums total;
  for (const auto& row : rows) total.add(row);
  out.scores = total.scores(options.grid);
  out.scores.union_unknown = plan.union_unknown;
  set_quantiles(map.difference, out.scores);
  set_quantiles(total.differences, out.scores);
  out.differences = std::move(total.differences);
  run.report("evaluate", {}, 1);
  return out;
}

auto error_over(const model::Solid& solid, const geometry::Polygon& polygon, const rays::Scene& mesh,
                const Options& options) -> double {
  constexpr double unknown = std::numeric_limits<double>::infinity();
  const auto pieces = solid::triangulate(solid);
  if (!pieces || solid.vertices.empty()) return unknown;
  const rays::Scene top(geometry::Mesh{solid.vertices, pieces->triangles});
  double base = solid.vertices.front().z;
  for (const auto& v : solid.vertices) base = std::min(base, v.z);
  const Grid cells = detail::grid_over(geometry::bounds(polygon.outer), options.grid);
  const detail::Cover cover({&polygon, 1});
  const auto columns = static_cast<std::size_t>(cells.columns), rows = static_cast<std::size_t>(cells.rows);
  HeightCells built{columns, rows, options.grid, std::vector(columns * rows, HeightCells::outside)};
  std::vector<double> scanned(built.heights);
  for (std::int64_t j = 0; j < cells.rows; ++j)
    detail::each_cell(cells, j, Where::inside, cover, top, mesh, [&](const detail::Cell& cell) {
      const auto at = static_cast<std::size_t>(j) * columns + static_cast<std::size_t>(cell.column);
      built.heights[at] = cell.built.value_or(base);
      if (cell.scanned) scanned[at] = *cell.scanned;
    });
  // Without what the scan does not cover, the rest may be all beside walls: then that is compared.
  auto kept = away_from_walls(built, options.inset);
  const auto compared = [&](std::size_t c) { return kept[c] && !std::isnan(scanned[c]); };
  std::size_t count = 0;
  double squares = 0;
  const auto sum = [&] {
    for (std::size_t c = 0; c < scanned.size(); ++c) {
      if (!compared(c)) continue;
      const double difference = built.heights[c] - scanned[c];
      squares += difference * difference;
      ++count;
    }
  };
  sum();
  if (count == 0) {
    kept.assign(kept.size(), true);
    sum();
  }
  return count > 0 ? squares / static_cast<double>(count) : unknown;
}

}  // namespace mansard::evaluate
