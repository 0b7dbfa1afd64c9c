#include "mansard/align/align.hpp"
#include "mansard/geometry/edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace mansard::align {
namespace {

using geometry::Box2;
using geometry::Point2;

/// Cells of a grid whose lines are at whole multiples of the cell.
struct Grid {
  double cell = 1;
  std::int64_t column = 0, row = 0;  ///< of the south-west cell
  std::size_t columns = 0, rows = 0;
  [[nodiscard]] auto cells() const -> std::size_t { return columns * rows; }
};

auto grid_over(const Box2& box, double cell) -> Grid {
  Grid grid{cell, static_cast<std::int64_t>(std::floor(box.least.x / cell)),
            static_cast<std::int64_t>(std::floor(box.least.y / cell)), 0, 0};
  const auto number = [cell](double most, std::int64_t first) {
    return static_cast<std::size_t>(static_cast<std::int64_t>(std::floor(most / cell)) - first + 1);
  };
  grid.columns = number(box.most.x, grid.column);
  grid.rows = number(box.most.y, grid.row);
  return grid;
}

/// What the mesh shows in each cell.
enum class Shown : std::uint8_t { nothing, ground, high };
struct Relief {
  Grid grid;
  std::vector<Shown> cells;
  double high = 0;  ///< how many of them are
};

/// The highest and lowest point of the mesh over each cell, by points spread over its triangles.
struct Heights {
  Grid grid;
  std::vector<float> top, bottom;
};

auto box_of(const geometry::Mesh& mesh) -> Box2 {
  Box2 box;
  for (const auto& vertex : mesh.vertices) box.add({vertex.x, vertex.y});
  return box;
}

auto heights_of(const geometry::Mesh& mesh, double cell) -> Heights {
  Heights heights{grid_over(box_of(mesh), cell), {}, {}};
  const auto& grid = heights.grid;
  constexpr float none = std::numeric_limits<float>::infinity();
  heights.top.assign(grid.cells(), -none);
  heights.bottom.assign(grid.cells(), none);
  for (const auto& triangle : mesh.triangles) {
    const auto a = mesh.vertices[triangle[0]], b = mesh.vertices[triangle[1]], c = mesh.vertices[triangle[2]];
    const double longest = std::max(
        {std::hypot(b.x - a.x, b.y - a.y), std::hypot(c.x - b.x, c.y - b.y), std::hypot(a.x - c.x, a.y - c.y)});
    // Two points a cell, so that no cell below a large triangle is missed.
    const int steps = static_cast<int>(std::min(4096.0, std::ceil(2 * longest / cell)));
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; j <= steps - i; ++j) {
        const double u = steps > 0 ? static_cast<double>(i) / steps : 0,
                     v = steps > 0 ? static_cast<double>(j) / steps : 0;
        const double x = a.x + u * (b.x - a.x) + v * (c.x - a.x), y = a.y + u * (b.y - a.y) + v * (c.y - a.y);
        const auto z = static_cast<float>(a.z + u * (b.z - a.z) + v * (c.z - a.z));
        const auto column = static_cast<std::int64_t>(std::floor(x / cell)) - grid.column,
                   row = static_cast<std::int64_t>(std::floor(y / cell)) - grid.row;
        if (column < 0 || row < 0 || column >= static_cast<std::int64_t>(grid.columns) ||
            row >= static_cast<std::int64_t>(grid.rows))
          continue;
        const auto at = static_cast<std::size_t>(row) * grid.columns + static_cast<std::size_t>(column);
        heights.top[at] = std::max(heights.top[at], z);
        heights.bottom[at] = std::min(heights.bottom[at], z);
      }
  }
  return heights;
}

/// The minimum of each window of 2·reach + 1 along a line of values, in place.
void least_along(std::vector<float>& line, std::size_t reach) {
  const auto n = line.size();
  std::vector<float> out(n);
  std::vector<std::size_t> queue;  // of places with rising values
  std::size_t first = 0, next = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (; next < std::min(n, i + reach + 1); ++next) {
      while (queue.size() > first && line[queue.back()] >= line[next]) queue.pop_back();
      queue.push_back(next);
    }
    while (queue[first] + reach < i) ++first;
    out[i] = line[queue[first]];
  }
  line = std::move(out);
}

/// The same in squares.
void least_around(std::vector<float>& values, const Grid& grid, std::size_t reach) {
  std::vector<float> line;
  for (std::size_t row = 0; row < grid.rows; ++row) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(row * grid.columns);
    line.assign(first, first + static_cast<std::ptrdiff_t>(grid.columns));
    least_along(line, reach);
    std::ranges::copy(line, first);
  }
  line.resize(grid.rows);
  for (std::size_t column = 0; column < grid.columns; ++column) {
    for (std::size_t row = 0; row < grid.rows; ++row) line[row] = values[row * grid.columns + column];
    least_along(line, reach);
    for (std::size_t row = 0; row < grid.rows; ++row) values[row * grid.columns + column] = line[row];
  }
}

