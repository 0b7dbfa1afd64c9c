#include "mansard/sweep/detail/selection.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "mansard/sweep/detail/bases.hpp"
#include "mansard/sweep/detail/line_index.hpp"
#include "mansard/sweep/detail/units.hpp"

namespace mansard::sweep::detail {

using geometry::Point2;
using geometry::Segment2;

namespace {

using Side = std::vector<WeighedLine>;

auto area_of(const Side& side, double interval) -> double {
  double sum = 0;
  for (const auto& l : side) sum += l.length * interval;
  return sum;
}

struct Weighed {
  double area = 0;   // m² that count against gamma
  bool low = false;  // most of it is in the zone of cars and hedges
};

/// Fences and parapets have next to nothing left of their length after the bus filter. Narrow gabled houses lose to it
/// too, towards the ridge, but keep half: they count in full.
auto weigh(const Side& side, double interval, const Options& o) -> Weighed {
  double all = 0, good = 0, low = 0;
  for (const auto& l : side) {
    all += l.length * interval;
    good += l.good * interval;
    if (l.low) low += l.length * interval;
  }
  return {good < o.thin_share * all ? good : all, low > o.low_share * all};
}

auto extent(const Segment2& s) -> double { return length(s.end - s.start); }

/// A coordinate moved by a micrometre moves a length by two, far less than this share of a spacing of decimetres.
constexpr double column_rounding = 1e-4;

/// m outside the footprints; 0 inside.
class Outline {
 public:
  explicit Outline(const block::Block& block) : polygons_(block.outline) {
    for (const auto& polygon : polygons_) boxes_.push_back(geometry::bounds(polygon.outer));
  }
  [[nodiscard]] auto known() const -> bool { return !polygons_.empty(); }
  [[nodiscard]] auto within(Point2 p, double margin) const -> bool {
    for (std::size_t i = 0; i < polygons_.size(); ++i)
      if (boxes_[i].grown(margin).contains(p) &&
          (geometry::contains(polygons_[i], p) || geometry::boundary_distance(polygons_[i], p) <= margin))
        return true;
    return false;
  }

 private:
  const std::vector<geometry::Polygon>& polygons_;
  std::vector<geometry::Box2> boxes_;
};

/// Edges are whole columns long, so that many are whole multiples of the spacing: rounding must not add a point.
auto samples_of(const Segment2& s, double spacing) -> std::vector<Point2> {
  const auto n = static_cast<std::size_t>(std::ceil(extent(s) / spacing - column_rounding)) + 1;
  std::vector<Point2> points;
  for (std::size_t k = 0; k <= n; ++k)
    points.push_back(s.start + (static_cast<double>(k) / static_cast<double>(n)) * (s.end - s.start));
  return points;
}

/// From the first to the last point near the footprints.
auto clipped(const Segment2& s, const Outline& outline, const Options& o) -> std::optional<Segment2> {
  if (!outline.known()) return s;
  const auto points = samples_of(s, o.outline_spacing);
  const auto near = [&](Point2 p) { return outline.within(p, o.outline_margin); };
  const auto first = std::find_if(points.begin(), points.end(), near);
  if (first == points.end()) return std::nullopt;
  const auto last = std::find_if(points.rbegin(), points.rend(), near);
  return Segment2{*first, *last};
}

auto stands_at_the_outline(const Segment2& s, const Outline& outline, const Options& o) -> bool {
  if (!outline.known()) return true;
  const auto points = samples_of(s, o.outline_spacing);
  const auto near =
      std::count_if(points.begin(), points.end(), [&](Point2 p) { return outline.within(p, o.low_margin); });
  return 2 * static_cast<std::size_t>(near) >= points.size();
}

/// Balconies, bays and bands cut one wall into several sides. The largest takes in those whose feet stand on its line.
auto put_together(std::vector<Side> sides, const slice::SliceStack& stack, double ground, const Options& o)
    -> std::vector<Side> {
  struct Candidate {
    double area;
    Segment2 base;
    Side side;
  };
  std::vector<std::optional<Candidate>> found(sides.size());
  base::parallel_for(sides.size(), [&](std::size_t i) {
    const auto bases = find_bases(sides[i], stack, ground, o);
    if (bases.empty()) return;
    const double area = area_of(sides[i], stack.interval);
    found[i] = Candidate{area, bases.front().segment, std::move(sides[i])};
  });
  std::vector<Candidate> candidates;
  for (auto& c : found)
    if (c) candidates.push_back(std::move(*c));
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return in_units(a.area) != in_units(b.area) ? a.area > b.area : comes_before(a.base, b.base);
  });

