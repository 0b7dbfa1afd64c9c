#include "mansard/sweep/detail/bases.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "mansard/base/statistics.hpp"
#include "mansard/geometry/angles.hpp"
#include "mansard/geometry/fit.hpp"

namespace mansard::sweep::detail {

using geometry::Point2;
using geometry::Segment2;

namespace {

/// A little less than half: of lines of one length, half of them are half of the sum only by rounding.
constexpr double half_way = 0.5 - 1e-6;

/// m; an extent is a difference of two heights up to 10 km, each off by half a unit in the last place (2⁻⁴⁰ m), plus
/// the interval: 4 · 2⁻⁴⁰ m < 1e-9 m, and no slice interval is so fine.
constexpr double height_rounding = 1e-9;

struct Frame {
  Point2 origin, direction;
  [[nodiscard]] auto along(Point2 p) const -> double { return dot(p - origin, direction); }
  [[nodiscard]] auto outward(Point2 p) const -> double { return cross(direction, p - origin); }
  [[nodiscard]] auto point(double s, double depth) const -> Point2 {
    return origin + s * direction + depth * geometry::left_of(direction);
  }
};

/// The median direction by length: where most lines were turned to one GIS edge it is that edge's, to the last digit.
auto main_frame(const std::vector<WeighedLine>& lines) -> Frame {
  Point2 sum;
  for (const auto& l : lines) sum = sum + (l.line.segment.end - l.line.segment.start);
  const Point2 mean = normalised(sum);
  std::vector<std::pair<double, std::size_t>> turns;
  double total = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Point2 v = lines[i].line.segment.end - lines[i].line.segment.start;
    turns.push_back({geometry::arc_tangent(cross(mean, v), dot(mean, v)), i});
    total += lines[i].length;
  }
  std::sort(turns.begin(), turns.end());
  double passed = 0;
  for (const auto& [turn, i] : turns) {
    passed += lines[i].length;
    if (passed >= half_way * total) {
      const auto& s = lines[i].line.segment;
      return {lines.front().line.segment.start, normalised(s.end - s.start)};
    }
  }
  return {lines.front().line.segment.start, mean};
}

struct Sample {
  double z, depth;
};

struct Column {
  std::vector<Sample> samples;  // from below upwards, one a slice: the outermost
  std::size_t lines = 0;
  std::optional<double> foot;  // depth, m, positive outward
  double low = 0, high = 0;    // of the wall part, else of all samples

  /// Of a column that is used: it has one.
  [[nodiscard]] auto depth() const -> double { return foot.value_or(0); }
};

auto make_columns(const std::vector<WeighedLine>& lines, const slice::SliceStack& stack, const Frame& frame,
                  double first, std::size_t count, const Options& o) -> std::vector<Column> {
  std::vector<Column> columns(count);
  for (const auto& l : lines) {
    const double a = frame.along(l.line.segment.start), b = frame.along(l.line.segment.end);
    if (!(b > a)) continue;
    const double u = frame.outward(l.line.segment.start), v = frame.outward(l.line.segment.end);
    const double z = stack.slices[l.line.slice].height;
    const auto from = static_cast<std::size_t>(std::max(0.0, std::ceil((a - first) / o.column_width - 0.5)));
    for (auto k = from; k < count; ++k) {
      const double s = first + (static_cast<double>(k) + 0.5) * o.column_width;
      if (s > b) break;
      const double depth = u + (v - u) * (s - a) / (b - a);
      auto& column = columns[k];
      ++column.lines;
      if (!column.samples.empty() && column.samples.back().z == z)
        column.samples.back().depth = std::max(column.samples.back().depth, depth);
      else column.samples.push_back({z, depth});
    }
  }
  return columns;
}

struct Range {
  std::size_t first, last;  // samples, both inclusive
};

/// The runs of samples that go up steeply, by the slope over a window around each.
auto steep_runs(const std::vector<Sample>& samples, double interval, const Options& o) -> std::vector<Range> {
  std::vector<Range> runs;
  bool open = false;
  double depth_sum = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    geometry::LineSums sums;  // depth over height
    const auto take = [&](const Sample& s) { sums.add(s.z - samples[i].z, s.depth); };
    for (auto k = i; k < samples.size() && samples[k].z - samples[i].z <= 0.5 * o.wall_window; ++k) take(samples[k]);
    for (auto k = i; k > 0 && samples[i].z - samples[k - 1].z <= 0.5 * o.wall_window; --k) take(samples[k - 1]);
    const double n = sums.weight, spread = n * sums.xx - sums.x * sums.x;
    const bool steep = n >= 3 && spread > 0 && std::abs(n * sums.xz - sums.x * sums.z) < o.wall_slope * spread;
    const auto mean = [&] { return depth_sum / static_cast<double>(i - runs.back().first); };
    const bool goes_on = open &&
                         samples[i].z - samples[i - 1].z <= std::max(o.wall_gap_slices * interval, o.wall_gap) &&
                         std::abs(samples[i].depth - mean()) < o.wall_spread;
    if (steep && goes_on) {
      runs.back().last = i;
      depth_sum += samples[i].depth;
    } else if (steep) {
      runs.push_back({i, i});
      depth_sum = samples[i].depth;
    }
    open = steep;
  }
  return runs;
}

