#include "mansard/sweep/detail/alignment.hpp"

#include <cmath>

namespace mansard::sweep::detail {

using geometry::Point2;
using geometry::Segment2;

namespace {

constexpr double least_edge = 0.5;      // m; a shorter GIS edge has no direction to speak of
constexpr double square_score = 0.2;    // of a parallel edge's; the reference's weight, with its sign put right
constexpr double greatest_swing = 1.0;  // m; an end that would move farther was measured better than that

/// Consecutive edges that bend less than 0.05 rad count as one: vertices of party walls must not shorten a facade.
void collect(const geometry::Ring& ring, std::vector<Segment2>& edges) {
  const auto n = ring.size();
  if (n < 3) return;
  const auto turns = [&](std::size_t i) {
    const Point2 a = normalised(ring[i] - ring[(i + n - 1) % n]), b = normalised(ring[(i + 1) % n] - ring[i]);
    return dot(a, b) < std::cos(0.05);
  };
  std::size_t first = 0;
  while (first < n && !turns(first)) ++first;
  if (first == n) return;
  Point2 start = ring[first];
  for (std::size_t k = 1; k <= n; ++k) {
    const auto i = (first + k) % n;
    if (!turns(i)) continue;
    if (length(ring[i] - start) >= least_edge) edges.push_back({start, ring[i]});
    start = ring[i];
  }
}

}  // namespace

GisEdges::GisEdges(const block::Block& block, const Options& options)
    : angle_(options.gis_angle), distance_(options.gis_distance) {
  for (const auto& member : block.members)
    for (const auto& polygon : member.polygons) {
      collect(polygon.outer, edges_);
      for (const auto& hole : polygon.holes) collect(hole, edges_);
    }
  index_ = LineIndex(edges_, 16);
}

auto GisEdges::aligned(const Segment2& line) const -> Segment2 {
  const Point2 along = line.end - line.start;
  const double l = length(along);
  if (!(angle_ > 0) || !(distance_ > 0) || !(l > 0)) return line;
  const Point2 middle = line.start + 0.5 * along;
  geometry::Box2 box;
  box.add(middle);

  double best = 0;
  Point2 target{};
  for (const auto i : index_.near(box.grown(distance_))) {
    const double away = distance(edges_[i], middle);
    if (away >= distance_) continue;
    const Point2 direction = normalised(edges_[i].end - edges_[i].start);
    for (const bool square : {false, true}) {
      Point2 d = square ? geometry::left_of(direction) : direction;
      if (dot(d, along) < 0) d = -1.0 * d;
      const double angle = std::atan2(std::abs(cross(along, d)), dot(along, d));
      if (angle >= angle_ || 0.5 * l * std::sin(angle) > greatest_swing) continue;
      const double score = (square ? square_score : 1.0) * (1 - angle / angle_) * (1 - away / distance_);
      if (score > best) best = score, target = d;
    }
  }
  if (!(best > 0)) return line;
  return {middle - (0.5 * l) * target, middle + (0.5 * l) * target};
}

}  // namespace mansard::sweep::detail
