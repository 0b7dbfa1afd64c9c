// Removes points that belong to no surface, and fills small gaps. Every decision about a cell depends on cells within
// `halo` of it.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <tuple>

#include "mansard/cloud/detail/grid.hpp"

namespace mansard::cloud::detail {
namespace {

using Cell = std::pair<std::int64_t, std::int64_t>;

constexpr std::array<Cell, 8> around{{{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}}};
constexpr std::array<Cell, 4> beside{{{0, -1}, {-1, 0}, {1, 0}, {0, 1}}};

auto in_tile(Cell c) -> bool {
  return c.first >= halo && c.second >= halo && c.first < halo + tile_cells && c.second < halo + tile_cells;
}

template <class Work>
void each_cell(const Work& work) {
  for (std::int64_t row = 0; row < window; ++row)
    for (std::int64_t column = 0; column < window; ++column) work(column, row);
}

/// z = a + b (x − x₀) + c (y − y₀) through points, by least squares.
struct Plane {
  double x = 0, y = 0, a = 0, b = 0, c = 0, rms = 0;
  [[nodiscard]] auto at(double px, double py) const -> double { return a + b * (px - x) + c * (py - y); }
};

auto plane_through(const std::vector<const Height*>& heights) -> Plane {
  Plane plane;
  const auto n = static_cast<double>(heights.size());
  for (const auto* h : heights) {
    plane.x += h->x / n;
    plane.y += h->y / n;
    plane.a += h->z / n;
  }
  double xx = 0, xy = 0, yy = 0, xz = 0, yz = 0;
  for (const auto* h : heights) {
    const double x = h->x - plane.x, y = h->y - plane.y, z = h->z - plane.a;
    xx += x * x;
    xy += x * y;
    yy += y * y;
    xz += x * z;
    yz += y * z;
  }
  const double determinant = xx * yy - xy * xy;
  if (heights.size() > 2 && determinant > 1e-6 * (xx + yy) * (xx + yy)) {
    plane.b = (xz * yy - yz * xy) / determinant;
    plane.c = (yz * xx - xz * xy) / determinant;
  }
  double sum = 0;
  for (const auto* h : heights) sum += std::pow(h->z - plane.at(h->x, h->y), 2);
  plane.rms = std::sqrt(sum / n);
  return plane;
}

/// Longest sides, in cells, of patches that are removed and of holes that are filled. With two rounds of the removal of
/// patches, and the cells around a hole, no decision reaches beyond 2 · 9 + 17 = 35 cells, and meshing 2 more.
constexpr std::int64_t longest_patch = 8, longest_hole = 16;

/// The cells that are linked to each other, wherever there are no more than `most`; larger ones are left out. `is_in`
/// says which cells belong to any, `linked` which neighbours to the same.
template <class In, class Linked>
auto small_groups(std::span<const Cell> neighbours, std::size_t most, std::int64_t longest, const In& is_in,
                  const Linked& linked) -> std::vector<std::vector<Cell>> {
  std::vector<char> seen(window * window, 0);
  std::vector<std::vector<Cell>> out;
  std::vector<Cell> group;
  each_cell([&](std::int64_t column, std::int64_t row) {
    if (seen[Grid::index(column, row)] != 0 || !is_in(Cell{column, row})) return;
    group.assign(1, {column, row});
    seen[Grid::index(column, row)] = 1;
    Cell least = group[0], last = group[0];
    for (std::size_t i = 0; i < group.size(); ++i) {
      const Cell at = group[i];
      least = {std::min(least.first, at.first), std::min(least.second, at.second)};
      last = {std::max(last.first, at.first), std::max(last.second, at.second)};
      for (const auto& [dx, dy] : neighbours) {
        const Cell next{at.first + dx, at.second + dy};
        if (!Grid::inside(next.first, next.second)) continue;
        auto& known = seen[Grid::index(next.first, next.second)];
        if (known != 0 || !is_in(next) || !linked(at, next)) continue;
        known = 1;
        group.push_back(next);
      }
    }
    const bool cut = least.first == 0 || least.second == 0 || last.first + 1 == window || last.second + 1 == window;
    if (!cut && group.size() <= most && last.first - least.first < longest && last.second - least.second < longest)
      out.push_back(group);
  });
  return out;
}

auto cells_of(double area, double side) -> std::size_t {
  return static_cast<std::size_t>(std::clamp(area / (side * side), 0.0, static_cast<double>(window)));
}

void remove_isolated(Grid& grid, const Options& options, Counts& counts) {
  const std::size_t most = cells_of(options.isolated, grid.side());
  const double step = std::max(options.step, options.step_slope * grid.side());
  const auto height = [&](Cell c) -> const Height& { return grid.at(c.first, c.second); };
  for (int round = 0; round < 2; ++round) {
    const auto patches = small_groups(
        around, most, longest_patch, [&](Cell c) { return height(c).points > 0; },
        [&](Cell a, Cell b) { return std::abs(height(a).z - height(b).z) <= step; });
    if (patches.empty()) return;
    for (const auto& patch : patches)
      for (const auto& c : patch) {
        grid.lower(c.first, c.second, options.step);
        counts.isolated += in_tile(c) ? 1 : 0;
      }
  }
}

struct Fill {
  Cell cell;
  double z = 0;
  bool building = false;
};

void put(Grid& grid, const std::vector<Fill>& fills, Counts& counts) {
  for (const auto& [cell, z, building] : fills) {
    auto& height = grid.at(cell.first, cell.second);
    height = {};
    height.points = 1;
    height.x = (static_cast<double>(cell.first) + 0.5) * grid.side();
    height.y = (static_cast<double>(cell.second) + 0.5) * grid.side();
    height.z = z;
    height.building = building;
    height.filled = true;
    counts.filled += in_tile(cell) ? 1 : 0;
  }
}

/// Of a hole: the plane of that part of its rim which is of one height, where that is most of it; for holes of one or
/// two cells, at a step, the larger part.
void fill_holes(Grid& grid, const Options& options, Counts& counts) {
  const std::size_t most = std::max<std::size_t>(cells_of(options.gap, grid.side()), 1);
  const double step = std::max(options.step, options.step_slope * grid.side());
  std::vector<Fill> fills;
  const auto holes = small_groups(
      beside, most, longest_hole, [&](Cell c) { return grid.at(c.first, c.second).points == 0; },
      [](Cell, Cell) { return true; });
  for (const auto& hole : holes) {
    std::vector<Cell> rim;
    for (const auto& c : hole)
      for (const auto& [dx, dy] : around) {
        const Cell next{c.first + dx, c.second + dy};
        if (Grid::inside(next.first, next.second) && grid.at(next.first, next.second).points > 0) rim.push_back(next);
      }
    std::ranges::sort(rim);
    rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
    if (rim.size() < 4) continue;
    std::vector<const Height*> heights;
    for (const auto& c : rim) heights.push_back(&grid.at(c.first, c.second));
    auto plane = plane_through(heights);
    if (plane.rms > options.gap_residual) {
      constexpr double most_of_it = 0.6;
      std::ranges::sort(heights, [](const Height* p, const Height* q) {
        return std::tie(p->z, p->x, p->y) < std::tie(q->z, q->x, q->y);
      });
      std::vector<const Height*> best;
      for (std::size_t i = 0, end = 0; i < heights.size(); i = end) {
        for (end = i + 1; end < heights.size() && heights[end]->z - heights[end - 1]->z <= step / 2;) ++end;
        if (end - i >= best.size())
          best.assign(heights.begin() + static_cast<std::ptrdiff_t>(i),
                      heights.begin() + static_cast<std::ptrdiff_t>(end));
      }
      if (hole.size() > 2 && static_cast<double>(best.size()) < most_of_it * static_cast<double>(heights.size()))
        continue;
      heights = std::move(best);
      plane = plane_through(heights);
      if (plane.rms > options.gap_residual) continue;
    }
    const auto buildings = static_cast<std::size_t>(std::ranges::count(heights, true, &Height::building));
    const auto [low, high] = std::ranges::minmax_element(heights, {}, &Height::z);
    for (const auto& c : hole) {
      const double x = (static_cast<double>(c.first) + 0.5) * grid.side(),
                   y = (static_cast<double>(c.second) + 0.5) * grid.side();
      fills.push_back({c, std::clamp(plane.at(x, y), (*low)->z, (*high)->z), 2 * buildings > heights.size()});
    }
  }
  put(grid, fills, counts);
}

}  // namespace

void clean(Grid& grid, const Options& options, Counts& counts) {
  grid.choose(options.step);
  remove_isolated(grid, options, counts);
  fill_holes(grid, options, counts);
  each_cell([&](std::int64_t column, std::int64_t row) {
    counts.cells += in_tile({column, row}) && grid.at(column, row).points > 0 ? 1 : 0;
  });
}

}  // namespace mansard::cloud::detail
