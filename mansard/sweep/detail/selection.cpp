#include "mansard/sweep/detail/selection.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
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

/// m² that count against gamma. Fences and parapets have next to nothing left of their length after the bus filter.
/// Narrow gabled houses lose to it too, towards the ridge, but keep half: they count in full.
auto weigh(const Side& side, double interval, const Options& o) -> double {
  double all = 0, good = 0;
  for (const auto& l : side) {
    all += l.length * interval;
    good += l.good * interval;
  }
  return good < o.thin_share * all ? good : all;
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

}  // namespace

auto select_edges(std::vector<Side> sides, const slice::SliceStack& stack, const block::Block& block, const Options& o)
    -> SweepEdges {
  sides = put_together(std::move(sides), stack, block.ground, o);
  const Outline outline(block);

  std::vector<std::vector<Base>> kept(sides.size());
  base::parallel_for(sides.size(), [&](std::size_t i) {
    if (weigh(sides[i], stack.interval, o) < o.gamma) return;
    auto bases = find_bases(sides[i], stack, block.ground, o);
    for (auto& base : bases) {
      const auto clip = clipped(base.segment, outline, o);
      if (!clip || extent(*clip) < o.minimum_length) continue;
      base.segment = *clip;
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