auto relief_of(const geometry::Mesh& mesh, double cell, const Options& options) -> Relief {
  const auto heights = heights_of(mesh, cell);
  const auto& grid = heights.grid;
  const auto reach = static_cast<std::size_t>(std::ceil(options.around / cell));
  // Opening: what is lower than a roof is wide. On a slope that is the slope itself.
  auto ground = heights.bottom;
  least_around(ground, grid, reach);
  for (auto& z : ground) z = -z;
  least_around(ground, grid, reach);
  for (auto& z : ground) z = -z;
  Relief relief{grid, std::vector<Shown>(grid.cells(), Shown::nothing)};
  for (std::size_t i = 0; i < grid.cells(); ++i)
    if (heights.top[i] >= heights.bottom[i])
      relief.cells[i] = heights.top[i] - ground[i] > options.above_ground ? Shown::high : Shown::ground;
  relief.high = static_cast<double>(std::ranges::count(relief.cells, Shown::high));
  return relief;
}

struct Outlines {
  Grid grid;                         ///< with a rim of cells without footprint
  std::vector<std::uint8_t> inside;  ///< 1 where the cell's centre is in a footprint
  double count = 0;                  ///< of these
};

auto outlines_of(std::span<const geometry::Polygon> footprints, double cell) -> Outlines {
  const auto box = geometry::bounds(footprints);
  Outlines outlines{grid_over(box.grown(2 * cell), cell), {}};
  const auto& grid = outlines.grid;
  outlines.inside.assign(grid.cells(), 0);
  std::vector<double> crossings;
  for (const auto& polygon : footprints) {
    const auto own = grid_over(geometry::bounds(polygon.outer), cell);
    for (std::size_t r = 0; r < own.rows; ++r) {
      const double y = (static_cast<double>(own.row) + static_cast<double>(r) + 0.5) * cell;
      crossings.clear();
      geometry::each_edge(polygon, [&](geometry::Point2 p, geometry::Point2 q) {
        if ((p.y <= y) != (q.y <= y)) crossings.push_back(p.x + (y - p.y) / (q.y - p.y) * (q.x - p.x));
      });
      std::ranges::sort(crossings);
      const auto row = static_cast<std::size_t>(own.row + static_cast<std::int64_t>(r) - grid.row);
      for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
        const auto from = static_cast<std::int64_t>(std::ceil(crossings[i] / cell - 0.5)) - grid.column,
                   to = static_cast<std::int64_t>(std::ceil(crossings[i + 1] / cell - 0.5)) - grid.column;
        for (auto c = std::max<std::int64_t>(from, 0); c < std::min(to, static_cast<std::int64_t>(grid.columns)); ++c)
          outlines.inside[row * grid.columns + static_cast<std::size_t>(c)] = 1;
      }
    }
  }
  outlines.count = static_cast<double>(std::ranges::count(outlines.inside, 1));
  return outlines;
}

/// The relief moved by whole cells, compared with the outlines.
auto compare(const Relief& relief, const Outlines& outlines, std::int64_t move_column, std::int64_t move_row) -> Match {
  const auto& mesh = relief.grid;
  const auto& plan = outlines.grid;
  const auto left = std::max(plan.column, mesh.column + move_column),
             right = std::min(plan.column + static_cast<std::int64_t>(plan.columns),
                              mesh.column + move_column + static_cast<std::int64_t>(mesh.columns)),
             below = std::max(plan.row, mesh.row + move_row),
             above = std::min(plan.row + static_cast<std::int64_t>(plan.rows),
                              mesh.row + move_row + static_cast<std::int64_t>(mesh.rows));
  std::array<std::int64_t, 6> count{};  // by shown, then inside
  for (auto row = below; row < above; ++row) {
    const auto* shown = relief.cells.data() + (row - mesh.row - move_row) * static_cast<std::int64_t>(mesh.columns) +
                        (left - mesh.column - move_column);
    const auto* inside =
        outlines.inside.data() + (row - plan.row) * static_cast<std::int64_t>(plan.columns) + (left - plan.column);
    for (auto i = left; i < right; ++i, ++shown, ++inside) ++count[2 * static_cast<std::size_t>(*shown) + *inside];
  }
  const auto high_in = static_cast<double>(count[5]), high_out = static_cast<double>(count[4]),
             ground_in = static_cast<double>(count[3]), ground_out = static_cast<double>(count[2]);
  Match match;
  const double all = (high_in + high_out) * (ground_in + ground_out) * (high_in + ground_in) * (high_out + ground_out);
  match.correlation = all > 0 ? (high_in * ground_out - high_out * ground_in) / std::sqrt(all) : 0;
  const double shown_in = high_in + ground_in;
  match.inside = shown_in > 0 ? high_in / shown_in : 0;
  match.met = std::max(outlines.count > 0 ? shown_in / outlines.count : 0, relief.high > 0 ? high_in / relief.high : 0);
  match.x = static_cast<double>(move_column) * mesh.cell;
  match.y = static_cast<double>(move_row) * mesh.cell;
  return match;
}

