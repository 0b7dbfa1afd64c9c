#include "mansard/extrude/corner_edges.hpp"

#include <cmath>

#include "mansard/extrude/detail/corner_edges.hpp"

namespace mansard::extrude {
namespace {

using geometry::Point2;

/// The sine of half a degree, below which turns are straightened (Options::merge_angle), and the cosine of 150°: at
/// sharper corners the ends of the edge would be far from the corner.
constexpr double least_turn = 0.0087, sharpest = -0.866;
/// m; edges beside a corner edge are longer than it by as much as both of its ends are off the corner, and more.
constexpr double least_beside = 4 * longest_corner_edge;

auto wrapped(const geometry::Ring& ring, std::size_t i) -> Point2 { return ring[i % ring.size()]; }

}  // namespace

namespace detail {

auto lies_between(Point2 before, Point2 along, Point2 after) -> bool {
  return cross(before, along) > least_turn && cross(along, after) > least_turn && cross(before, after) > 0 &&
         dot(before, after) > sharpest;
}

auto ends_at(Point2 corner, Point2 before, Point2 along, Point2 after) -> std::pair<Point2, Point2> {
  constexpr double made = longest_corner_edge / 2;
  // The law of sines in the triangle of the corner and both ends.
  const double whole = cross(before, after);
  return {corner - made * cross(along, after) / whole * before, corner + made * cross(before, along) / whole * after};
}

}  // namespace detail

auto is_corner_edge(const geometry::Ring& ring, std::size_t edge) -> bool {
  const std::size_t n = ring.size();
  if (n < 4) return false;
  const Point2 own = wrapped(ring, edge + 1) - wrapped(ring, edge);
  if (std::abs(own.x) >= longest_corner_edge || std::abs(own.y) >= longest_corner_edge) return false;
  const double size = length(own);
  if (size >= longest_corner_edge || size == 0) return false;
  const Point2 before = wrapped(ring, edge) - wrapped(ring, edge + n - 1),
               after = wrapped(ring, edge + 2) - wrapped(ring, edge + 1);
  if (length(before) < least_beside || length(after) < least_beside) return false;
  return detail::lies_between(normalised(before), normalised(own), normalised(after));
}

auto corner_edges_of(const geometry::Ring& ring) -> std::vector<bool> {
  std::vector<bool> out(ring.size());
  for (std::size_t i = 0; i < ring.size(); ++i) out[i] = is_corner_edge(ring, i);
  return out;
}

auto corner_at(const geometry::Ring& ring, std::size_t corner_edge) -> Point2 {
  const Point2 start = wrapped(ring, corner_edge), end = wrapped(ring, corner_edge + 1);
  const Point2 before = normalised(start - wrapped(ring, corner_edge + ring.size() - 1)),
               after = normalised(wrapped(ring, corner_edge + 2) - end);
  return start + cross(end - start, after) / cross(before, after) * before;
}

auto without_corner_edges(model::Plan plan) -> model::Plan {
  const auto without = [](model::PlanRing& ring) {
    for (std::size_t i = ring.points.size(); i-- > 0;) {
      if (!is_corner_edge(ring.points, i)) continue;
      const auto at = static_cast<std::ptrdiff_t>(i);
      ring.points[(i + 1) % ring.points.size()] = corner_at(ring.points, i);
      ring.points.erase(ring.points.begin() + at);
      ring.profile_of_edge.erase(ring.profile_of_edge.begin() + at);
      if (!ring.overhang_of_edge.empty()) ring.overhang_of_edge.erase(ring.overhang_of_edge.begin() + at);
    }
  };
  without(plan.outer);
  for (auto& hole : plan.holes) without(hole);
  return plan;
}

auto with_corner_edge(const model::PlanRing& ring, std::size_t corner, Point2 along, std::uint32_t profile)
    -> std::optional<model::PlanRing> {
  const auto& points = ring.points;
  const std::size_t n = points.size();
  const Point2 before = points[corner] - wrapped(points, corner + n - 1),
               after = wrapped(points, corner + 1) - points[corner];
  if (n < 3 || length(before) < 2 * least_beside || length(after) < 2 * least_beside) return std::nullopt;
  if (!detail::lies_between(normalised(before), along, normalised(after))) return std::nullopt;
  model::PlanRing out = ring;
  detail::insert(out, corner, detail::ends_at(points[corner], normalised(before), along, normalised(after)), profile);
  return out;
}

}  // namespace mansard::extrude