  std::vector<Segment2> bases;
  for (const auto& c : candidates) bases.push_back(c.base);
  const LineIndex index(bases, 8);
  std::vector<char> used(candidates.size(), 0);
  std::vector<Side> result;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (used[i] != 0) continue;
    used[i] = 1;
    Side side = std::move(candidates[i].side);
    const Point2 origin = bases[i].start, d = normalised(bases[i].end - origin);
    double low = 0, high = extent(bases[i]);
    for (bool grown = true; grown;) {
      grown = false;
      const Segment2 reach{origin + low * d, origin + high * d};
      for (const auto k : index.near(geometry::Box2::of(reach).grown(o.same_line_gap))) {
        if (used[k] != 0 || dot(normalised(bases[k].end - bases[k].start), d) < o.same_line_cosine) continue;
        const Point2 a = bases[k].start - origin, b = bases[k].end - origin;
        if (std::abs(cross(d, a)) > o.same_line || std::abs(cross(d, b)) > o.same_line) continue;
        const double s = dot(d, a), t = dot(d, b);
        if (s > high + o.same_line_gap || t < low - o.same_line_gap) continue;
        used[k] = 1;
        grown = true;
        low = std::min(low, s);
        high = std::max(high, t);
        side.insert(side.end(), candidates[k].side.begin(), candidates[k].side.end());
      }
    }
    std::sort(side.begin(), side.end(), [](const WeighedLine& a, const WeighedLine& b) {
      return a.line.slice != b.line.slice ? a.line.slice < b.line.slice : comes_before(a.line.segment, b.line.segment);
    });
    result.push_back(std::move(side));
  }
  return result;
}

/// Whether a side without walls goes on downwards in lines that are not its own: then it is the upper part of another
/// side's roof, and its lower end no gutter.
class RoofParts {
 public:
  RoofParts(const LineStack& lines, double interval, const Options& options)
      : lines_(lines), interval_(interval), options_(options), index_(lines.size()) {
    base::parallel_for(lines.size(), [&](std::size_t i) {
      std::vector<Segment2> segments;
      for (const auto& l : lines[i]) segments.push_back(l.line.segment);
      index_[i] = LineIndex(segments, 8);
    });
  }

  [[nodiscard]] auto goes_on_below(const Side& side) const -> bool {
    const auto bottom = side.front().line.slice;
    const auto zone =
        std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(options_.roof_look_down / interval_)));
    double seen = 0, backed = 0;
    for (const auto& l : side) {
      if (l.line.slice > bottom + zone / 2) break;
      seen += l.length;
      const auto from = bottom > zone ? bottom - zone : 0;
      for (auto i = from; i < bottom; ++i)
        if (has_like(l.line.segment, i)) {
          backed += l.length;
          break;
        }
    }
    return backed > 0.5 * seen;
  }

 private:
  [[nodiscard]] auto has_like(const Segment2& s, std::size_t slice) const -> bool {
    const Point2 d = normalised(s.end - s.start);
    for (const auto k : index_[slice].near(geometry::Box2::of(s).grown(options_.roof_look_sideways))) {
      const auto& o = lines_[slice][k].line.segment;
      if (dot(normalised(o.end - o.start), d) < options_.roof_cosine) continue;
      const double a = std::max(0.0, dot(o.start - s.start, d)), b = std::min(extent(s), dot(o.end - s.start, d));
      if (b - a >= options_.roof_share * extent(s) && lateral_step(s, o) < options_.roof_look_sideways) return true;
    }
    return false;
  }

  const LineStack& lines_;
  double interval_;
  const Options& options_;
  std::vector<LineIndex> index_;
};