/// The lowest wall of the column that is not dwarfed by another one; above the untidy zone if there is one.
void find_foot(Column& column, double interval, double tidy, const Options& o) {
  const auto& samples = column.samples;
  if (samples.empty()) return;
  column.low = samples.front().z;
  column.high = samples.back().z;
  const auto runs = steep_runs(samples, interval, o);
  const auto extent = [&](const Range& r) { return samples[r.last].z - samples[r.first].z + interval; };
  for (const bool only_tidy : {true, false}) {
    std::vector<Range> walls;
    double tallest = 0;
    for (auto run : runs) {
      if (only_tidy)
        while (run.first < run.last && samples[run.first].z < tidy) ++run.first;
      if (only_tidy && samples[run.first].z < tidy) continue;
      if (extent(run) < o.wall_minimum_height - height_rounding) continue;
      walls.push_back(run);
      tallest = std::max(tallest, extent(run));
    }
    const auto wall = std::find_if(walls.begin(), walls.end(), [&](const Range& r) {
      return extent(r) >= o.wall_lower_share * tallest - height_rounding;
    });
    if (wall == walls.end()) continue;
    std::vector<double> depths;
    for (auto i = wall->first; i <= wall->last; ++i) depths.push_back(samples[i].depth);
    column.foot = base::mean_median(std::move(depths));
    // The wall goes on down through the zone that was left out.
    double low = samples[wall->first].z;
    for (const auto& r : runs)
      if (samples[r.first].z < low && samples[r.last].z >= low) low = samples[r.first].z;
    column.low = low;
    column.high = samples[wall->last].z;
    return;
  }
}

/// Without walls: the gutter, where the roof is lowest.
void find_gutter(Column& column, const Options& o) {
  std::vector<double> depths;
  for (const auto& s : column.samples) {
    if (s.z > column.samples.front().z + o.gutter_band) break;
    depths.push_back(s.depth);
  }
  if (!depths.empty()) column.foot = base::mean_median(std::move(depths));
}

/// Column numbers that belong together, ascending.
using Group = std::vector<std::size_t>;

/// Columns of cars and hedges in line with a wall that is taller than they.
void drop_clutter(const std::vector<Column>& columns, Group& used, double tidy) {
  std::vector<double> highs;
  for (const auto k : used) highs.push_back(columns[k].high);
  if (highs.empty() || base::mean_median(std::move(highs)) < tidy) return;
  std::erase_if(used, [&](std::size_t k) { return columns[k].high < tidy; });
}

