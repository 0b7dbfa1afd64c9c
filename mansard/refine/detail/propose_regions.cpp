#include "mansard/refine/detail/propose_regions.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "mansard/base/disjoint_sets.hpp"
#include "mansard/planes/planes.hpp"
#include "mansard/refine/detail/propose_surface.hpp"

namespace mansard::refine::detail::carve {
namespace {

using Mask = std::vector<std::uint8_t>;

/// Residuals with unseen gaps filled from around.
auto filled(const Raster& raster, std::int64_t gap_cells) -> std::vector<float> {
  std::vector<float> out = raster.residual;
  std::vector<Cell> state = raster.state;
  for (std::int64_t pass = 0; pass < gap_cells; ++pass) {
    std::vector<std::pair<std::size_t, float>> found;
    for (int j = 0; j < raster.rows; ++j)
      for (int i = 0; i < raster.columns; ++i) {
        if (state[raster.at(i, j)] != Cell::unseen) continue;
        float sum = 0, n = 0;
        for (const auto& [di, dj] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
          if (!raster.inside(i + di, j + dj) || state[raster.at(i + di, j + dj)] != Cell::seen) continue;
          sum += out[raster.at(i + di, j + dj)];
          n += 1;
        }
        if (n > 0) found.emplace_back(raster.at(i, j), sum / n);
      }
    if (found.empty()) break;
    for (const auto& [k, value] : found) {
      out[k] = value;
      state[k] = Cell::seen;
    }
  }
  return out;
}

/// Cells that are `by` cells or fewer, along a row or a column, from one that is off go off; where `ends`, also those
/// as near to the raster's border.
auto shrunk_cells(const Raster& raster, const Mask& mask, int by, bool ends = true) -> Mask {
  const auto columns = static_cast<std::size_t>(raster.columns), cells = mask.size();
  const auto step = [&](const Mask& in, std::size_t stride, std::size_t line) {
    // Every line of `line` cells on its own; a whole raster is one line of rows.
    Mask out = in;
    for (std::size_t start = 0; start < cells; start += line)
      for (std::size_t d = stride; d <= static_cast<std::size_t>(by) * stride; d += stride) {
        const std::size_t shared = d < line ? line - d : 0;
        const std::uint8_t* from = in.data() + start;
        std::uint8_t* to = out.data() + start;
        for (std::size_t k = 0; k < shared; ++k) to[k] &= from[k + d];
        for (std::size_t k = 0; k < shared; ++k) to[k + d] &= from[k];
        if (!ends) continue;
        for (std::size_t k = line - std::min(line, d); k < line; ++k) out[start + k] = 0;
        for (std::size_t k = 0; k < std::min(line, d); ++k) out[start + k] = 0;
      }
    return out;
  };
  return cells == 0 ? mask : step(step(mask, 1, columns), columns, cells);
}

/// Only what a square of twice `by` cells and one can sweep over.
auto opened(const Raster& raster, const Mask& mask, int by) -> Mask {
  Mask off = shrunk_cells(raster, mask, by);
  for (auto& m : off) m = m ? 0 : 1;
  off = shrunk_cells(raster, off, by, false);  // growing is shrinking the rest
  Mask out(mask.size());
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = mask[k] && !off[k] ? 1 : 0;
  return out;
}

/// A stretch of a row.
struct Run {
  int row, first, last;  // last is not in it
};

/// The mask's runs by component, each in the order of rows; components in the order of their first cells.
auto components(const Raster& raster, const Mask& mask) -> std::vector<std::vector<Run>> {
  std::vector<Run> runs;
  std::vector<std::size_t> row_begin;
  for (int row = 0; row < raster.rows; ++row) {
    row_begin.push_back(runs.size());
    for (int i = 0; i < raster.columns; ++i) {
      if (!mask[raster.at(i, row)]) continue;
      const int first = i;
      while (i < raster.columns && mask[raster.at(i, row)]) ++i;
      runs.push_back({row, first, i});
    }
  }
  row_begin.push_back(runs.size());
  base::DisjointSets sets(runs.size());
  for (std::size_t row = 1; row + 1 < row_begin.size(); ++row) {
    std::size_t above = row_begin[row - 1];
    for (std::size_t k = row_begin[row]; k < row_begin[row + 1]; ++k) {
      while (above < row_begin[row] && runs[above].last <= runs[k].first) ++above;
      for (std::size_t a = above; a < row_begin[row] && runs[a].first < runs[k].last; ++a)
        sets.join(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(k));
    }
  }
  constexpr std::size_t none = ~std::size_t{0};
  std::vector<std::size_t> place(runs.size(), none);
  std::vector<std::vector<Run>> out;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    std::size_t& at = place[sets.of(static_cast<std::uint32_t>(k))];
    if (at == none) {
      at = out.size();
      out.emplace_back();
    }
    out[at].push_back(runs[k]);
  }
  return out;
}

void add_components(const Raster& raster, const Mask& mask, double least_area, double seen_share,
                    std::vector<Region>& out) {
  const double least_cells = least_area / raster.cell_area();
  if (static_cast<double>(std::ranges::count(mask, 1)) < least_cells) return;
  for (const std::vector<Run>& runs : components(raster, mask)) {
    std::size_t cells = 0, seen = 0;
    for (const Run& run : runs) cells += static_cast<std::size_t>(run.last - run.first);
    if (static_cast<double>(cells) < least_cells) continue;
    Region region{Mask(mask.size(), 0), raster.columns, 0, runs.front().row, runs.back().row, cells};
    for (const Run& run : runs) {
      region.least_column = std::min(region.least_column, run.first);
      region.most_column = std::max(region.most_column, run.last - 1);
      for (int i = run.first; i < run.last; ++i) {
        region.mask[raster.at(i, run.row)] = 1;
        if (raster.state[raster.at(i, run.row)] == Cell::seen) ++seen;
      }
    }
    if (static_cast<double>(seen) >= seen_share * static_cast<double>(cells)) out.push_back(std::move(region));
  }
}

/// Per cell the plane of a sample in it; where there is none, that of a cell within `near` metres.
auto planes_by_cell(const Raster& raster, const OnPlanes& samples, double near) -> std::vector<std::uint32_t> {
  constexpr std::uint32_t none = planes::Found::none;
  std::vector<std::uint32_t> out(raster.z.size(), none);
  for (std::size_t i = 0; i < samples.places.size(); ++i) {
    const geometry::Point2 at = raster.frame.to(samples.places[i]);
    const auto column = static_cast<int>(std::lround((at.x - raster.least.x) / raster.spacing)),
               row = static_cast<int>(std::lround((at.y - raster.least.y) / raster.spacing));
    if (raster.inside(column, row) && out[raster.at(column, row)] == none)
      out[raster.at(column, row)] = samples.planes[i];
  }
  const auto passes = static_cast<int>(std::ceil(near / raster.spacing));
  for (int pass = 0; pass < passes; ++pass) {
    const auto before = out;
    for (int j = 0; j < raster.rows; ++j)
      for (int i = 0; i < raster.columns; ++i) {
        if (!raster.inside(i, j) || before[raster.at(i, j)] != none) continue;
        for (const auto& [di, dj] : {std::pair{0, 1}, {1, 0}, {0, -1}, {-1, 0}})
          if (raster.inside(i + di, j + dj) && before[raster.at(i + di, j + dj)] != none) {
            out[raster.at(i, j)] = before[raster.at(i + di, j + dj)];
            break;
          }
      }
  }
  return out;
}

/// Of the samples on each plane, from the raster's first cell.
auto fitted_planes(const Raster& raster, const OnPlanes& samples) -> std::map<std::uint32_t, geometry::FittedPlane> {
  std::map<std::uint32_t, geometry::PlaneSums> sums;
  for (std::size_t i = 0; i < samples.places.size(); ++i) {
    if (samples.planes[i] >= planes::Found::wall) continue;
    const geometry::Point2 at = raster.frame.to(samples.places[i]) - raster.least;
    sums[samples.planes[i]].add(at.x, at.y, samples.heights[i]);
  }
  std::map<std::uint32_t, geometry::FittedPlane> out;
  for (const auto& [number, sum] : sums) out.emplace(number, plane_of(sum));
  return out;
}

/// Groups of planes, each ascending, that meet in ridges and hips: a valley or a step parts two roofs, a ridge does
/// not. Parts of shapes that meet in convex edges alone are one thing (Stein et al., Object Partitioning using Local
/// Convexity, 2014).
auto under_one_roof(const Raster& raster, const OnPlanes& samples, const std::vector<std::uint32_t>& label,
                    const Options& options) -> std::vector<std::vector<std::uint32_t>> {
  const auto planes = fitted_planes(raster, samples);
  // Between two planes is no sample nearer to where they meet than that.
  const double between = std::sqrt(samples.area) + options.samples.melt;
  struct Border {
    std::size_t cells = 0, ridge = 0;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, Border> borders;
  for (int j = 0; j < raster.rows; ++j)
    for (int i = 0; i < raster.columns; ++i)
      for (const auto& [di, dj] : {std::pair{1, 0}, {0, 1}}) {
        if (!raster.inside(i, j) || !raster.inside(i + di, j + dj)) continue;
        const auto a = label[raster.at(i, j)], b = label[raster.at(i + di, j + dj)];
        if (a == b || a >= planes::Found::wall || b >= planes::Found::wall) continue;
        const auto &one = planes.at(a), &other = planes.at(b);
        const double x = (i + di / 2.0) * raster.spacing, y = (j + dj / 2.0) * raster.spacing;
        const geometry::Point2 turn = other.slope - one.slope;
        const double apart = std::abs(one.at(x, y) - other.at(x, y));
        Border& border = borders[{std::min(a, b), std::max(a, b)}];
        ++border.cells;
        if (di * turn.x + dj * turn.y < 0 && apart <= options.lines.robust + between * length(turn)) ++border.ridge;
      }
  std::vector<std::uint32_t> numbers;
  for (const auto& [number, plane] : planes) numbers.push_back(number);
  const auto index = [&](std::uint32_t number) {
    return static_cast<std::uint32_t>(std::ranges::lower_bound(numbers, number) - numbers.begin());
  };
  base::DisjointSets sets(numbers.size());
  for (const auto& [pair, border] : borders)
    if (2 * border.ridge > border.cells) sets.join(index(pair.first), index(pair.second));
  std::map<std::size_t, std::vector<std::uint32_t>> groups;
  for (const auto number : numbers) groups[sets.of(index(number))].push_back(number);
  std::vector<std::vector<std::uint32_t>> out;
  for (auto& [root, group] : groups)
    if (group.size() > 1 && group.size() < numbers.size()) out.push_back(std::move(group));
  return out;
}

/// Cells: half of the least width, so that what is narrower vanishes.
auto half_width(const Raster& raster, const Options& options) -> int {
  return std::max(1, static_cast<int>(std::lround(options.cuts.min_width / 2 / raster.spacing - 0.5)));
}

}  // namespace

auto shrunk(const Raster& raster, const Mask& mask, double by) -> Mask {
  return shrunk_cells(raster, mask, static_cast<int>(std::lround(by / raster.spacing)));
}

auto grown(const Raster& raster, const Mask& mask, double by) -> Mask {
  Mask off(mask.size());
  for (std::size_t k = 0; k < off.size(); ++k) off[k] = mask[k] ? 0 : 1;
  off = shrunk_cells(raster, off, static_cast<int>(std::lround(by / raster.spacing)), false);
  for (auto& o : off) o = o ? 0 : 1;
  return off;
}

auto regions_of(const Raster& raster, const Options& options) -> std::vector<Region> {
  const auto& o = options.regions;
  const std::vector<float> residual = filled(raster, o.gap_cells);
  const int by = half_width(raster, options);
  std::vector<Region> out;
  for (const float way : {1.0F, -1.0F}) {
    Mask mask(residual.size());
    for (std::size_t k = 0; k < mask.size(); ++k)
      mask[k] = raster.state[k] != Cell::outside && way * residual[k] > options.cuts.min_step ? 1 : 0;
    const std::size_t before = out.size();
    mask = opened(raster, mask, by);
    add_components(raster, mask, o.min_area_share * options.cuts.min_area, o.seen_share, out);
    // What a region runs around may be the simpler outline of the same cut.
    for (std::size_t i = before, end = out.size(); i < end; ++i) {
      const double box = (out[i].most_column - out[i].least_column + 1.0) * (out[i].most_row - out[i].least_row + 1.0);
      if (static_cast<double>(out[i].cells) > o.hollow_share * box) continue;
      Mask rest(mask.size());
      for (std::size_t k = 0; k < rest.size(); ++k)
        rest[k] = raster.state[k] != Cell::outside && !out[i].mask[k] ? 1 : 0;
      add_components(raster, opened(raster, rest, by), options.cuts.min_area, o.seen_share, out);
    }
  }
  return out;
}

auto regions_of_planes(const Raster& raster, const OnPlanes& samples, double least_gain, const Options& options)
    -> std::vector<Region> {
  const auto label = planes_by_cell(raster, samples, std::max(raster.spacing, std::sqrt(samples.area)));
  std::map<std::uint32_t, double> off;
  for (std::size_t k = 0; k < label.size(); ++k)
    if (label[k] < planes::Found::wall && raster.state[k] == Cell::seen)
      off[label[k]] += static_cast<double>(raster.residual[k]) * raster.residual[k] * raster.cell_area();
  std::vector<std::vector<std::uint32_t>> groups;
  for (const auto& [plane, gain] : off) groups.push_back({plane});
  std::ranges::move(under_one_roof(raster, samples, label, options), std::back_inserter(groups));
  std::vector<Region> out;
  for (const auto& group : groups) {
    double gain = 0;
    for (const auto plane : group)
      if (const auto found = off.find(plane); found != off.end()) gain += found->second;
    if (gain < least_gain) continue;
    Mask mask(label.size());
    for (std::size_t k = 0; k < mask.size(); ++k) mask[k] = std::ranges::binary_search(group, label[k]) ? 1 : 0;
    add_components(raster, opened(raster, mask, half_width(raster, options)),
                   options.regions.min_area_share * options.cuts.min_area, 0, out);
  }
  return out;
}

}  // namespace mansard::refine::detail::carve
