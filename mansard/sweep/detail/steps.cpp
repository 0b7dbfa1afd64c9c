#include "mansard/sweep/detail/steps.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "mansard/base/statistics.hpp"
#include "mansard/geometry/change.hpp"
#include "mansard/geometry/edges.hpp"
#include "mansard/geometry/fit.hpp"
#include "mansard/sweep/detail/line_index.hpp"
#include "mansard/sweep/detail/steps_field.hpp"
#include "mansard/sweep/detail/units.hpp"

namespace mansard::sweep::detail {

using geometry::Point2;
using geometry::Segment2;

namespace {

struct Step {
  Segment2 segment;  // outside, the lower side, on the left
  double low = 0, high = 0, height = 0;
  [[nodiscard]] auto length() const -> double { return geometry::length(segment.end - segment.start); }
  [[nodiscard]] auto worth(const Options& o) const -> double { return length() * std::min(height, o.step_full_jump); }
};

/// Jumps of one line, one a row, ascending.
using JumpRow = std::vector<Jump>;

auto length_of(const JumpRow& s, const Options& o) -> double {
  return s.empty() ? 0 : static_cast<double>(s.back().row - s.front().row + 1) * o.step_cell;
}
auto worth_of(const JumpRow& s, const Options& o) -> double {
  double sum = 0;
  for (const Jump& j : s) sum += o.step_cell * std::min(std::abs(j.height), o.step_full_jump);
  return sum;
}
auto cover_of(const JumpRow& s, const Options& o) -> double {
  return static_cast<double>(s.size()) * o.step_cell / length_of(s, o);
}

/// The jumps of one direction, by the cell they lie in, and what has not been used of them.
class Field {
 public:
  Field(const HeightGrid& grid, std::vector<Jump> jumps, const Options& options)
      : grid_(grid), options_(options), jumps_(std::move(jumps)) {
    columns_.resize(grid.across() + 1);
    for (std::uint32_t i = 0; i < jumps_.size(); ++i) columns_[column_of(jumps_[i].across)].push_back(i);
    used_.assign(jumps_.size(), 0);
  }

  /// The best stretch along a line.
  [[nodiscard]] auto best_along(const HeightGrid::Line& line) const -> JumpRow {
    std::map<std::size_t, std::uint32_t> by_row;  // the highest jump of each
    const double sideways =
        options_.step_band + std::abs(line.tangent) * static_cast<double>(grid_.along()) * options_.step_cell;
    const auto last = std::min(columns_.size() - 1, column_of(line.across + sideways));
    for (auto c = column_of(std::max(0.0, line.across - sideways)); c <= last; ++c)
      for (const std::uint32_t i : columns_[c]) {
        const double at = line.at(static_cast<double>(jumps_[i].row));
        if (used_[i] != 0 || std::abs(jumps_[i].across - at) > options_.step_band) continue;
        const auto [place, is_new] = by_row.try_emplace(jumps_[i].row, i);
        if (!is_new && std::abs(jumps_[i].height) > std::abs(jumps_[place->second].height)) place->second = i;
      }
    JumpRow best;
    for (auto& s : joined(stretches(by_row), line.across))
      if (worth_of(s, options_) > worth_of(best, options_)) best = std::move(s);
    return best;
  }

  void use(const JumpRow& stretch) {
    for (const Jump& j : stretch) {
      const auto last = std::min(columns_.size() - 1, column_of(j.across + options_.step_band));
      for (auto c = column_of(std::max(0.0, j.across - options_.step_band)); c <= last; ++c)
        for (const std::uint32_t i : columns_[c])
          if (jumps_[i].row == j.row && std::abs(jumps_[i].across - j.across) <= options_.step_band) used_[i] = 1;
    }
  }
  [[nodiscard]] auto columns() const -> std::size_t { return columns_.size(); }
  [[nodiscard]] auto column_of(double across) const -> std::size_t {
    return static_cast<std::size_t>(across / options_.step_cell);
  }

 private:
  [[nodiscard]] auto stretches(const std::map<std::size_t, std::uint32_t>& by_row) const -> std::vector<JumpRow> {
    std::vector<JumpRow> parts;
    for (const auto& [row, i] : by_row) {
      if (parts.empty() ||
          static_cast<double>(row - parts.back().back().row - 1) * options_.step_cell > options_.step_gap)
        parts.emplace_back();
      parts.back().push_back(jumps_[i]);
    }
    return parts;
  }

