#include "mansard/sweep/detail/steps.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "mansard/base/sorted.hpp"
#include "mansard/sweep/detail/line_index.hpp"
#include "mansard/sweep/detail/steps_field.hpp"

namespace mansard::sweep::detail {

using geometry::Point2;
using geometry::Segment2;

namespace {

constexpr double band = 0.4;         // m; jumps this near a line are of one step
constexpr double gap = 1.25;         // m along it without a jump: noise, a chimney
constexpr double wide_gap = 4.0;     // m where two roofs cross each other: the step changes its sign there
constexpr double least_cover = 0.7;  // of a line's length that must jump
constexpr double full_jump = 1.0;    // m; higher ones say no more
constexpr double bend = 0.2;         // m across, from end to end, from which a step may be turned from the grain …
constexpr double most_turn = 0.05;   // … by this tangent
constexpr double least_part = 1.5;   // m; of a line that jumps one way, to be believed
constexpr double reach = 1.5;        // m beyond its ends to the wall or outline it runs up to
constexpr double same_line = 0.75;   // m; a wall or a footprint's edge this near is the same line
constexpr double same_sine = 0.2;    // … if it is turned by less
constexpr double least_rest = 2.0;   // m; what a wall beside it leaves of a step, if it is less, is dropped

struct Step {
  Segment2 segment;  // outside, the lower side, on the left
  double low = 0, high = 0, height = 0;
  [[nodiscard]] auto length() const -> double { return geometry::length(segment.end - segment.start); }
  [[nodiscard]] auto worth() const -> double { return length() * std::min(height, full_jump); }
};

/// Jumps of one line, one a row, ascending.
using Stretch = std::vector<Jump>;

auto length_of(const Stretch& s) -> double {
  return s.empty() ? 0 : static_cast<double>(s.back().row - s.front().row + 1) * HeightGrid::cell;
}
auto worth_of(const Stretch& s) -> double {
  double sum = 0;
  for (const Jump& j : s) sum += HeightGrid::cell * std::min(std::abs(j.height), full_jump);
  return sum;
}
auto cover_of(const Stretch& s) -> double { return static_cast<double>(s.size()) * HeightGrid::cell / length_of(s); }

/// The jumps of one direction, by the cell they lie in, and what has not been used of them.
class Field {
 public:
  Field(const HeightGrid& grid, std::vector<Jump> jumps) : grid_(grid), jumps_(std::move(jumps)) {
    columns_.resize(grid.across() + 1);
    for (std::uint32_t i = 0; i < jumps_.size(); ++i) columns_[column_of(jumps_[i].across)].push_back(i);
    used_.assign(jumps_.size(), 0);
  }

  /// The best stretch along a line.
  [[nodiscard]] auto best_along(const HeightGrid::Line& line) const -> Stretch {
    std::map<std::size_t, std::uint32_t> by_row;  // the highest jump of each
    const double sideways = band + std::abs(line.tangent) * static_cast<double>(grid_.along()) * HeightGrid::cell;
    const auto last = std::min(columns_.size() - 1, column_of(line.across + sideways));
    for (auto c = column_of(std::max(0.0, line.across - sideways)); c <= last; ++c)
      for (const std::uint32_t i : columns_[c]) {
        const double at = line.at(static_cast<double>(jumps_[i].row));
        if (used_[i] != 0 || std::abs(jumps_[i].across - at) > band) continue;
        const auto [place, is_new] = by_row.try_emplace(jumps_[i].row, i);
        if (!is_new && std::abs(jumps_[i].height) > std::abs(jumps_[place->second].height)) place->second = i;
      }
    Stretch best;
    for (auto& s : joined(stretches(by_row), line.across))
      if (worth_of(s) > worth_of(best)) best = std::move(s);
    return best;
  }

  void use(const Stretch& stretch) {
    for (const Jump& j : stretch) {
      const auto last = std::min(columns_.size() - 1, column_of(j.across + band));
      for (auto c = column_of(std::max(0.0, j.across - band)); c <= last; ++c)
        for (const std::uint32_t i : columns_[c])
          if (jumps_[i].row == j.row && std::abs(jumps_[i].across - j.across) <= band) used_[i] = 1;
    }
  }
  [[nodiscard]] auto columns() const -> std::size_t { return columns_.size(); }
  [[nodiscard]] static auto column_of(double across) -> std::size_t {
    return static_cast<std::size_t>(across / HeightGrid::cell);
  }

 private:
  [[nodiscard]] auto stretches(const std::map<std::size_t, std::uint32_t>& by_row) const -> std::vector<Stretch> {
    std::vector<Stretch> parts;
    for (const auto& [row, i] : by_row) {
      if (parts.empty() || static_cast<double>(row - parts.back().back().row - 1) * HeightGrid::cell > gap)
        parts.emplace_back();
      parts.back().push_back(jumps_[i]);
    }
    return parts;
  }

