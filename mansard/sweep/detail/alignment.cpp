#include "mansard/sweep/detail/alignment.hpp"
#include "mansard/geometry/angles.hpp"

#include <cmath>

namespace mansard::sweep::detail {

using geometry::Point2;
using geometry::Segment2;

namespace {

/// Consecutive edges that bend less than gis_straight_turn count as one: vertices of party walls must not shorten a
/// facade.
void collect(const geometry::Ring& ring, const Options& o, std::vector<Segment2>& edges) {
  const double straight = geometry::cosine(o.gis_straight_turn);
  const auto n = ring.size();
  if (n < 3) return;
  const auto turns = [&](std::size_t i) {
    const Point2 a = normalised(ring[i] - ring[(i + n - 1) % n]), b = normalised(ring[(i + 1) % n] - ring[i]);
    return dot(a, b) < straight;
  };
  std::size_t first = 0;
  while (first < n && !turns(first)) ++first;
  if (first == n) return;
  Point2 start = ring[first];
  for (std::size_t k = 1; k <= n; ++k) {
    const auto i = (first + k) % n;
    if (!turns(i)) continue;
    if (length(ring[i] - start) >= o.gis_minimum_edge) edges.push_back({start, ring[i]});
    start = ring[i];
  }
}

}  // namespace

GisEdges::GisEdges(const block::Block& block, const Options& options) : options_(options) {
  for (const auto& member : block.members)
    for (const auto& polygon : member.polygons) {
      collect(polygon.outer, options, edges_);
      for (const auto& hole : polygon.holes) collect(hole, options, edges_);
    }
  index_ = LineIndex(edges_, 16);
}

auto GisEdges::aligned(const Segment2& line) const -> Segment2 {
  const Point2 along = line.end - line.start;
  const double l = length(along);
  const double angle_limit = options_.gis_angle, reach = options_.gis_distance;
  if (!(angle_limit > 0) || !(reach > 0) || !(l > 0)) return line;
  const Point2 middle = line.start + 0.5 * along;
  geometry::Box2 box;
  box.add(middle);

  double best = 0;
  Point2 target{};
  for (const auto i : index_.near(box.grown(reach))) {
    const double away = distance(edges_[i], middle);
    if (away >= reach) continue;
    const Point2 direction = normalised(edges_[i].end - edges_[i].start);
    for (const bool square : {false, true}) {
      Point2 d = square ? geometry::left_of(direction) : direction;
      if (dot(d, along) < 0) d = -1.0 * d;
      const double angle = geometry::arc_tangent(std::abs(cross(along, d)), dot(along, d));
      if (angle >= angle_limit || 0.5 * l * geometry::sine(angle) > options_.gis_maximum_swing) continue;
      const double score = (square ? options_.gis_square_score : 1.0) * (1 - angle / angle_limit) * (1 - away / reach);
      if (score > best) best = score, target = d;
    }
  }
  if (!(best > 0)) return line;
  return {middle - (0.5 * l) * target, middle + (0.5 * l) * target};
}

}  // namespace mansard::sweep::detail