  /// Stretches in one line with a roof between them, where most of the whole jumps.
  [[nodiscard]] auto joined(std::vector<JumpRow> parts, double across) const -> std::vector<JumpRow> {
    std::vector<JumpRow> whole;
    for (auto& part : parts) {
      if (!whole.empty() && is_one(whole.back(), part, across))
        whole.back().insert(whole.back().end(), part.begin(), part.end());
      else whole.push_back(std::move(part));
    }
    return whole;
  }
  [[nodiscard]] auto is_one(const JumpRow& a, const JumpRow& b, double across) const -> bool {
    const std::size_t from = a.back().row, to = b.front().row;
    if (static_cast<double>(to - from - 1) * options_.step_cell > options_.step_wide_gap) return false;
    if ((a.back().height > 0) == (b.front().height > 0)) return false;
    const auto rows = static_cast<double>(b.back().row - a.front().row + 1);
    if (static_cast<double>(a.size() + b.size()) < options_.step_cover * rows) return false;
    const std::size_t u = std::min(column_of(across), grid_.across() - 1);
    for (std::size_t t = from; t <= to; ++t)
      if (std::isnan(grid_.z(u, t))) return false;
    return true;
  }

  const HeightGrid& grid_;
  const Options& options_;
  std::vector<Jump> jumps_;
  std::vector<std::vector<std::uint32_t>> columns_;  // jumps by cell across
  std::vector<char> used_;
};

using Line = HeightGrid::Line;

/// Where the line of a stretch lies; turned off the grain only if it has to be.
auto line_of(const JumpRow& stretch, const Options& o) -> Line {
  std::vector<double> at;
  double row = 0, n = 0;
  for (const Jump& j : stretch) at.push_back(j.across), row += static_cast<double>(j.row), n += 1;
  Line line{base::median(at), 0, row / n, o.step_cell};
  double mean = 0;
  geometry::LineSums sums;  // across over along, about the pivot
  for (const double a : at) mean += a / n;
  for (const Jump& j : stretch) {
    sums.add((static_cast<double>(j.row) - line.pivot) * o.step_cell, j.across - mean);
  }
  const double tangent = sums.xx > 0 ? std::clamp(sums.xz / sums.xx, -o.step_turn, o.step_turn) : 0;
  if (std::abs(tangent) * length_of(stretch, o) > o.step_bend) line = {mean, tangent, line.pivot, o.step_cell};
  return line;
}

/// Stretches that jump one way, where those of the other way lie between.
auto one_way(const JumpRow& stretch) -> std::vector<JumpRow> {
  std::vector<JumpRow> parts;
  for (const Jump& j : stretch) {
    if (parts.empty() || (parts.back().back().height > 0) != (j.height > 0)) parts.emplace_back();
    parts.back().push_back(j);
  }
  return parts;
}

/// The step along a line, measured again on the mean surface across each part that jumps one way, where noise is small.
auto step_of(const HeightGrid& grid, const JumpRow& stretch, Line line, const Options& o) -> Step {
  Step step;
  double up = 0, beside = 0, weight = 0;
  for (const JumpRow& part : one_way(stretch)) {
    if (length_of(part, o) < o.step_part) continue;
    const auto flank = grid.flank_of(part, line);
    const auto rows = static_cast<double>(part.size());
    up += rows * flank.height;
    weight += rows * std::abs(flank.height);
    beside += rows * std::abs(flank.height) * flank.beside;
  }
  step.height = weight / static_cast<double>(stretch.size());
  if (weight > 0) line.across += beside / weight;
  const auto at = [&](double row) { return grid.point(line.at(row), (row + 0.5) * o.step_cell); };
  std::vector<double> low, high;
  for (const Jump& j : stretch) low.push_back(j.low), high.push_back(j.high);
  step.low = base::median(low), step.high = base::median(high);
  const auto first = static_cast<double>(stretch.front().row), last = static_cast<double>(stretch.back().row);
  step.segment = {at(first - 0.5), at(last + 0.5)};
  const Point2 across = grid.point(1, 0) - grid.point(0, 0);
  const Point2 lower = (up > 0 ? -1.0 : 1.0) * across;
  if (dot(geometry::left_of(step.segment.end - step.segment.start), lower) < 0)
    std::swap(step.segment.start, step.segment.end);
  return step;
}

/// Line after line, the one of most worth first.
auto steps_along(const HeightGrid& grid, const Options& o) -> std::vector<Step> {
  std::vector<Step> steps;
  Field field(grid, grid.jumps(), o);
  const auto line_at = [&](std::size_t c) { return (static_cast<double>(c) + 0.5) * o.step_cell; };
  const auto straight_at = [&](std::size_t c) { return Line{line_at(c), 0, 0, o.step_cell}; };
  std::vector<JumpRow> best(field.columns());
  std::vector<double> worths(
      best.size());  // of these; a sum over each would be made again for every line that is taken
  const auto measure = [&](std::size_t c) {
    best[c] = field.best_along(straight_at(c));
    worths[c] = worth_of(best[c], o);
  };
  base::parallel_for(best.size(), measure);
  while (!best.empty()) {
    const auto c = static_cast<std::size_t>(std::ranges::max_element(worths) - worths.begin());
    if (worths[c] <= 0) break;
    if (length_of(best[c], o) < o.step_length) {
      // The line of most worth may be a short high one; others may still be long enough.
      best[c].clear();
      worths[c] = worth_of(best[c], o);
      continue;
    }
    JumpRow stretch = best[c];
    Line line = line_of(stretch, o);
    if (JumpRow again = field.best_along(line); worth_of(again, o) >= worth_of(stretch, o)) {
      stretch = std::move(again);
      line = line_of(stretch, o);
    }
    const Step step = step_of(grid, stretch, line, o);
    if (cover_of(stretch, o) >= o.step_cover && step.height >= o.step_height) steps.push_back(step);
    field.use(best[c]);
    field.use(stretch);
    const double sideways = 2 * o.step_band + o.step_turn * step.length();
    const auto first = field.column_of(std::max(0.0, std::min(line.across, line_at(c)) - sideways));
    const auto last = std::min(best.size() - 1, field.column_of(std::max(line.across, line_at(c)) + sideways));
    for (auto k = first; k <= last; ++k) measure(k);
  }
  return steps;
}

/// Lines that steps stand beside or run up to.
class Lines {
 public:
  Lines(std::vector<Segment2> lines, const Options& options)
      : options_(options), lines_(std::move(lines)), index_(lines_, 8) {}

