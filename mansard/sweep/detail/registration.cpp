#include "mansard/sweep/detail/registration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "mansard/base/statistics.hpp"
#include "mansard/geometry/arcs.hpp"
#include "mansard/geometry/edges.hpp"
#include "mansard/geometry/fit.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/sweep/detail/line_index.hpp"

namespace mansard::sweep::detail {

using geometry::Point2;
using geometry::Segment2;

namespace {

constexpr double fitted = 3;  // numbers: a shift and a distance outward

auto span(const Segment2& s) -> double { return length(s.end - s.start); }

/// The edges of polygons, turned so that outside is on the left, as with sweep-edges.
void add_edges(const geometry::Polygon& polygon, Point2 shift, std::vector<Segment2>& edges) {
  geometry::each_edge(polygon, [&](Point2 from, Point2 to) {
    const Segment2 s{to + shift, from + shift};
    if (span(s) > 0) edges.push_back(s);
  });
}

/// A sweep-edge beside an edge of the outline.
struct Match {
  double offset;  // m; how far outside of the outline's edge the wall was seen
  Point2 normal;  // outward
  double weight;  // m that they run beside each other
};

auto matches_of(const std::vector<SweepEdge>& edges, const block::Block& block, double within, const Options& o)
    -> std::vector<Match> {
  std::vector<Segment2> outline;
  for (const auto& polygon : block.outline) add_edges(polygon, {}, outline);
  const LineIndex index(outline, 8);
  std::vector<Match> matches;
  for (const auto& edge : edges) {
    const Segment2& s = edge.segment;
    const Point2 d = normalised(s.end - s.start);
    for (const auto k : index.near(geometry::Box2::of(s).grown(within))) {
      const Segment2& g = outline[k];
      const Point2 u = normalised(g.end - g.start);
      if (dot(u, d) < o.registration_cosine) continue;
      const double from = std::max(0.0, dot(g.start - s.start, d)), to = std::min(span(s), dot(g.end - s.start, d));
      if (to - from < o.registration_shared) continue;
      const double offset = cross(u, s.start + (0.5 * (from + to)) * d - g.start);
      if (std::abs(offset) <= within) matches.push_back({offset, geometry::left_of(u), to - from});
    }
  }
  return matches;
}

/// By weight.
auto median(std::vector<std::pair<double, double>> values) -> double {
  std::sort(values.begin(), values.end());
  using Weighed = std::pair<double, double>;
  return values.empty() ? 0 : base::weighted_percentile_of_sorted(values, 0.5, &Weighed::first, &Weighed::second);
}

/// What all distances have in common: footprints displaced by `shift`, walls seen `outward` of them.
struct Common {
  Point2 shift;
  double outward = 0;
  [[nodiscard]] auto rest(const Match& m) const -> double { return m.offset - dot(m.normal, shift) - outward; }
};

/// By how much walls stand outside of their footprints, without a displacement.
auto median_offset(const std::vector<Match>& matches) -> double {
  std::vector<std::pair<double, double>> offsets;
  for (const auto& m : matches) offsets.emplace_back(m.offset, m.weight);
  return median(std::move(offsets));
}

constexpr double of_median = 1.4826;  // standard deviation of a normal distribution by its median

/// What half of the walls are nearer than.
auto median_rest(const std::vector<Match>& matches, const Common& common) -> double {
  std::vector<std::pair<double, double>> rests;
  for (const auto& m : matches) rests.emplace_back(std::abs(common.rest(m)), m.weight);
  return median(std::move(rests));
}

/// Mean of what is left, each capped.
auto left_over(const std::vector<Match>& matches, const Common& common, const Options& o) -> double {
  double sum = 0, total = 0;
  for (const auto& m : matches) {
    sum += m.weight * std::min(std::abs(common.rest(m)), 0.5 * o.registration_distance);
    total += m.weight;
  }
  return sum / total;
}

/// Solves a symmetric system of three; none where a pivot, relative to the weight of all, is too small to trust.
auto solved(std::array<std::array<double, 4>, 3> m, double least_pivot) -> std::optional<std::array<double, 3>> {
  for (std::size_t i = 0; i < 3; ++i) {
    if (m[i][i] < least_pivot) return std::nullopt;
    for (std::size_t j = 0; j < 3; ++j) {
      if (j == i) continue;
      const double k = m[j][i] / m[i][i];
      for (std::size_t c = i; c < 4; ++c) m[j][c] -= k * m[i][c];
    }
  }
  return std::array{m[0][3] / m[0][0], m[1][3] / m[1][1], m[2][3] / m[2][2]};
}

/// The common part with the least sum of absolute rests, by reweighted least squares; none where the walls face too few
/// ways to tell a displacement from eaves.
auto common_of(const std::vector<Match>& matches, const Options& o) -> std::optional<Common> {
  Common common{{}, median_offset(matches)};
  for (std::size_t round = 0; round < o.registration_rounds; ++round) {
    std::array<std::array<double, 4>, 3> normal{};
    double total = 0;
    for (const auto& m : matches) {
      const double w = m.weight / std::max(o.registration_noise, std::abs(common.rest(m)));
      const std::array row{1.0, m.normal.x, m.normal.y, m.offset};
      total += w;
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 4; ++j) normal[i][j] += w * row[i] * row[j];
    }
    const auto answer = solved(normal, o.registration_determined * total);
    if (!answer) return std::nullopt;
    common = {{(*answer)[1], (*answer)[2]}, (*answer)[0]};
  }
  return common;
}

/// m; how far off the shift may be for the walls' scatter alone, infinite where there are too few of them.
auto standard_error(const std::vector<Match>& matches, const Common& common, const Options& o) -> double {
  double sum = 0, squared = 0;
  for (const auto& m : matches) {
    sum += m.weight;
    squared += m.weight * m.weight;
  }
  const double free = sum * sum / squared - fitted;  // as many walls of one length would say as much
  constexpr double directions = 2;                   // a wall tells nothing of the shift along it
  // A few walls may fit by chance better than the scan shows them.
  const double scatter = std::max(of_median * median_rest(matches, common), o.registration_noise);
  return free > 0 ? scatter * std::sqrt(directions / free) : std::numeric_limits<double>::infinity();
}

/// Whether a shift of at most `reach` the other way leaves hardly more over: footprints drawn between the walls of a
/// building and those of its bays fit on either side, and nothing says on which.
auto fits_the_other_way(const std::vector<Match>& matches, const Common& found, double reach, const Options& o)
    -> bool {
  constexpr double step = 0.06;  // m; half of the least shift that counts by default
  const double left = left_over(matches, found, o);
  const int steps = static_cast<int>(reach / step);
  for (int i = -steps; i <= steps; ++i)
    for (int j = -steps; j <= steps; ++j) {
      const Point2 other{i * step, j * step};
      if (dot(other, found.shift) > 0 || length(other) < o.registration_minimum_shift || length(other) > reach)
        continue;
      const auto fits = [&](double outward) {
        return (1 - o.registration_explains) * left_over(matches, {other, outward}, o) <= left;
      };
      if (fits(0) || (found.outward != 0 && fits(found.outward))) return true;
    }
  return false;
}

/// The shift of all footprints, where the walls are clear about it.
auto clear_shift(const std::vector<Match>& matches, const Options& o) -> std::optional<Point2> {
  const auto common = common_of(matches, o);
  if (!common) return std::nullopt;
  const double moved = length(common->shift);
  if (!(moved >= o.registration_minimum_shift && moved <= o.gis_offset)) return std::nullopt;
  const double error = standard_error(matches, *common, o);
  const auto is_clear = [&](const Common& with, const Common& without) {
    const double left = left_over(matches, with, o), before = left_over(matches, without, o);
    // The median: annexes and set-backs stand far from their outline wherever that lies.
    const bool stands =
        moved >= o.registration_stands_out * std::max(median_rest(matches, with), o.registration_noise / of_median);
    const bool sure = moved >= o.registration_significance * error && left <= (1 - o.registration_explains) * before;
    return left < before && (stands || sure) && !fits_the_other_way(matches, with, o.gis_offset, o);
  };
  if (is_clear({common->shift, 0}, {})) return common->shift;
  // Of footprints that are drawn too large on all sides, the displacement shows only beside that. Not where walls are
  // seen outside: eaves of one side do the same, and move nothing.
  const bool too_large = common->outward < 0 && common->outward >= -o.gis_inward;
  return too_large && is_clear(*common, {{}, std::min(0.0, median_offset(matches))}) ? std::optional(common->shift)
                                                                                     : std::nullopt;
}

/// The same of footprints farther off, which must explain most of what was seen: walls of something else are as near.
auto shift_astray(const std::vector<Match>& matches, const Options& o) -> std::optional<Point2> {
  const auto common = common_of(matches, o);
  if (!common) return std::nullopt;
  const Common shift{common->shift, 0};
  const double moved = length(shift.shift),
               most = o.gis_offset * o.registration_distance_astray / o.registration_distance;
  const bool clear =
      moved > o.gis_offset && moved <= most &&
      moved >= o.registration_stands_out * std::max(median_rest(matches, shift), o.registration_noise / of_median) &&
      moved >= o.registration_significance * standard_error(matches, *common, o) &&
      left_over(matches, shift, o) <= (1 - o.registration_explains_astray) * left_over(matches, {}, o);
  return clear && !fits_the_other_way(matches, shift, most, o) ? std::optional(shift.shift) : std::nullopt;
}

}  // namespace