/// Where two edges run along each other nearly on one line, the one of the larger side stays: two would only leave a
/// sliver between them. The larger by cluster, so that a greater gamma never brings an edge back.
void drop_twins(SweepEdges& found, const Options& o) {
  std::vector<std::size_t> order(found.edges.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t k) {
    const auto &a = found.edges[i], &b = found.edges[k];
    const double area_a = found.clusters[a.cluster].area, area_b = found.clusters[b.cluster].area;
    if (in_units(area_a) != in_units(area_b)) return area_a > area_b;
    if (in_units(a.area) != in_units(b.area)) return a.area > b.area;
    return a.segment != b.segment ? comes_before(a.segment, b.segment) : i < k;
  });
  std::vector<char> gone(found.edges.size(), 0);
  for (std::size_t n = 0; n < order.size(); ++n) {
    if (gone[order[n]] != 0) continue;
    const auto& large = found.edges[order[n]].segment;
    const Point2 d = normalised(large.end - large.start);
    for (std::size_t m = n + 1; m < order.size(); ++m) {
      const auto& small = found.edges[order[m]].segment;
      if (dot(normalised(small.end - small.start), d) < o.same_line_cosine) continue;
      const Point2 a = small.start - large.start, b = small.end - large.start;
      if (std::max(std::abs(cross(d, a)), std::abs(cross(d, b))) > o.twin_distance) continue;
      const double shared = std::min(extent(large), dot(d, b)) - std::max(0.0, dot(d, a));
      if (shared >= o.twin_share * extent(small)) gone[order[m]] = 1;
    }
  }
  std::vector<SweepEdge> kept;
  for (std::size_t i = 0; i < found.edges.size(); ++i)
    if (gone[i] == 0) kept.push_back(found.edges[i]);
  found.edges = std::move(kept);
}

/// Clusters that no edge stands for are left out.
void renumber_clusters(SweepEdges& found) {
  std::vector<std::size_t> number(found.clusters.size(), found.clusters.size());
  for (const auto& e : found.edges) number[e.cluster] = 0;
  std::vector<Cluster> kept;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] != 0) continue;
    number[i] = kept.size();
    kept.push_back(std::move(found.clusters[i]));
  }
  for (auto& e : found.edges) e.cluster = number[e.cluster];
  found.clusters = std::move(kept);
}

}  // namespace

auto select_edges(std::vector<Side> sides, const LineStack& lines, const slice::SliceStack& stack,
                  const block::Block& block, const Options& o) -> SweepEdges {
  sides = put_together(std::move(sides), stack, block.ground, o);
  const Outline outline(block);
  const RoofParts roofs(lines, stack.interval, o);

  std::vector<std::vector<Base>> kept(sides.size());
  base::parallel_for(sides.size(), [&](std::size_t i) {
    const auto evidence = weigh(sides[i], stack.interval, o);
    if (evidence.area < o.gamma) return;
    auto bases = find_bases(sides[i], stack, block.ground, o);
    for (auto& base : bases) {
      const auto clip = clipped(base.segment, outline, o);
      if (!clip || extent(*clip) < o.minimum_length) continue;
      base.segment = *clip;
      const bool clutter = evidence.low && !stands_at_the_outline(*clip, outline, o);
      if (clutter && o.low_weight * evidence.area < o.gamma) continue;
      if (base.scatter > o.maximum_scatter) continue;
      if (!base.wall && roofs.goes_on_below(sides[i])) continue;
      kept[i].push_back(base);
    }
  });

  SweepEdges result;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (kept[i].empty()) continue;
    for (const auto& base : kept[i])
      result.edges.push_back({base.segment, base.area, base.low, base.high, result.clusters.size()});
    auto& cluster = result.clusters.emplace_back();
    cluster.area = area_of(sides[i], stack.interval);
    for (const auto& l : sides[i]) cluster.lines.push_back(l.line);
  }
  drop_twins(result, o);
  renumber_clusters(result);
  sort_longest_first(result.edges);
  return result;
}

void sort_longest_first(std::vector<SweepEdge>& edges) {
  std::sort(edges.begin(), edges.end(), [](const SweepEdge& a, const SweepEdge& b) {
    const double la = extent(a.segment), lb = extent(b.segment);
    if (in_units(la) != in_units(lb)) return la > lb;
    return a.segment != b.segment ? comes_before(a.segment, b.segment) : a.cluster < b.cluster;
  });
}

}  // namespace mansard::sweep::detail
