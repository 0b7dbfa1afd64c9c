#include "mansard/refine/detail/propose_regions.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>

#include "mansard/base/disjoint_sets.hpp"
#include "mansard/geometry/angles.hpp"
#include "mansard/planes/planes.hpp"

namespace mansard::refine::detail::carve {
namespace {

using Mask = std::vector<std::uint8_t>;

/// Error bound, m: a rise is the difference of two floats below 1e3 m, exact to 6e-5 m; one of less than this is 0.
constexpr double no_rise = 1e-6;

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

/// Levels, m, ascending, that part the residuals into heaps.
auto levels_of(const Raster& raster, const std::vector<float>& residual, const Options& options)
    -> std::vector<double> {
  const auto& o = options.regions;
  const double bin = o.bin, highest = o.max_residual;
  const auto count = static_cast<std::size_t>(2 * highest / bin) + 1;
  std::vector<double> raw(count, 0), heap(count, 0);
  for (std::size_t k = 0; k < residual.size(); ++k)
    if (raster.state[k] == Cell::seen)
      raw[static_cast<std::size_t>((std::clamp<double>(residual[k], -highest, highest) + highest) / bin)] +=
          raster.cell_area();
  for (std::size_t b = 1; b + 1 < count; ++b) heap[b] = (raw[b - 1] + 2 * raw[b] + raw[b + 1]) / 4;

  struct Level {
    double height, weight;
  };
  std::vector<Level> found;
  std::size_t peak = 0;    // of the heap before
  std::size_t lowest = 0;  // since then
  for (std::size_t b = 1; b + 1 < count; ++b) {
    const bool top =
        heap[b] > heap[b - 1] && heap[b] >= heap[b + 1] && 3 * heap[b] >= o.peak_share * options.cuts.min_area;
    if (heap[b] < heap[lowest]) lowest = b;
    if (!top) continue;
    const double smaller = std::min(heap[peak], heap[b]);
    if (peak != 0 && heap[lowest] < o.valley * smaller) {
      // Half way between the heaps is where a melted wall is crossed.
      const double middle = (static_cast<double>(peak + b) + 1) / 2 * bin - highest;
      found.push_back({middle, smaller});
      peak = lowest = b;
    } else if (heap[b] > heap[peak]) {
      peak = lowest = b;
    }
  }
  std::ranges::stable_sort(found, std::greater{}, &Level::weight);
  const auto most = static_cast<std::size_t>(o.max_levels);
  if (found.size() > most) found.resize(most);
  std::vector<double> out;
  for (const Level& level : found) out.push_back(level.height);
  std::ranges::sort(out);
  return out;
}

/// Every pair of bounds, m, between which a structure may stand; the model itself lies in none.
auto bands_of(const std::vector<double>& levels, const Options& options) -> std::vector<std::pair<double, double>> {
  constexpr double unbounded = 1e9;  // m; above every residual
  const double least_step = options.cuts.min_step, clear = options.regions.level_clearance * least_step;
  std::vector<double> above{least_step}, below{-least_step};
  for (const double level : levels) {
    if (level > clear) above.push_back(level);
    if (level < -clear) below.push_back(level);
  }
  std::ranges::sort(below, std::greater{});
  std::vector<std::pair<double, double>> out;
  for (std::size_t i = 0; i < above.size(); ++i) {
    out.emplace_back(above[i], unbounded);
    if (i + 1 < above.size()) out.emplace_back(above[i], above[i + 1]);
  }
  for (std::size_t i = 0; i < below.size(); ++i) {
    out.emplace_back(-unbounded, below[i]);
    if (i + 1 < below.size()) out.emplace_back(below[i + 1], below[i]);
  }
  return out;
}

/// Per cell the plane of a point in it; where there is none, that of a cell within `near` metres.
auto planes_by_cell(const Raster& raster, const OnPlanes& points, double near) -> std::vector<std::uint32_t> {
  constexpr std::uint32_t none = planes::Found::none;
  std::vector<std::uint32_t> out(raster.z.size(), none);
  for (std::size_t i = 0; i < points.places.size(); ++i) {
    const geometry::Point2 at = raster.frame.to(points.places[i]);
    const auto column = static_cast<int>(std::lround((at.x - raster.least.x) / raster.spacing)),
               row = static_cast<int>(std::lround((at.y - raster.least.y) / raster.spacing));
    if (raster.inside(column, row) && out[raster.at(column, row)] == none)
      out[raster.at(column, row)] = points.planes[i];
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

void leave_out_strays(Raster& raster, const Options& options) {
  const auto limit = static_cast<float>(options.robust);
  for (const float way : {1.0F, -1.0F}) {
    // Half of the limit, so that noise about the limit makes no holes.
    Mask off(raster.z.size());
    for (std::size_t k = 0; k < off.size(); ++k)
      off[k] = raster.state[k] == Cell::seen && way * raster.residual[k] > limit / 2 ? 1 : 0;
    const Mask wide = opened(raster, off, half_width(raster, options));
    for (std::size_t k = 0; k < off.size(); ++k)
      if (way * raster.residual[k] > limit && !wide[k])
        raster.state[k] = Cell::unseen, raster.z[k] = raster.residual[k] = 0;
  }
}

auto regions_of(const Raster& raster, const Options& options) -> std::vector<Region> {
  const auto& o = options.regions;
  const std::vector<float> residual = filled(raster, o.gap_cells);
  const int by = half_width(raster, options);
  std::vector<Region> out;
  for (const auto& [low, high] : bands_of(levels_of(raster, residual, options), options)) {
    Mask mask(residual.size());
    for (std::size_t k = 0; k < mask.size(); ++k)
      mask[k] = raster.state[k] != Cell::outside && residual[k] > low && residual[k] < high ? 1 : 0;
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

auto regions_of_planes(const Raster& raster, const OnPlanes& points, double least_gain, const Options& options)
    -> std::vector<Region> {
  const auto label = planes_by_cell(raster, points, std::sqrt(options.samples.point_area));
  std::map<std::uint32_t, double> off;
  for (std::size_t k = 0; k < label.size(); ++k)
    if (label[k] < planes::Found::wall && raster.state[k] == Cell::seen)
      off[label[k]] += static_cast<double>(raster.residual[k]) * raster.residual[k] * raster.cell_area();
  std::vector<Region> out;
  for (const auto& [plane, gain] : off) {
    if (gain < least_gain) continue;
    Mask mask(label.size());
    for (std::size_t k = 0; k < mask.size(); ++k) mask[k] = label[k] == plane ? 1 : 0;
    add_components(raster, opened(raster, mask, half_width(raster, options)),
                   options.regions.min_area_share * options.cuts.min_area, 0, out);
  }
  return out;
}

auto own_direction(const Raster& raster, const Region& region, const Options::Regions& options, Frame& direction)
    -> bool {
  const int rim_cells = static_cast<int>(options.rim_cells);
  std::complex<double> sum = 0;
  double total = 0;
  const auto r = [&](int i, int j) { return static_cast<double>(raster.residual[raster.at(i, j)]); };
  for (int j = std::max(1, region.least_row - rim_cells); j <= std::min(raster.rows - 2, region.most_row + rim_cells);
       ++j)
    for (int i = std::max(1, region.least_column - rim_cells);
         i <= std::min(raster.columns - 2, region.most_column + rim_cells); ++i) {
      bool rim = false, known = true;
      for (const auto& [di, dj] : {std::pair{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        const std::size_t k = raster.at(i + di, j + dj);
        known = known && raster.state[k] == Cell::seen;
        rim = rim || region.mask[k] != region.mask[raster.at(i, j)];
      }
      if (!rim || !known) continue;
      const std::complex<double> rise(r(i + 1, j) - r(i - 1, j), r(i, j + 1) - r(i, j - 1));
      const double size = std::abs(rise);
      if (size < no_rise) continue;
      const std::complex<double> unit = rise / size, twice = unit * unit;
      sum += size * twice * twice;  // four times the angle: walls at right angles agree
      total += size;
    }
  if (total <= 0 || std::abs(sum) < options.agreement * total) return false;
  const double angle = geometry::arc_tangent(sum.imag(), sum.real()) / 4;
  const geometry::Point2 own{geometry::cosine(angle), geometry::sine(angle)};
  direction = {raster.frame.back(own)};
  return true;
}

}  // namespace mansard::refine::detail::carve