  /// Takes from a segment what runs along a line; the longest rest.
  [[nodiscard]] auto rest_of(const Segment2& s) const -> std::optional<Segment2> {
    const Point2 d = geometry::normalised(s.end - s.start);
    const double size = length(s.end - s.start);
    std::vector<std::pair<double, double>> taken;
    for (const auto k : index_.near(geometry::Box2::of(s).grown(options_.step_same_line))) {
      const Point2 a = lines_[k].start - s.start, b = lines_[k].end - s.start, along = b - a;
      if (std::abs(cross(d, along)) > options_.step_same_sine * length(along)) continue;
      const double from = std::max(0.0, std::min(dot(d, a), dot(d, b)));
      const double to = std::min(size, std::max(dot(d, a), dot(d, b)));
      if (!(to > from)) continue;
      const auto off = [&](double t) { return cross(d, a) + cross(d, along) * (t - dot(d, a)) / dot(d, along); };
      if (std::abs(off(0.5 * (from + to))) <= options_.step_same_line) taken.emplace_back(from, to);
    }
    std::ranges::sort(taken);
    std::pair<double, double> best{0, 0};
    double done = 0;
    const auto add = [&](double to) {
      if (to - done > best.second - best.first) best = {done, to};
    };
    for (const auto& [from, to] : taken) add(from), done = std::max(done, to);
    add(size);
    if (taken.empty()) return s;
    if (!(best.second > best.first)) return std::nullopt;
    return Segment2{s.start + best.first * d, s.start + best.second * d};
  }

