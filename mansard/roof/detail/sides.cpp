#include "mansard/roof/detail/sides.hpp"
#include "mansard/geometry/angles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace mansard::roof::detail {

using geometry::Point2;

namespace {

auto turn_between(Point2 before, Point2 after) -> double {
  return geometry::arc_tangent(cross(before, after), dot(before, after));
}

void add_sides(const geometry::Ring& ring, std::size_t index, double straight, std::vector<Side>& sides) {
  const std::size_t n = ring.size();
  const auto edge = [&](std::size_t i) { return ring[(i + 1) % n] - ring[i % n]; };
  std::vector<std::size_t> corners;
  for (std::size_t i = 0; i < n; ++i)
    if (std::abs(turn_between(edge(i + n - 1), edge(i))) > straight) corners.push_back(i);
  if (corners.size() < 3) {  // many small turns: every edge for itself
    corners.clear();
    for (std::size_t i = 0; i < n; ++i) corners.push_back(i);
  }
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const std::size_t first = corners[c], last = c + 1 < corners.size() ? corners[c + 1] : corners[0] + n;
    Side side{index, first, last - first, ring[first], ring[last % n], {}, 0};
    side.length = length(side.end - side.start);
    side.inward = left_of(normalised(side.end - side.start));
    sides.push_back(side);
  }
}

/// The sides before and after each, round its own ring.
struct Neighbours {
  std::size_t before = 0, after = 0;
};
auto neighbours_of(const std::vector<Side>& sides) -> std::vector<Neighbours> {
  std::vector<Neighbours> out(sides.size());
  for (std::size_t from = 0; from < sides.size();) {
    std::size_t to = from;
    while (to < sides.size() && sides[to].ring == sides[from].ring) ++to;
    for (std::size_t i = from; i < to; ++i) out[i] = {i == from ? to - 1 : i - 1, i + 1 == to ? from : i + 1};
    from = to;
  }
  return out;
}

}  // namespace

auto ring_of(const geometry::Polygon& polygon, std::size_t ring) -> const geometry::Ring& {
  return ring == 0 ? polygon.outer : polygon.holes[ring - 1];
}

auto sides_of(const geometry::Polygon& polygon, double side_turn) -> std::vector<Side> {
  std::vector<Side> sides;
  for (std::size_t r = 0; r <= polygon.holes.size(); ++r) add_sides(ring_of(polygon, r), r, side_turn, sides);
  return sides;
}

auto extent_of(const std::vector<Side>& sides) -> Extent {
  // The smallest box has a side on one of the outline's (Freeman and Shapira, 1975).
  Extent best;
  double least = std::numeric_limits<double>::infinity();
  for (const Side& side : sides) {
    if (side.ring != 0 || side.length == 0) continue;
    const Point2 u = normalised(side.end - side.start), v = left_of(u);
    geometry::Box2 box;
    for (const Side& other : sides)
      if (other.ring == 0) box.add({dot(other.start, u), dot(other.start, v)});
    const Point2 size = box.most - box.least;
    // A box must be clearly smaller, so that rounding does not choose among equals.
    if (size.x * size.y >= least * (1 - 1e-9)) continue;
    least = size.x * size.y;
    best = size.x >= size.y ? Extent{u, size.x, size.y} : Extent{v, size.y, size.x};
  }
  return best;
}

auto nearly_rectangle(const geometry::Polygon& polygon, const Extent& extent, const Options& o) -> bool {
  return polygon.holes.empty() && geometry::area(polygon) >= o.rectangle_fill * extent.length * extent.width;
}

auto ends_by_axis(const std::vector<Side>& sides, Point2 axis) -> std::vector<bool> {
  constexpr double diagonal = 0.7071;
  std::vector<bool> ends;
  for (const Side& side : sides) ends.push_back(std::abs(dot(side.inward, axis)) > diagonal);
  return ends;
}

auto ends_of_wings(const geometry::Polygon& polygon, const std::vector<Side>& sides, const Options& o)
    -> std::vector<bool> {
  constexpr double square = 1.5708;  // rad, 90°
  const auto next_to = neighbours_of(sides);
  std::vector<std::size_t> candidates;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Side &side = sides[i], &before = sides[next_to[i].before], &after = sides[next_to[i].after];
    if (side.ring != 0) continue;
    const Point2 along = side.end - side.start;
    const auto about_square = [&](double turn) { return std::abs(turn - square) < o.wing_corner; };
    if (!about_square(turn_between(before.end - before.start, along)) ||
        !about_square(turn_between(along, after.end - after.start)))
      continue;
    if (std::min(before.length, after.length) < o.wing_depth * side.length) continue;
    const double depth = side.length / 2;
    const Point2 peak = 0.5 * (side.start + side.end) + depth * side.inward;
    if (!geometry::contains(polygon, peak) || geometry::boundary_distance(polygon, peak) < o.wing_clearance * depth)
      continue;
    candidates.push_back(i);
  }
  std::ranges::sort(candidates, [&](std::size_t a, std::size_t b) {
    const auto key = [&](std::size_t i) { return std::make_tuple(std::llround(sides[i].length * 1e3), i); };
    return key(a) < key(b);
  });
  std::vector<bool> ends(sides.size(), false);
  for (const std::size_t i : candidates)
    if (!ends[next_to[i].before] && !ends[next_to[i].after]) ends[i] = true;
  return ends;
}

}  // namespace mansard::roof::detail