  /// Stretches in one line with a roof between them, where most of the whole jumps.
  [[nodiscard]] auto joined(std::vector<Stretch> parts, double across) const -> std::vector<Stretch> {
    std::vector<Stretch> whole;
    for (auto& part : parts) {
      if (!whole.empty() && is_one(whole.back(), part, across))
        whole.back().insert(whole.back().end(), part.begin(), part.end());
      else whole.push_back(std::move(part));
    }
    return whole;
  }
  [[nodiscard]] auto is_one(const Stretch& a, const Stretch& b, double across) const -> bool {
    const std::size_t from = a.back().row, to = b.front().row;
    if (static_cast<double>(to - from - 1) * HeightGrid::cell > wide_gap) return false;
    if ((a.back().height > 0) == (b.front().height > 0)) return false;
    const auto rows = static_cast<double>(b.back().row - a.front().row + 1);
    if (static_cast<double>(a.size() + b.size()) < least_cover * rows) return false;
    const std::size_t u = std::min(column_of(across), grid_.across() - 1);
    for (std::size_t t = from; t <= to; ++t)
      if (std::isnan(grid_.z(u, t))) return false;
    return true;
  }

  const HeightGrid& grid_;
  std::vector<Jump> jumps_;
  std::vector<std::vector<std::uint32_t>> columns_;  // jumps by cell across
  std::vector<char> used_;
};

using Line = HeightGrid::Line;

/// Where the line of a stretch lies; turned off the grain only if it has to be.
auto line_of(const Stretch& stretch) -> Line {
  std::vector<double> at;
  double row = 0, n = 0;
  for (const Jump& j : stretch) at.push_back(j.across), row += static_cast<double>(j.row), n += 1;
  Line line{base::median(at), 0, row / n};
  double mean = 0, moment = 0, spread = 0;
  for (const double a : at) mean += a / n;
  for (const Jump& j : stretch) {
    const double s = (static_cast<double>(j.row) - line.pivot) * HeightGrid::cell;
    moment += s * (j.across - mean);
    spread += s * s;
  }
  const double tangent = spread > 0 ? std::clamp(moment / spread, -most_turn, most_turn) : 0;
  if (std::abs(tangent) * length_of(stretch) > bend) line = {mean, tangent, line.pivot};
  return line;
}

/// Stretches that jump one way, where those of the other way lie between.
auto one_way(const Stretch& stretch) -> std::vector<Stretch> {
  std::vector<Stretch> parts;
  for (const Jump& j : stretch) {
    if (parts.empty() || (parts.back().back().height > 0) != (j.height > 0)) parts.emplace_back();
    parts.back().push_back(j);
  }
  return parts;
}

/// The step along a line, measured again on the mean surface across each part that jumps one way, where noise is small.
auto step_of(const HeightGrid& grid, const Stretch& stretch, Line line) -> Step {
  Step step;
  double up = 0, beside = 0, weight = 0;
  for (const Stretch& part : one_way(stretch)) {
    if (length_of(part) < least_part) continue;
    const auto flank = grid.flank_of(part, line);
    const auto rows = static_cast<double>(part.size());
    up += rows * flank.height;
    weight += rows * std::abs(flank.height);
    beside += rows * std::abs(flank.height) * flank.beside;
  }
  step.height = weight / static_cast<double>(stretch.size());
  if (weight > 0) line.across += beside / weight;
  const auto at = [&](double row) { return grid.point(line.at(row), (row + 0.5) * HeightGrid::cell); };
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
auto steps_along(const HeightGrid& grid, const Options& options) -> std::vector<Step> {
  std::vector<Step> steps;
  Field field(grid, grid.jumps());
  const auto line_at = [&](std::size_t c) { return (static_cast<double>(c) + 0.5) * HeightGrid::cell; };
  std::vector<Stretch> best(field.columns());
  base::parallel_for(best.size(), [&](std::size_t c) { best[c] = field.best_along({line_at(c)}); });
  for (;;) {
    std::size_t c = 0;
    for (std::size_t k = 1; k < best.size(); ++k)
      if (worth_of(best[k]) > worth_of(best[c])) c = k;
    if (best.empty() || length_of(best[c]) < options.step_length || worth_of(best[c]) <= 0) {
      // The line of most worth may be a short high one; others may still be long enough.
      if (best.empty() || worth_of(best[c]) <= 0) break;
      best[c].clear();
      continue;
    }
    Stretch stretch = best[c];
    Line line = line_of(stretch);
    if (Stretch again = field.best_along(line); worth_of(again) >= worth_of(stretch)) {
      stretch = std::move(again);
      line = line_of(stretch);
    }
    const Step step = step_of(grid, stretch, line);
    if (cover_of(stretch) >= least_cover && step.height >= options.step_height) steps.push_back(step);
    field.use(best[c]);
    field.use(stretch);
    const double sideways = 2 * band + most_turn * step.length();
    const auto first = Field::column_of(std::max(0.0, std::min(line.across, line_at(c)) - sideways));
    const auto last = std::min(best.size() - 1, Field::column_of(std::max(line.across, line_at(c)) + sideways));
    for (auto k = first; k <= last; ++k) best[k] = field.best_along({line_at(k)});
  }
  return steps;
}

/// Lines that steps stand beside or run up to.
class Lines {
 public:
  explicit Lines(std::vector<Segment2> lines) : lines_(std::move(lines)), index_(lines_, 8) {}

  /// Takes from a segment what runs along a line; the longest rest.
  [[nodiscard]] auto rest_of(const Segment2& s) const -> std::optional<Segment2> {
    const Point2 d = geometry::normalised(s.end - s.start);
    const double size = length(s.end - s.start);
    std::vector<std::pair<double, double>> taken;
    for (const auto k : index_.near(box_of(s).grown(same_line))) {
      const Point2 a = lines_[k].start - s.start, b = lines_[k].end - s.start, along = b - a;
      if (std::abs(cross(d, along)) > same_sine * length(along)) continue;
      const double from = std::max(0.0, std::min(dot(d, a), dot(d, b)));
      const double to = std::min(size, std::max(dot(d, a), dot(d, b)));
      if (!(to > from)) continue;
      const auto off = [&](double t) { return cross(d, a) + cross(d, along) * (t - dot(d, a)) / dot(d, along); };
      if (std::abs(off(0.5 * (from + to))) <= same_line) taken.emplace_back(from, to);
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
    if (best.second - best.first < least_rest) return std::nullopt;
    return Segment2{s.start + best.first * d, s.start + best.second * d};
  }

  /// How far from a point in a direction the next line is met, within reach.
  [[nodiscard]] auto next(Point2 from, Point2 direction) const -> std::optional<double> {
    std::optional<double> nearest;
    const Segment2 ray{from, from + reach * direction};
    for (const auto k : index_.near(box_of(ray))) {
      const Point2 along = lines_[k].end - lines_[k].start;
      const double turn = cross(direction, along);
      if (std::abs(turn) < same_sine * length(along)) continue;
      const double at = cross(lines_[k].start - from, along) / turn;
      const double beside = cross(lines_[k].start - from, direction) / turn;
      if (at >= 0 && at <= reach && beside >= 0 && beside <= 1 && (!nearest || at < *nearest)) nearest = at;
    }
    return nearest;
  }

 private:
  std::vector<Segment2> lines_;
  LineIndex index_;
};

auto outlines_of(const block::Block& block) -> std::vector<Segment2> {
  std::vector<Segment2> lines;
  const auto add = [&](const geometry::Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) lines.push_back({ring[i], ring[(i + 1) % ring.size()]});
  };
  for (const auto& member : block.members)
    for (const auto& polygon : member.polygons) {
      add(polygon.outer);
      for (const auto& hole : polygon.holes) add(hole);
    }
  return lines;
}

/// The footprints alone, where the mesh has them.
auto displaced(const block::Block& block, Point2 shift) -> block::Block {
  block::Block moved{block.name, block.members, {}, {}, block.ground};
  for (auto& member : moved.members)
    for (auto& polygon : member.polygons) {
      for (Point2& p : polygon.outer) p = p + shift;
      for (auto& hole : polygon.holes)
        for (Point2& p : hole) p = p + shift;
    }
  return moved;
}

/// The best first, each without what runs along a known line or a better step.
auto selected(std::vector<Step> steps, const std::vector<Segment2>& known, double least) -> std::vector<Step> {
  std::ranges::sort(steps, [](const Step& a, const Step& b) {
    return std::pair(-a.worth(), a.segment) < std::pair(-b.worth(), b.segment);
  });
  std::vector<Step> kept;
  const Lines lines(known);
  for (Step& step : steps) {
    auto rest = lines.rest_of(step.segment);
    std::vector<Segment2> better;
    for (const Step& k : kept) better.push_back(k.segment);
    if (rest) rest = Lines(std::move(better)).rest_of(*rest);
    if (!rest) continue;
    step.segment = *rest;
    if (step.length() >= least) kept.push_back(step);
  }
  return kept;
}

/// Near walls the surface is melted, so that a step is not seen all the way up to them.
void lengthen(std::vector<Step>& steps, std::vector<Segment2> known) {
  for (const Step& s : steps) known.push_back(s.segment);
  const Lines lines(std::move(known));
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
  for (const Grain& grain : grains_of(block)) {
    if (run.cancelled()) return {};
    HeightGrid grid(block, grain, mesh);
    for (int turn = 0; turn < 2; ++turn, grid.transpose()) {
      const auto found = steps_along(grid, options);
      steps.insert(steps.end(), found.begin(), found.end());
    }
  }
  std::vector<Segment2> known = outlines_of(block);
  for (const SweepEdge& wall : walls.edges) known.push_back(wall.segment);
  steps = selected(std::move(steps), known, options.step_length);
  lengthen(steps, std::move(known));

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
