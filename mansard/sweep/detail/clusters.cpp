#include "mansard/sweep/detail/clusters.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "mansard/geometry/angles.hpp"
#include "mansard/sweep/detail/line_index.hpp"
#include "mansard/sweep/detail/units.hpp"

namespace mansard::sweep::detail {

using geometry::Point2;
using geometry::Segment2;

namespace {

auto as_segments(const std::vector<WeighedLine>& lines) -> std::vector<Segment2> {
  std::vector<Segment2> segments;
  segments.reserve(lines.size());
  for (const auto& l : lines) segments.push_back(l.line.segment);
  return segments;
}

/// The origin line of a cluster and how far along it the cluster reaches.
struct Origin {
  Point2 start, direction;
  double low, high;  // m along the direction

  explicit Origin(const Segment2& s)
      : start(s.start), direction(normalised(s.end - s.start)), low(0), high(length(s.end - s.start)) {}

  /// The reference's rule: a good overlap allows for more turn than a fair one.
  [[nodiscard]] auto accepts(const Segment2& s, const Options& o) const -> bool {
    const double a = dot(s.start - start, direction), b = dot(s.end - start, direction);
    if (b <= a) return false;
    const double shared = std::min(b, high) - std::max(a, low);
    const double overlap = a <= low && b >= high ? 1.0 : std::max(0.0, shared) / (b - a);
    const Point2 d = normalised(s.end - s.start);
    const double angle = geometry::arc_tangent(std::abs(cross(direction, d)), dot(direction, d));
    return (overlap > o.cluster_overlap && angle < o.cluster_turn) ||
           (overlap > o.cluster_overlap_parallel && angle < o.cluster_turn_parallel);
  }
  void stretch(const Segment2& s) {
    low = std::min(low, dot(s.start - start, direction));
    high = std::max(high, dot(s.end - start, direction));
  }
};

/// m sideways from one line to another, at the middle of where they run side by side; infinite where they do not.
auto lateral_step(const Segment2& from, const Segment2& to) -> double {
  const Point2 d = normalised(from.end - from.start);
  const double l = length(from.end - from.start);
  const double a = dot(to.start - from.start, d), b = dot(to.end - from.start, d);
  const double s = std::max(0.0, std::min(a, b)), t = std::min(l, std::max(a, b));
  if (s > t || a == b) return std::numeric_limits<double>::infinity();
  const double k = (0.5 * (s + t) - a) / (b - a);  // the middle of the shared part, as a parameter of `to`
  return std::abs(cross(d, to.start + k * (to.end - to.start) - from.start));
}

}  // namespace

void weigh_thin(std::vector<WeighedLine>& lines, const Options& options) {
  const double thin_distance = options.thin_distance, opposite = geometry::cosine(options.thin_turn);
  if (!(thin_distance > 0)) return;
  const LineIndex index(as_segments(lines), 8);
  for (auto& l : lines) {
    const auto& s = l.line.segment;
    const Point2 d = normalised(s.end - s.start);
    double lost = 0;
    for (const auto k : index.near(geometry::Box2::of(s).grown(thin_distance))) {
      const auto& o = lines[k].line.segment;
      const Point2 e = normalised(o.end - o.start);
      if (dot(d, e) > opposite) continue;
      // Only what lies on the inner side: the far side of an alley says nothing against a wall.
      const double a = dot(o.end - s.start, d), b = dot(o.start - s.start, d);
      const double shared = std::min(b, l.length) - std::max(a, 0.0);
      const double inward = -cross(d, 0.5 * (o.start + o.end) - s.start);
      if (shared > 0 && inward > 0 && inward < thin_distance) lost += shared * (1 - inward / thin_distance);
    }
    l.good = std::max(0.0, l.length - lost);
  }
}

auto grow_clusters(const LineStack& stack, const Options& options, const base::Run& run)
    -> std::vector<std::vector<WeighedLine>> {
  struct Place {
    std::uint32_t slice, line;
  };
  std::vector<LineIndex> index(stack.size());
  base::parallel_for(stack.size(), [&](std::size_t i) { index[i] = LineIndex(as_segments(stack[i]), 8); });

  std::vector<Place> order;
  for (std::uint32_t i = 0; i < stack.size(); ++i)
    for (std::uint32_t k = 0; k < stack[i].size(); ++k) order.push_back({i, k});
  const auto at = [&](Place p) -> const WeighedLine& { return stack[p.slice][p.line]; };
  std::sort(order.begin(), order.end(), [&](Place p, Place q) {
    const auto &a = at(p), &b = at(q);
    if (in_units(a.good) != in_units(b.good)) return a.good > b.good;
    if (p.slice != q.slice) return p.slice < q.slice;
    return comes_before(a.line.segment, b.line.segment);
  });

  std::vector<std::ptrdiff_t> steps;  // up and down, the nearest first
  for (std::size_t step = 1; step <= options.cluster_reach; ++step)
    for (const int way : {1, -1}) steps.push_back(way * static_cast<std::ptrdiff_t>(step));

  std::vector<std::vector<char>> taken(stack.size());
  for (std::size_t i = 0; i < stack.size(); ++i) taken[i].assign(stack[i].size(), 0);
  std::vector<std::vector<WeighedLine>> clusters;
  for (const auto seed : order) {
    if (run.cancelled()) return {};
    if (taken[seed.slice][seed.line] != 0) continue;
    taken[seed.slice][seed.line] = 1;
    Origin origin(at(seed).line.segment);
    std::vector<Place> members{seed};
    for (std::size_t next = 0; next < members.size(); ++next) {
      const Segment2 here = at(members[next]).line.segment;
      const auto i = static_cast<std::ptrdiff_t>(members[next].slice);
      for (const std::ptrdiff_t step : steps) {
        const auto j = i + step;
        if (j < 0 || j >= static_cast<std::ptrdiff_t>(stack.size())) continue;
        const auto slice = static_cast<std::uint32_t>(j);
        for (const auto k : index[slice].near(geometry::Box2::of(here).grown(options.cluster_step))) {
          const auto& candidate = stack[slice][k].line.segment;
          if (taken[slice][k] != 0 || !origin.accepts(candidate, options)) continue;
          if (lateral_step(here, candidate) >= options.cluster_step) continue;
          taken[slice][k] = 1;
          members.push_back({slice, k});
          origin.stretch(candidate);
        }
      }
    }
    if (members.size() <
        options.cluster_lines) {  // what it took may serve a later, better neighbour; the seed is spent
      for (std::size_t m = 1; m < members.size(); ++m) taken[members[m].slice][members[m].line] = 0;
      continue;
    }
    std::sort(members.begin(), members.end(), [&](Place p, Place q) {
      return p.slice != q.slice ? p.slice < q.slice : comes_before(at(p).line.segment, at(q).line.segment);
    });
    auto& cluster = clusters.emplace_back();
    for (const auto m : members) cluster.push_back(at(m));
  }
  return clusters;
}

}  // namespace mansard::sweep::detail