  /// How far from a point in a direction the next line is met, within reach.
  [[nodiscard]] auto next(Point2 from, Point2 direction) const -> std::optional<double> {
    std::optional<double> nearest;
    const Segment2 ray{from, from + options_.step_reach * direction};
    for (const auto k : index_.near(geometry::Box2::of(ray))) {
      const Point2 along = lines_[k].end - lines_[k].start;
      const double turn = cross(direction, along);
      if (std::abs(turn) < options_.step_same_sine * length(along)) continue;
      const double at = cross(lines_[k].start - from, along) / turn;
      const double beside = cross(lines_[k].start - from, direction) / turn;
      if (at >= 0 && at <= options_.step_reach && beside >= 0 && beside <= 1 && (!nearest || at < *nearest))
        nearest = at;
    }
    return nearest;
  }

 private:
  const Options& options_;
  std::vector<Segment2> lines_;
  LineIndex index_;
};

auto outlines_of(const block::Block& block) -> std::vector<Segment2> {
  std::vector<Segment2> lines;
  for (const auto& member : block.members)
    for (const auto& polygon : member.polygons)
      geometry::each_edge(polygon, [&](Point2 from, Point2 to) { lines.push_back({from, to}); });
  return lines;
}

/// The footprints alone, where the mesh has them.
auto displaced(const block::Block& block, Point2 shift) -> block::Block {
  block::Block moved{block.name, block.members, {}, {}, block.ground};
  for (auto& member : moved.members)
    for (auto& polygon : member.polygons) geometry::move(polygon, shift);
  return moved;
}

/// The best first, each without what runs along a known line or a better step.
auto selected(std::vector<Step> steps, const std::vector<Segment2>& known, const Options& o) -> std::vector<Step> {
  std::ranges::sort(steps, [&](const Step& a, const Step& b) {
    const double wa = a.worth(o), wb = b.worth(o);
    return in_units(wa) != in_units(wb) ? wa > wb : comes_before(a.segment, b.segment);
  });
  std::vector<Step> kept;
  const Lines lines(known, o);
  for (Step& step : steps) {
    auto rest = lines.rest_of(step.segment);
    std::vector<Segment2> better;
    for (const Step& k : kept) better.push_back(k.segment);
    if (rest) rest = Lines(std::move(better), o).rest_of(*rest);
    if (!rest) continue;
    // Whole steps are long enough: `steps_along`. Their lengths are whole cells, and rounding would decide on equal
    // ones.
    const bool is_whole = rest->start == step.segment.start && rest->end == step.segment.end;
    step.segment = *rest;
    if (is_whole || step.length() >= o.step_length) kept.push_back(step);
  }
  return kept;
}

/// Near walls the surface is melted, so that a step is not seen all the way up to them.
void lengthen(std::vector<Step>& steps, std::vector<Segment2> known, const Options& o) {
  for (const Step& s : steps) known.push_back(s.segment);
  const Lines lines(std::move(known), o);
  for (Step& s : steps) {
    const Point2 d = geometry::normalised(s.segment.end - s.segment.start);
    const auto on = lines.next(s.segment.end, d), back = lines.next(s.segment.start, -1.0 * d);
    if (on) s.segment.end = s.segment.end + *on * d;
    if (back) s.segment.start = s.segment.start - *back * d;
  }
}

}  // namespace

auto roof_steps(const block::Block& surveyed, const rays::Scene& mesh, const SweepEdges& walls, const Options& options,
                const base::Run& run) -> std::vector<SweepEdge> {
  const block::Block block = displaced(surveyed, walls.registration.shift);
  std::vector<Step> steps;
  for (const Grain& grain : grains_of(block, options)) {
    if (run.cancelled()) return {};
    HeightGrid grid(block, grain, mesh, options);
    for (int turn = 0; turn < 2; ++turn, grid.transpose()) {
      const auto found = steps_along(grid, options);
      steps.insert(steps.end(), found.begin(), found.end());
    }
  }
  std::vector<Segment2> known = outlines_of(block);
  for (const SweepEdge& wall : walls.edges) known.push_back(wall.segment);
  steps = selected(std::move(steps), known, options);
  lengthen(steps, std::move(known), options);

  std::vector<SweepEdge> edges;
  for (const Step& s : steps) {
    SweepEdge edge{s.segment, s.length() * s.height, s.low, s.high, 0};
    edge.evidence = Evidence::roof_step;
    edge.step = s.height;
    edges.push_back(edge);
  }
  return edges;
}

}  // namespace mansard::sweep::detail