auto register_footprints(const std::vector<SweepEdge>& edges, const block::Block& block, const Options& o)
    -> Registration {
  Registration registration;
  if (!(o.gis_offset > 0)) return registration;
  auto matches = matches_of(edges, block, o.registration_distance, o);
  auto shift = matches.empty() ? std::nullopt : clear_shift(matches, o);
  if (!shift) {
    auto wider = matches_of(edges, block, o.registration_distance_astray, o);
    if (!wider.empty()) shift = shift_astray(wider, o);
    if (shift) matches = std::move(wider);
  }
  if (matches.empty()) return registration;
  registration.shift = shift.value_or(Point2{});
  registration.spread = median_rest(matches, {registration.shift, 0});
  return registration;
}

namespace {

/// A stretch of a sweep-edge that follows a footprint's edge.
struct Stretch {
  double away;            // m, mean distance
  double from, to;        // m along the sweep-edge
  Segment2 on;            // of the footprint's edge
  std::size_t curve = 0;  // that the footprint's edge is a chord of, from 1
};

/// The stretch along which `s` runs up to gis_offset outside and gis_inward inside of `g`; none if there is too little.
auto follows(const Segment2& s, const Segment2& g, const Options& o) -> std::optional<Stretch> {
  const double inward = o.gis_inward, outward = o.gis_offset;
  const Point2 d = normalised(s.end - s.start), v = g.end - g.start;
  if (dot(normalised(v), d) < o.footprint_cosine) return std::nullopt;
  const double a = dot(g.start - s.start, d), b = dot(g.end - s.start, d);
  double from = std::max(0.0, a), to = std::min(span(s), b);
  // How far outside of g the wall stands, at a and b; linear between.
  const double out_a = -cross(d, g.start - s.start), out_b = -cross(d, g.end - s.start);
  const double slope = (out_b - out_a) / (b - a);
  const auto out = [&](double x) { return out_a + slope * (x - a); };
  if (std::abs(slope) > 1e-9) {
    double one = a + (-inward - out_a) / slope, two = a + (outward - out_a) / slope;
    if (one > two) std::swap(one, two);
    from = std::max(from, one), to = std::min(to, two);
  } else if (out_a < -inward || out_a > outward) {
    return std::nullopt;
  }
  if (to - from < o.footprint_piece) return std::nullopt;
  const auto at = [&](double x) { return g.start + ((x - a) / (b - a)) * v; };
  return Stretch{std::abs(out(0.5 * (from + to))), from, to, {at(from), at(to)}};
}

/// The nearest stretches first, each where no nearer one is; in order along the edge.
auto without_overlaps(std::vector<Stretch> found, const Options& o) -> std::vector<Stretch> {
  std::sort(found.begin(), found.end(),
            [](const Stretch& a, const Stretch& b) { return a.away != b.away ? a.away < b.away : a.on < b.on; });
  std::vector<Stretch> kept;
  for (const auto& stretch : found) {
    std::vector<std::pair<double, double>> open{{stretch.from, stretch.to}};
    for (const auto& k : kept) {
      std::vector<std::pair<double, double>> rest;
      for (const auto& [from, to] : open) {
        if (k.from > from) rest.emplace_back(from, std::min(to, k.from));
        if (k.to < to) rest.emplace_back(std::max(from, k.to), to);
      }
      open = std::move(rest);
    }
    const Point2 v = stretch.on.end - stretch.on.start;
    for (const auto& [from, to] : open) {
      if (to - from < o.footprint_piece) continue;
      const auto at = [&](double x) {
        return stretch.on.start + ((x - stretch.from) / (stretch.to - stretch.from)) * v;
      };
      kept.push_back({stretch.away, from, to, {at(from), at(to)}, stretch.curve});
    }
  }
  std::sort(kept.begin(), kept.end(), [](const Stretch& a, const Stretch& b) { return a.from < b.from; });
  return kept;
}

/// The line nearest to the edges of all stretches, from the foot of its first corner to that of its last. A survey is
/// off at every corner by itself: the line through two of them is off by as much as these, that through all by less.
auto line_through(const std::vector<Stretch>& stretches) -> Segment2 {
  const Point2 first = stretches.front().on.start, last = stretches.back().on.end, d = normalised(last - first);
  geometry::LineSums sums;  // of distances from the chord over distances along it
  const auto add = [&](Point2 p, double weight) { sums.add(dot(p - first, d), cross(d, p - first), weight); };
  for (const auto& s : stretches) {
    add(s.on.start, 0.5 * span(s.on));
    add(s.on.end, 0.5 * span(s.on));
  }
  const geometry::FittedLine off = sums.line(sums.joint() / sums.spread());
  const auto foot = [&](Point2 p) {
    const Point2 direction = normalised(d + off.slope * geometry::left_of(d));
    const Point2 through = first + off.at_zero * geometry::left_of(d);
    return through + dot(p - through, direction) * direction;
  };
  return {foot(first), foot(last)};
}

/// Stretches on one straight line become one: corners between houses of a row must not cut their facade. Chords of a
/// curve bend, however little from one to the next.
auto joined(const std::vector<Stretch>& stretches, const Options& o) -> std::vector<Stretch> {
  std::vector<Stretch> out;
  std::vector<Stretch> row;  // what the last one is made of
  for (const auto& next : stretches) {
    const bool bends = !out.empty() && next.curve > 0 && next.curve == row.back().curve;
    if (!out.empty() && !bends && next.from - out.back().to < o.footprint_rest) {
      auto longer = row;
      longer.push_back(next);
      const Segment2 line = line_through(longer);
      const auto near = [&](Point2 p) { return distance(line, p) <= o.footprint_straight; };
      if (std::ranges::all_of(longer, [&](const Stretch& s) { return near(s.on.start) && near(s.on.end); })) {
        out.back().on = line;
        out.back().to = next.to;
        row = std::move(longer);
        continue;
      }
    }
    out.push_back(next);
    row = {next};
  }
  return out;
}

/// The chords of a curve of a footprint, as edges_of_footprints gives them.
using Curve = std::vector<std::size_t>;
auto curves_of_footprints(const block::Block& block) -> std::vector<Curve> {
  std::vector<Curve> out;
  std::size_t edges = 0;
  const auto add = [&](const geometry::Ring& ring) {
    std::vector<std::optional<std::size_t>> number(ring.size());
    for (std::size_t i = 0; i < ring.size(); ++i)
      if (span(Segment2{ring[(i + 1) % ring.size()], ring[i]}) > 0) number[i] = edges++;
    for (const auto& arc : geometry::arcs_of(ring)) {
      auto& curve = out.emplace_back();
      for (std::size_t k = 0; k < arc.count; ++k)
        if (const auto edge = number[(arc.first + k) % ring.size()]) curve.push_back(*edge);
    }
  };
  for (const auto& member : block.members) {
    for (const auto& polygon : member.polygons) {
      add(polygon.outer);
      for (const auto& hole : polygon.holes) add(hole);
    }
  }
  return out;
}

/// A sweep-edge, or a piece of one, and the curve of a footprint that it was put on.
struct Placed {
  SweepEdge edge;
  std::size_t curve = 0;  // from 1
};

/// A curve is one side: where walls were seen along half of it, they are along all of it, chord by chord, and what else
/// was seen as near to it is of the same wall. Pieces by themselves would cut its chords beside their corners.
void complete(const Curve& curve, std::size_t number, const std::vector<Segment2>& footprints, const Options& o,
              std::vector<Placed>& placed) {
  constexpr double seen_share = 0.5;
  double length = 0, seen = 0, area = 0;
  for (const auto chord : curve) length += span(footprints[chord]);
  SweepEdge of_most;
  for (const auto& piece : placed) {
    if (piece.curve != number) continue;
    if (!(seen > 0) || piece.edge.area > of_most.area) of_most = piece.edge;
    seen += span(piece.edge.segment);
    area += piece.edge.area;
  }
  if (!(seen >= seen_share * length)) return;
  const auto is_along = [&](const Segment2& s) {
    return std::ranges::any_of(curve, [&](std::size_t chord) {
      const Segment2& c = footprints[chord];
      return dot(normalised(c.end - c.start), normalised(s.end - s.start)) >= o.footprint_cosine &&
             std::min(distance(c, s.start), distance(c, s.end)) <= o.gis_inward;
    });
  };
  std::erase_if(placed, [&](const Placed& piece) {
    return piece.curve == number || (piece.curve == 0 && is_along(piece.edge.segment));
  });
  for (const auto chord : curve) {
    SweepEdge edge = of_most;
    edge.segment = footprints[chord];
    edge.area = area * span(edge.segment) / length;
    placed.push_back({edge, number});
  }
}

}  // namespace

