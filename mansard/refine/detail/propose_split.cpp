#include "mansard/refine/detail/propose_split.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mansard/refine/detail/propose_outline.hpp"
#include "mansard/refine/detail/propose_surface.hpp"

namespace mansard::refine::detail::carve {
namespace {

/// Running sums over columns; entry i is of the columns before i.
struct Sums {
  std::vector<Moments> cells;
  std::vector<geometry::LineSums> along;  // x from the raster's corner
  std::vector<double> area;               // cells in the part, seen or not
};

auto sums_of(const Raster& raster) -> Sums {
  const auto count = static_cast<std::size_t>(raster.columns);
  std::vector<Moments> cells(count);
  std::vector<geometry::LineSums> along(count);
  std::vector<double> area(count, 0);
  for (int j = 0; j < raster.rows; ++j)
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t k = raster.at(static_cast<int>(i), j);
      if (raster.state[k] != Cell::outside) area[i] += 1;
      if (raster.state[k] != Cell::seen) continue;
      const double t = raster.spacing * static_cast<double>(i);
      cells[i].add(t, raster.spacing * j, raster.z[k], raster.residual[k]);
      along[i].add(t, raster.z[k]);
    }
  Sums out{std::vector<Moments>(count + 1), std::vector<geometry::LineSums>(count + 1),
           std::vector<double>(count + 1, 0)};
  for (std::size_t i = 0; i < count; ++i) {
    out.cells[i + 1] = out.cells[i];
    out.cells[i + 1] += cells[i];
    out.along[i + 1] = out.along[i];
    out.along[i + 1] += along[i];
    out.area[i + 1] = out.area[i] + area[i];
  }
  return out;
}

/// Rows in the part on both sides of a line.
auto rows_across(const Raster& raster, int column) -> std::vector<int> {
  std::vector<int> out;
  for (int j = 0; j < raster.rows; ++j)
    if (raster.inside(column - 1, j) && raster.inside(column, j)) out.push_back(j);
  return out;
}

/// Heights summed along each row, so that the mean of any stretch is at hand.
class RowSums {
 public:
  explicit RowSums(const Raster& raster) : raster_(raster), stride_(static_cast<std::size_t>(raster.columns) + 1) {
    const std::size_t size = stride_ * static_cast<std::size_t>(raster.rows);
    sum_.assign(size, 0);
    count_.assign(size, 0);
    for (int j = 0; j < raster.rows; ++j)
      for (int i = 0; i < raster.columns; ++i) {
        const std::size_t k = raster.at(i, j), at = stride_ * static_cast<std::size_t>(j) + static_cast<std::size_t>(i);
        const bool seen = raster.state[k] == Cell::seen;
        sum_[at + 1] = sum_[at] + (seen ? static_cast<double>(raster.z[k]) : 0.0);
        count_[at + 1] = count_[at] + (seen ? 1 : 0);
      }
  }

  /// Mean height `near` to `far` metres from a line before the column, going `way`; NaN where unseen.
  [[nodiscard]] auto beside(int row, int column, int way, double near, double far) const -> double {
    const int a = static_cast<int>(std::lround(near / raster_.spacing)),
              b = static_cast<int>(std::lround(far / raster_.spacing));
    const int first = std::clamp(way > 0 ? column + a : column - b, 0, raster_.columns);
    const int last = std::clamp(way > 0 ? column + b : column - a, 0, raster_.columns);
    const std::size_t base = stride_ * static_cast<std::size_t>(row);
    const double n = count_[base + static_cast<std::size_t>(last)] - count_[base + static_cast<std::size_t>(first)];
    if (n <= 0) return std::numeric_limits<double>::quiet_NaN();
    return (sum_[base + static_cast<std::size_t>(last)] - sum_[base + static_cast<std::size_t>(first)]) / n;
  }