auto split_at_gaps(const Group& group, const Options& o) -> std::vector<Group> {
  std::vector<Group> parts;
  for (const auto k : group) {
    if (parts.empty() || static_cast<double>(k - parts.back().back()) * o.column_width > o.column_gap + o.column_width)
      parts.emplace_back();
    parts.back().push_back(k);
  }
  return parts;
}

/// What stands a setback outward, and what inward, in groups wide enough; the rest comes first.
auto part_by_setback(const std::vector<Column>& columns, const Group& used, double middle, const Options& o)
    -> std::vector<Group> {
  std::vector<Group> groups(1);
  std::vector<char> aside(columns.size(), 0);
  for (const double side : {1.0, -1.0}) {
    Group off;
    for (const auto k : used)
      if (side * (columns[k].depth() - middle) >= o.setback) off.push_back(k);
    for (auto& part : split_at_gaps(off, o)) {
      if (part.size() < o.setback_columns) continue;
      for (const auto k : part) aside[k] = 1;
      groups.push_back(std::move(part));
    }
  }
  for (const auto k : used)
    if (aside[k] == 0) groups.front().push_back(k);
  return groups;
}

}  // namespace

auto find_bases(const std::vector<WeighedLine>& lines, const slice::SliceStack& stack, double ground, const Options& o)
    -> std::vector<Base> {
  if (lines.empty()) return {};
  const Frame frame = main_frame(lines);
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (const auto& l : lines) {
    first = std::min(first, frame.along(l.line.segment.start));
    last = std::max(last, frame.along(l.line.segment.end));
  }
  if (!(last > first)) return {};
  const auto count = static_cast<std::size_t>(std::max(1.0, std::ceil((last - first) / o.column_width)));
  auto columns = make_columns(lines, stack, frame, first, count, o);

  for (auto& column : columns) find_foot(column, stack.interval, ground + o.untidy_height, o);
  Group used;
  std::size_t covered = 0;
  for (std::size_t k = 0; k < count; ++k) {
    covered += columns[k].lines > 0 ? 1 : 0;
    if (columns[k].foot) used.push_back(k);
  }
  const bool wall = static_cast<double>(used.size()) >= o.wall_share * static_cast<double>(covered) &&
                    static_cast<double>(used.size()) * o.column_width >= o.minimum_length;
  if (!wall) {
    used.clear();
    for (std::size_t k = 0; k < count; ++k) {
      columns[k].foot.reset();
      find_gutter(columns[k], o);
      if (columns[k].foot) used.push_back(k);
    }
  } else {
    drop_clutter(columns, used, ground + o.untidy_height);
  }
  if (used.empty()) return {};

  std::vector<double> numbers, feet;
  for (const auto k : used) numbers.push_back(static_cast<double>(columns[k].lines));
  const double needed = o.column_support * base::mean_median(numbers);
  std::erase_if(used, [&](std::size_t k) { return static_cast<double>(columns[k].lines) < needed; });
  for (const auto k : used) feet.push_back(columns[k].depth());

  std::vector<Base> bases;
  for (const auto& group : part_by_setback(columns, used, base::mean_median(feet), o)) {
    for (const auto& part : split_at_gaps(group, o)) {
      const double start = first + static_cast<double>(part.front()) * o.column_width;
      const double end = std::min(last, first + static_cast<double>(part.back() + 1) * o.column_width);
      if (end - start < o.minimum_length) continue;
      std::vector<double> depths, lows, highs;
      double area = 0;
      for (const auto k : part) {
        depths.push_back(columns[k].depth());
        lows.push_back(columns[k].low);
        highs.push_back(columns[k].high);
        area += static_cast<double>(columns[k].lines) * o.column_width * stack.interval;
      }
      const double depth = base::mean_median(std::move(depths));
      bases.push_back({{frame.point(start, depth), frame.point(end, depth)},
                       area,
                       base::percentile(std::move(lows), o.height_percentile),
                       base::percentile(std::move(highs), 1 - o.height_percentile),
                       wall});
    }
  }
  return bases;
}

}  // namespace mansard::sweep::detail
