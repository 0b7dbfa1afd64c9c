// Scores of small footprints, of prisms, and of several places together.
#include <algorithm>
#include <cmath>

#include "mansard/base/statistics.hpp"
#include "mansard/evaluate/detail/sums.hpp"
#include "mansard/solid/append_surface.hpp"

namespace mansard::evaluate {
namespace {

auto median_absolute(std::vector<float> values) -> double {
  if (values.empty()) return 0;
  for (float& value : values) value = std::abs(value);
  return base::percentile(std::move(values), 0.5);
}

/// Calls see(cell, depth) for every cell over the footprints, from the south-west.
template <class See>
void each_footprint_cell(const detail::Plan& plan, std::span<const geometry::Polygon> footprints,
                         const rays::Scene* model, const rays::Scene& mesh, const Options& options, See see) {
  const auto cells = detail::grid_over(geometry::bounds(footprints), options.grid);
  for (std::int64_t j = 0; j < cells.rows; ++j) {
    const auto depth = plan.depths(cells, j);
    const auto inside = plan.cover.row(cells, j);
    for (std::int64_t i = 0; i < cells.columns; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (!inside[at]) continue;
      const auto centre = cells.centre(i, j);
      see(detail::Cell{i, centre, true, model ? model->top(centre) : std::nullopt, mesh.top(centre)}, depth[at]);
    }
  }
}

auto scores_of(const detail::Sums& sums, std::span<const float> built, const detail::Plan& plan, double grid)
    -> Scores {
  Scores scores = sums.scores(grid);
  scores.union_unknown = plan.union_unknown;
  set_quantiles(built, scores);
  set_quantiles(sums.differences, scores);
  return scores;
}

void add_weighted(InsideScores& sum, const InsideScores& more) {
  sum.cells += more.cells;
  sum.mse += static_cast<double>(more.cells) * more.mse;
  sum.median_absolute += static_cast<double>(more.cells) * more.median_absolute;
}

void divide(InsideScores& sum) {
  if (sum.cells == 0) return;
  sum.mse /= static_cast<double>(sum.cells);
  sum.median_absolute /= static_cast<double>(sum.cells);
}

}  // namespace

void Differences::add(const Differences& more) {
  const auto append = [](std::vector<float>& all, const std::vector<float>& some) {
    all.insert(all.end(), some.begin(), some.end());
  };
  append(footprints, more.footprints);
  append(inside, more.inside);
  append(inside_each, more.inside_each);
}

auto scores_over(const rays::Scene& model, const rays::Scene& mesh, std::span<const geometry::Polygon> footprints,
                 double ground, const Options& options) -> Scores {
  const detail::Plan plan(footprints, options.inset);
  detail::Sums sums;
  std::vector<float> built;
  each_footprint_cell(plan, footprints, &model, mesh, options, [&](const detail::Cell& cell, detail::Depth depth) {
    if (!cell.built) ++sums.missed;
    if (!cell.scanned) return;
    const double difference = cell.built.value_or(ground) - *cell.scanned;
    sums.add_inside(difference, depth);
    if (!cell.built) return;
    sums.add_built(difference);
    built.push_back(static_cast<float>(difference));
  });
  return scores_of(sums, built, plan, options.grid);
}

auto footprint_error(std::span<const model::Solid* const> solids, const rays::Scene& mesh,
                     std::span<const geometry::Polygon> footprints, double ground, const Options& options)
    -> std::optional<double> {
  geometry::Mesh surface;
  for (const auto* one : solids) solid::append_surface(*one, surface);
  const auto scores = scores_over(rays::Scene(surface), mesh, footprints, ground, options);
  return scores.footprint_cells > 0 ? std::optional(scores.footprint_mse) : std::nullopt;
}

auto prism_over(const rays::Scene& mesh, std::span<const geometry::Polygon> footprints, double height,
                const Options& options) -> Prism {
  const detail::Plan plan(footprints, options.inset);
  detail::Sums sums;
  each_footprint_cell(plan, footprints, nullptr, mesh, options, [&](const detail::Cell& cell, detail::Depth depth) {
    if (!cell.scanned) return;
    sums.add_inside(height - *cell.scanned, depth);
    sums.add_built(height - *cell.scanned);
  });
  const auto scores = scores_of(sums, sums.differences.footprints, plan, options.grid);
  return {height, scores, std::move(sums.differences)};
}

auto prism_over(const rays::Scene& mesh, std::span<const geometry::Polygon> footprints, const Options& options)
    -> Prism {
  std::vector<float> heights;
  each_footprint_cell({footprints, 0}, footprints, nullptr, mesh, options,
                      [&](const detail::Cell& cell, detail::Depth) {
                        if (cell.scanned) heights.push_back(static_cast<float>(*cell.scanned));
                      });
  if (heights.empty()) return {};
  return prism_over(mesh, footprints, base::percentile(std::move(heights), 0.5), options);
}

void set_quantiles(std::span<const float> differences, Scores& scores) {
  std::vector<float> values;
  values.reserve(scores.cells);
  for (const float d : differences)
    if (!std::isnan(d)) values.push_back(d);
  if (values.empty()) return;
  scores.median = base::percentile(values, 0.5);
  for (float& d : values) d = std::abs(d);
  scores.median_absolute = base::percentile(values, 0.5);
  scores.p95_absolute = base::percentile(std::move(values), 0.95);
}

void set_quantiles(const Differences& differences, Scores& scores) {
  scores.footprint_median_absolute = median_absolute(differences.footprints);
  scores.inside.median_absolute = median_absolute(differences.inside);
  scores.inside_each.median_absolute = median_absolute(differences.inside_each);
}

auto combined(std::span<const Scores> scores) -> Scores {
  Scores sum;
  for (const auto& s : scores) {
    const auto cells = static_cast<double>(s.cells), inside = static_cast<double>(s.footprint_cells);
    sum.cells += s.cells;
    sum.footprint_cells += s.footprint_cells;
    sum.mse += cells * s.mse;
    sum.median += cells * s.median;
    sum.median_absolute += cells * s.median_absolute;
    sum.p95_absolute += cells * s.p95_absolute;
    sum.footprint_mse += inside * s.footprint_mse;
    sum.footprint_median_absolute += inside * s.footprint_median_absolute;
    sum.union_unknown = sum.union_unknown || s.union_unknown;
    add_weighted(sum.inside, s.inside);
    add_weighted(sum.inside_each, s.inside_each);
    sum.missed += s.missed;
    sum.invented += s.invented;
  }
  if (const auto n = static_cast<double>(sum.cells); n > 0) {
    sum.mse /= n;
    sum.median /= n;
    sum.median_absolute /= n;
    sum.p95_absolute /= n;
  }
  if (const auto n = static_cast<double>(sum.footprint_cells); n > 0) {
    sum.footprint_mse /= n;
    sum.footprint_median_absolute /= n;
  }
  divide(sum.inside);
  divide(sum.inside_each);
  return sum;
}

}  // namespace mansard::evaluate