 private:
  const Raster& raster_;
  std::size_t stride_;
  std::vector<double> sum_, count_;
};

/// What the heights do along a line: in most rows a step, or in most a valley, or the line is one of sums only, drawn
/// by something that stands on one side of it.
struct Crossing {
  bool step = false, valley = false;
};

auto crossing_at(const RowSums& sums, const std::vector<int>& rows, int column, const Options& options) -> Crossing {
  const double least = options.lines.robust, share = options.splits.row_share;
  const double near = options.samples.melt, far = reach_beside(options);
  double known = 0, steps = 0, valleys = 0;
  for (const int row : rows) {
    const double left = sums.beside(row, column, -1, near, far), right = sums.beside(row, column, 1, near, far);
    if (!std::isfinite(left + right)) continue;
    const double middle = (sums.beside(row, column, -1, 0, near) + sums.beside(row, column, 1, 0, near)) / 2;
    known += 1;
    if (std::abs(left - right) >= least) steps += 1;
    if (std::min(left, right) - middle >= least) valleys += 1;
  }
  return {known > 0 && steps > share * known, known > 0 && valleys > share * known};
}

/// Per line before column i that leaves enough on either side.
auto crossings_of(const Raster& raster, const Options& options) -> std::vector<Crossing> {
  const RowSums sums(raster);
  const auto count = static_cast<std::size_t>(raster.columns);
  const auto side = static_cast<std::size_t>(std::ceil(options.cuts.line_min_width / raster.spacing));
  std::vector<Crossing> out(count + 1);
  for (std::size_t i = side; i + side <= count; ++i) {
    const int column = static_cast<int>(i);
    out[i] = crossing_at(sums, rows_across(raster, column), column, options);
  }
  return out;
}

/// The error of the columns before i, and from i on, by ridges along x; for the lines that are asked for.
void add_ridges_along(const Raster& raster, const std::vector<std::uint8_t>& asked, const Options& options,
                      std::vector<double>& before, std::vector<double>& from) {
  const int rows_per_bin = static_cast<int>(options.splits.rows_per_bin);
  const auto bins = static_cast<std::size_t>((raster.rows + rows_per_bin - 1) / rows_per_bin);
  const double step = raster.spacing * rows_per_bin, first = -raster.spacing / 2;
  const auto sweep = [&](std::vector<double>& errors, bool backwards) {
    std::vector<geometry::LineSums> heap(bins), sums(bins + 1);
    for (int c = 0; c < raster.columns; ++c) {
      const int column = backwards ? raster.columns - 1 - c : c;
      for (int j = 0; j < raster.rows; ++j) {
        const std::size_t k = raster.at(column, j);
        if (raster.state[k] != Cell::seen) continue;
        heap[static_cast<std::size_t>(j / rows_per_bin)].add(raster.spacing * j, raster.z[k]);
      }
      const auto i = static_cast<std::size_t>(backwards ? column : column + 1);
      if (!asked[i]) continue;
      for (std::size_t b = 0; b < bins; ++b) {
        sums[b + 1] = sums[b];
        sums[b + 1] += heap[b];
      }
      errors[i] = std::min(errors[i], best_ridge_error(sums, first, step, options.surfaces));
    }
  };
  sweep(before, false);
  sweep(from, true);
}

/// Per line before column i where the heights do something, what it explains; else negative.
auto gains_of(const Raster& raster, const std::vector<Crossing>& crossings, const Options& options)
    -> std::vector<double> {
  const Sums sums = sums_of(raster);
  const auto count = static_cast<std::size_t>(raster.columns);
  const double first = -raster.spacing / 2, least_cells = options.cuts.min_area / raster.cell_area();
  std::vector<std::uint8_t> asked(count + 1, 0);
  for (std::size_t i = 0; i < count; ++i)
    asked[i] = (crossings[i].step || crossings[i].valley) && sums.area[i] >= least_cells &&
               sums.area.back() - sums.area[i] >= least_cells;
  asked[count] = 1;  // the whole part
  std::vector<double> before(count + 1, 0), from(count + 1, 0), out(count + 1, -1);
  const std::span<const geometry::LineSums> along(sums.along);
  for (std::size_t i = 0; i <= count; ++i) {
    if (!asked[i]) continue;
    Moments rest = sums.cells.back();
    rest -= sums.cells[i];
    const double knot = first + raster.spacing * static_cast<double>(i);
    before[i] = std::min(plain_error(sums.cells[i]),
                         best_ridge_error(along.first(i + 1), first, raster.spacing, options.surfaces));
    from[i] = std::min(plain_error(rest), best_ridge_error(along.subspan(i), knot, raster.spacing, options.surfaces));
  }
  add_ridges_along(raster, asked, options, before, from);
  for (std::size_t i = 0; i < count; ++i)
    if (asked[i]) {
      const Moments &all = sums.cells.back(), &left = sums.cells[i];
      out[i] = gain_of({left.count, left.rr, before[i]}, {all.count - left.count, all.rr - left.rr, from[i]},
                       {all.count, all.rr, before.back()}, options.surfaces);
    }
  return out;
}

/// The line before column i; a valley's moved to where between columns its best gain is.
auto line_at(const Raster& raster, std::size_t i, const std::vector<double>& gains, const Crossing& crossing)
    -> SplitLine {
  const int column = static_cast<int>(i);
  SplitLine line{raster.x(column) - raster.spacing / 2, gains[i], !crossing.valley};
  if (line.step) return line;
  const double before = gains[i - 1], after = gains[i + 1], bend = 2 * gains[i] - before - after;
  // The top of the parabola through three, where they have one.
  if (before >= 0 && after >= 0 && gains[i] >= std::max(before, after) && bend > 0)
    line.at += raster.spacing * (after - before) / (2 * bend);
  return line;
}

}  // namespace

auto split_lines(const Raster& raster, double least_gain, const Options& options) -> std::vector<SplitLine> {
  const std::vector<Crossing> crossings = crossings_of(raster, options);
  const std::vector<double> gains = gains_of(raster, crossings, options);
  const auto reach = static_cast<std::ptrdiff_t>(std::lround(options.splits.apart / raster.spacing));
  const auto count = static_cast<std::ptrdiff_t>(gains.size());
  const auto g = [&](std::ptrdiff_t k) {
    return gains[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(k, 0, count - 1))];
  };
  std::vector<SplitLine> out;
  for (std::ptrdiff_t i = 1; i + 1 < count; ++i) {
    bool top = g(i) * raster.cell_area() >= least_gain;
    for (std::ptrdiff_t d = 1; d <= reach && top; ++d) top = g(i) > g(i - d) && g(i) >= g(i + d);
    if (top) out.push_back(line_at(raster, static_cast<std::size_t>(i), gains, crossings[static_cast<std::size_t>(i)]));
  }
  std::ranges::stable_sort(out, std::greater{}, &SplitLine::gain);
  const auto most = static_cast<std::size_t>(options.splits.max_count);
  if (out.size() > most) out.resize(most);
  return out;
}

}  // namespace mansard::refine::detail::carve
