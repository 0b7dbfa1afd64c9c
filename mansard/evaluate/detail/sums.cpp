#include "mansard/evaluate/detail/sums.hpp"

namespace mansard::evaluate::detail {
namespace {

auto mean_square(std::span<const float> values) -> double {
  double sum = 0;
  for (const float value : values) sum += static_cast<double>(value) * value;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

}  // namespace

Plan::Plan(std::span<const geometry::Polygon> footprints, double inset)
    : cover(footprints), of_each(Strip::along_each(footprints, inset)), measured(inset > 0) {
  if (!measured) return;
  auto found = Strip::along_union(footprints, inset);
  union_unknown = !found;
  of_union = found ? std::move(*found) : of_each;
}

auto Plan::depths(const Grid& grid, std::int64_t j) const -> std::vector<Depth> {
  std::vector<Depth> out(static_cast<std::size_t>(grid.columns));
  if (!measured) return out;
  const auto near_union = of_union.row(grid, j), near_each = of_each.row(grid, j);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = {!near_union[i], !near_each[i]};
  return out;
}

void Sums::add_inside(double difference, Depth depth) {
  footprint_squares += difference * difference;
  const auto value = static_cast<float>(difference);
  differences.footprints.push_back(value);
  if (depth.inside) differences.inside.push_back(value);
  if (depth.inside_each) differences.inside_each.push_back(value);
}

void Sums::add_built(double difference) {
  ++cells;
  squares += difference * difference;
}

void Sums::add(const Sums& more) {
  cells += more.cells, missed += more.missed, invented += more.invented;
  squares += more.squares, footprint_squares += more.footprint_squares;
  differences.add(more.differences);
}

auto Sums::scores(double grid) const -> Scores {
  Scores out;
  out.cells = cells;
  out.footprint_cells = differences.footprints.size();
  if (cells > 0) out.mse = squares / static_cast<double>(cells);
  if (out.footprint_cells > 0) out.footprint_mse = footprint_squares / static_cast<double>(out.footprint_cells);
  out.inside = {differences.inside.size(), mean_square(differences.inside), 0};
  out.inside_each = {differences.inside_each.size(), mean_square(differences.inside_each), 0};
  const double cell_area = grid * grid;
  out.missed = static_cast<double>(missed) * cell_area;
  out.invented = static_cast<double>(invented) * cell_area;
  return out;
}

}  // namespace mansard::evaluate::detail
