#include "mansard/evaluate/walls.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace mansard::evaluate {
namespace {

/// see(neighbour) for the up to eight cells around one.
template <class See>
void each_beside(const HeightCells& cells, std::size_t at, See see) {
  const auto column = at % cells.columns, row = at / cells.columns;
  for (std::size_t y = row > 0 ? row - 1 : row; y <= std::min(row + 1, cells.rows - 1); ++y)
    for (std::size_t x = column > 0 ? column - 1 : column; x <= std::min(column + 1, cells.columns - 1); ++x)
      if (x != column || y != row) see(y * cells.columns + x);
}

auto is_at_edge(const HeightCells& cells, std::size_t at) -> bool {
  const auto column = at % cells.columns, row = at / cells.columns;
  return column == 0 || row == 0 || column + 1 == cells.columns || row + 1 == cells.rows;
}

}  // namespace

auto step_of_walls(double spacing) -> double {
  constexpr double wall = 0.5, steepest = 2.5;  // m; tangent of 68°
  return std::max(wall, steepest * spacing);
}

auto away_from_walls(const HeightCells& cells, double reach) -> std::vector<bool> {
  const double step = step_of_walls(cells.spacing);
  constexpr double least_share = 0.2;
  const auto count = cells.heights.size();
  std::vector<bool> inside(count);
  for (std::size_t c = 0; c < count; ++c) inside[c] = !std::isnan(cells.heights[c]);
  const auto rounds = static_cast<std::size_t>(std::ceil(std::max(reach, 0.0) / cells.spacing));
  if (rounds == 0) return inside;

  // How many cells away the next wall is.
  std::vector<std::size_t> far(count, rounds);
  std::vector<std::size_t> now, next;
  for (std::size_t c = 0; c < count; ++c) {
    if (!inside[c]) continue;
    bool beside = is_at_edge(cells, c);
    each_beside(cells, c, [&](std::size_t n) {
      beside = beside || !inside[n] || std::abs(cells.heights[c] - cells.heights[n]) > step;
    });
    if (!beside) continue;
    far[c] = 0;
    now.push_back(c);
  }
  for (std::size_t r = 1; r < rounds && !now.empty(); ++r) {
    next.clear();
    for (const auto c : now)
      each_beside(cells, c, [&](std::size_t n) {
        if (!inside[n] || far[n] <= r) return;
        far[n] = r;
        next.push_back(n);
      });
    now.swap(next);
  }
  const auto all = static_cast<double>(std::ranges::count(inside, true));
  for (std::size_t least = rounds; least > 0; --least) {
    std::vector<bool> kept(count);
    double left = 0;
    for (std::size_t c = 0; c < count; ++c) {
      kept[c] = inside[c] && far[c] >= least;
      left += kept[c] ? 1 : 0;
    }
    if (left > 0 && left >= least_share * all) return kept;
  }
  return inside;
}

}  // namespace mansard::evaluate
