#include "mansard/geometry/polygon.hpp"

#include <algorithm>
#include <numeric>

#include "mansard/geometry/edges.hpp"
#include "mansard/geometry/predicates.hpp"

namespace mansard::geometry {

auto signed_area(std::span<const Point2> ring) -> double {
  if (ring.size() < 3) return 0;
  double twice = 0;
  const Point2 o = ring.front();  // relative to a corner, so that far-away rings keep their digits
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) twice += cross(ring[i] - o, ring[i + 1] - o);
  return twice / 2;
}

auto area(const Polygon& polygon) -> double {
  double sum = signed_area(polygon.outer);
  for (const auto& hole : polygon.holes) sum += signed_area(hole);
  return sum;
}

auto perimeter(std::span<const Point2> ring) -> double {
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) sum += length(ring[(i + 1) % ring.size()] - ring[i]);
  return sum;
}

auto bounds(std::span<const Point2> ring) -> Box2 { return Box2::of(ring); }

auto bounds(std::span<const Polygon> polygons) -> Box2 {
  Box2 box;
  for (const auto& polygon : polygons) box.include(bounds(polygon.outer));
  return box;
}

namespace {

enum class Side { outside, boundary, inside };

auto side_of(std::span<const Point2> ring, Point2 p) -> Side {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point2 a = ring[i], b = ring[(i + 1) % ring.size()];
    if (std::max(a.y, b.y) < p.y || std::min(a.y, b.y) > p.y) continue;
    const int turn = orientation(a, b, p);
    if (turn == 0 && std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x)) return Side::boundary;
    if ((a.y > p.y) != (b.y > p.y) && (turn > 0) == (b.y > a.y)) inside = !inside;
  }
  return inside ? Side::inside : Side::outside;
}

}  // namespace

auto contains(std::span<const Point2> ring, Point2 p) -> bool { return side_of(ring, p) != Side::outside; }

auto contains(std::span<const Polygon> polygons, Point2 p) -> bool {
  return std::ranges::any_of(polygons, [p](const Polygon& polygon) { return contains(polygon, p); });
}

auto contains(const Polygon& polygon, Point2 p) -> bool {
  if (side_of(polygon.outer, p) == Side::outside) return false;
  return std::ranges::none_of(polygon.holes, [p](const Ring& hole) { return side_of(hole, p) == Side::inside; });
}

auto parameter(const Segment2& segment, Point2 p) -> double {
  const Point2 d = segment.end - segment.start;
  const double squared = dot(d, d);
  return squared > 0 ? dot(p - segment.start, d) / squared : 0;
}

auto distance(const Segment2& segment, Point2 p) -> double {
  const double t = std::clamp(parameter(segment, p), 0.0, 1.0);
  return length(p - (segment.start + t * (segment.end - segment.start)));
}

auto boundary_distance(const Polygon& polygon, Point2 p) -> double {
  double least = std::numeric_limits<double>::infinity();
  each_edge(polygon, [&](Point2 from, Point2 to) { least = std::min(least, distance({from, to}, p)); });
  return least;
}

auto is_simple(const Polygon& polygon) -> bool {
  struct Edge {
    Segment2 line;
    std::size_t ring, index, size;
  };
  std::vector<Edge> edges;
  const auto collect = [&](const Ring& ring, std::size_t id) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      edges.push_back({{ring[i], ring[(i + 1) % ring.size()]}, id, i, ring.size()});
    return ring.size() >= 3;
  };
  if (!collect(polygon.outer, 0)) return false;
  for (std::size_t h = 0; h < polygon.holes.size(); ++h)
    if (!collect(polygon.holes[h], h + 1)) return false;

  const auto low = [](const Edge& e) { return std::min(e.line.start.x, e.line.end.x); };
  const auto high = [](const Edge& e) { return std::max(e.line.start.x, e.line.end.x); };
  std::ranges::sort(edges, {}, low);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Edge& a = edges[i];
    if (a.line.start == a.line.end) return false;
    for (std::size_t j = i + 1; j < edges.size() && low(edges[j]) <= high(a); ++j) {
      const Edge& b = edges[j];
      const bool a_then_b = a.ring == b.ring && (a.index + 1) % a.size == b.index;
      const bool b_then_a = a.ring == b.ring && (b.index + 1) % b.size == a.index;
      if (a_then_b || b_then_a) {
        const Edge& first = a_then_b ? a : b;
        const Edge& second = a_then_b ? b : a;
        // Consecutive edges may only share their corner: not fold back onto each other.
        const Point2 corner = second.line.start;
        if (orientation(first.line.start, corner, second.line.end) == 0 &&
            dot(corner - first.line.start, second.line.end - corner) <= 0)
          return false;
        continue;
      }
      if (meet(a.line, b.line)) return false;
    }
  }
  return true;
}

auto oriented(Polygon polygon) -> Polygon {
  if (signed_area(polygon.outer) < 0) std::ranges::reverse(polygon.outer);
  for (auto& hole : polygon.holes)
    if (signed_area(hole) > 0) std::ranges::reverse(hole);
  return polygon;
}

auto codes() -> std::vector<base::Code> {
  return {
      {"geometry-triangulate", "A polygon could not be cut into triangles because it is not valid.",
       "Repair the footprint (self-intersections, repeated points).", 1},
      {"geometry-boolean", "A union, intersection, difference or buffer of polygons failed.",
       "Repair the footprints involved (self-intersections, coordinates that are not numbers).", 1},
  };
}

}  // namespace mansard::geometry