/// A place is worth as much as it matches, and as much as is compared: a corner that matches by chance is worth little.
auto worth(const Match& match) -> double { return match.correlation * std::sqrt(match.met); }

/// The moves by which mesh and footprints meet in half of the smaller one, in each direction.
struct Moves {
  std::int64_t first_column, last_column, first_row, last_row;
  [[nodiscard]] auto count() const -> double {
    return static_cast<double>(last_column - first_column + 1) * static_cast<double>(last_row - first_row + 1);
  }
};

auto moves_of(const Grid& mesh, const Grid& plan) -> Moves {
  const auto range = [](std::int64_t mesh_at, std::size_t mesh_n, std::int64_t plan_at, std::size_t plan_n) {
    const auto least = static_cast<std::int64_t>(std::min(mesh_n, plan_n) / 2);
    return std::pair{plan_at + least - static_cast<std::int64_t>(mesh_n) - mesh_at,
                     plan_at + static_cast<std::int64_t>(plan_n) - least - mesh_at};
  };
  const auto [left, right] = range(mesh.column, mesh.columns, plan.column, plan.columns);
  const auto [below, above] = range(mesh.row, mesh.rows, plan.row, plan.rows);
  return {left, right, below, above};
}

auto better(const Match& a, const Match& b) -> bool {
  if (worth(a) != worth(b)) return worth(a) > worth(b);
  return std::pair(a.x, a.y) < std::pair(b.x, b.y);
}

}  // namespace

auto match_at(const geometry::Mesh& mesh, std::span<const geometry::Polygon> footprints, double x, double y,
              const Options& options) -> std::optional<Match> {
  if (mesh.triangles.empty() || footprints.empty()) return std::nullopt;
  geometry::Mesh moved = mesh;
  for (auto& vertex : moved.vertices) vertex.x += x, vertex.y += y;
  if (!box_of(moved).overlaps(geometry::bounds(footprints))) return std::nullopt;
  auto match = compare(relief_of(moved, options.cell, options), outlines_of(footprints, options.cell), 0, 0);
  match.x = x;
  match.y = y;
  return match;
}

auto best_match(const geometry::Mesh& mesh, std::span<const geometry::Polygon> footprints, const Options& options,
                const base::Run& run) -> std::optional<Match> {
  if (mesh.triangles.empty() || footprints.empty()) return std::nullopt;
  // Cells double until all moves can be tried.
  double cell = options.cell;
  const auto mesh_box = box_of(mesh), plan_box = geometry::bounds(footprints);
  for (;; cell *= 2) {
    const auto plan = grid_over(plan_box.grown(2 * cell), cell);
    if (moves_of(grid_over(mesh_box, cell), plan).count() * static_cast<double>(plan.cells()) <= options.comparisons)
      break;
  }
  std::optional<Match> best;
  double next = 0;
  {
    const auto relief = relief_of(mesh, cell, options);
    const auto outlines = outlines_of(footprints, cell);
    const auto moves = moves_of(relief.grid, outlines.grid);
    const auto rows = static_cast<std::size_t>(moves.last_row - moves.first_row + 1);
    std::vector<std::vector<Match>> tried(rows);
    base::parallel_for(rows, [&](std::size_t r) {
      if (run.cancelled()) return;
      for (auto column = moves.first_column; column <= moves.last_column; ++column)
        tried[r].push_back(compare(relief, outlines, column, moves.first_row + static_cast<std::int64_t>(r)));
    });
    if (run.cancelled()) return std::nullopt;
    for (const auto& row : tried)
      for (const auto& match : row)
        if (match.correlation > 0 && (!best || better(match, *best))) best = match;
    if (!best) return std::nullopt;
    const double far = std::max(plan_box.most.x - plan_box.least.x, plan_box.most.y - plan_box.least.y) / 4;
    for (const auto& row : tried)
      for (const auto& match : row)
        if (std::hypot(match.x - best->x, match.y - best->y) > far) next = std::max(next, match.correlation);
  }
  while (cell > options.cell) {
    cell = std::max(cell / 2, options.cell);
    const auto relief = relief_of(mesh, cell, options);
    const auto outlines = outlines_of(footprints, cell);
    const auto column = static_cast<std::int64_t>(std::llround(best->x / cell)),
               row = static_cast<std::int64_t>(std::llround(best->y / cell));
    std::optional<Match> finer;
    for (auto r = row - 3; r <= row + 3; ++r)
      for (auto c = column - 3; c <= column + 3; ++c)
        if (const auto match = compare(relief, outlines, c, r); !finer || better(match, *finer)) finer = match;
    best = finer;
  }
  best->next = next;
  for (const double unit : {100.0, 50.0, 10.0}) {
    const double x = std::round(best->x / unit) * unit, y = std::round(best->y / unit) * unit;
    if (std::abs(x - best->x) > options.round_within || std::abs(y - best->y) > options.round_within) continue;
    best->x = x;
    best->y = y;
    best->round = true;
    break;
  }
  return best;
}

}  // namespace mansard::align