auto edges_of_footprints(const block::Block& block, const Registration& registration) -> std::vector<Segment2> {
  std::vector<Segment2> edges;
  for (const auto& member : block.members)
    for (const auto& polygon : member.polygons) add_edges(polygon, registration.shift, edges);
  return edges;
}

auto put_on_footprints(const std::vector<SweepEdge>& edges, const block::Block& block, const Registration& registration,
                       const Options& o) -> std::vector<SweepEdge> {
  if (!(o.gis_offset > 0)) return edges;
  const auto footprints = edges_of_footprints(block, registration);
  const auto curves = curves_of_footprints(block);
  std::vector<std::size_t> curve_of(footprints.size(), 0);
  for (std::size_t c = 0; c < curves.size(); ++c)
    for (const auto chord : curves[c]) curve_of[chord] = c + 1;
  const LineIndex index(footprints, 8);

  std::vector<Placed> placed;
  for (const auto& edge : edges) {
    const Segment2& s = edge.segment;
    const double l = span(s);
    std::vector<Stretch> found;
    for (const auto k : index.near(geometry::Box2::of(s).grown(o.gis_offset)))
      if (auto stretch = follows(s, footprints[k], o)) {
        stretch->curve = curve_of[k];
        found.push_back(*stretch);
      }
    found = joined(without_overlaps(std::move(found), o), o);
    const auto add = [&](const Segment2& at, std::size_t curve) {
      SweepEdge piece = edge;
      piece.segment = at;
      piece.area = edge.area * std::min(1.0, span(at) / l);
      placed.push_back({piece, curve});
    };
    if (found.empty()) {
      placed.push_back({edge});
      continue;
    }
    const Point2 d = normalised(s.end - s.start);
    const auto add_rest = [&](double from, double to) {
      if (to - from >= o.footprint_rest) add({s.start + from * d, s.start + to * d}, 0);
    };
    double reached = 0;
    for (const auto& stretch : found) {
      add_rest(reached, stretch.from);
      add(stretch.on, stretch.curve);
      reached = stretch.to;
    }
    add_rest(reached, l);
  }
  for (std::size_t c = 0; c < curves.size(); ++c) complete(curves[c], c + 1, footprints, o, placed);
  std::vector<SweepEdge> result;
  for (auto& piece : placed) result.push_back(std::move(piece.edge));
  return result;
}

}  // namespace mansard::sweep::detail
