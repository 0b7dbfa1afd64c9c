#include "mansard/derive/detail/regular.hpp"
#include "mansard/geometry/angles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace mansard::derive::detail {
namespace {

using geometry::Point2;
using geometry::Polygon;
using geometry::Ring;
using std::numbers::pi;

/// A straight side: its line, and the samples of the outline that it stands for.
struct Side {
  Point2 direction;        ///< unit; the interior is on the left
  double offset = 0;       ///< m; of the line along left_of(direction)
  std::vector<Point2> on;  ///< samples
  bool free = true;        ///< in a direction of its own
};

/// The middles of the outline's steps: on average they lie on the wall that the steps follow.
auto samples_of(const Ring& ring, double cell) -> std::vector<Point2> {
  std::vector<Point2> out;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point2 a = ring[i], b = ring[(i + 1) % ring.size()];
    const auto count = static_cast<std::size_t>(std::max(1.0, std::round(geometry::length(b - a) / cell)));
    for (std::size_t k = 0; k < count; ++k)
      out.push_back(a + ((static_cast<double>(k) + 0.5) / static_cast<double>(count)) * (b - a));
  }
  return out;
}

auto farthest_from(const std::vector<Point2>& points, Point2 from) -> std::size_t {
  std::size_t best = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (geometry::length(points[i] - from) > geometry::length(points[best] - from)) best = i;
  return best;
}

/// Douglas and Peucker between two samples of a closed line; adds the samples where it bends, without the last.
void bends_between(const std::vector<Point2>& points, std::size_t first, std::size_t last, double tolerance,
                   std::vector<std::size_t>& out) {
  const geometry::Segment2 chord{points[first % points.size()], points[last % points.size()]};
  std::size_t worst = first;
  double most = tolerance;
  for (std::size_t i = first + 1; i < last; ++i)
    if (const double d = geometry::distance(chord, points[i % points.size()]); d > most) most = d, worst = i;
  if (worst == first) {
    out.push_back(first);
    return;
  }
  bends_between(points, first, worst, tolerance, out);
  bends_between(points, worst, last, tolerance, out);
}

/// Indices of the samples where the closed line bends, in order; they may go past the end.
auto bends_of(const std::vector<Point2>& points, double tolerance) -> std::vector<std::size_t> {
  const std::size_t a = farthest_from(points, points[0]), b = farthest_from(points, points[a]);
  const std::size_t first = std::min(a, b), second = std::max(a, b);
  std::vector<std::size_t> out;
  bends_between(points, first, second, tolerance, out);
  bends_between(points, second, first + points.size(), tolerance, out);
  return out;
}

auto mean_of(const std::vector<Point2>& points) -> Point2 {
  Point2 sum;
  for (const Point2 p : points) sum = sum + p;
  return (1 / static_cast<double>(points.size())) * sum;
}

/// Along the points, from the first to the last: the axis of the least squares of their distances.
auto direction_through(const std::vector<Point2>& points) -> Point2 {
  const Point2 middle = mean_of(points), chord = points.back() - points.front();
  double xx = 0, xy = 0, yy = 0;
  for (const Point2 p : points) {
    const Point2 d = p - middle;
    xx += d.x * d.x, xy += d.x * d.y, yy += d.y * d.y;
  }
  const double angle = 0.5 * geometry::arc_tangent(2 * xy, xx - yy);
  const Point2 axis{geometry::cosine(angle), geometry::sine(angle)};
  return geometry::dot(axis, chord) >= 0 ? axis : -1.0 * axis;
}

void fit_offset(Side& side) { side.offset = geometry::dot(geometry::left_of(side.direction), mean_of(side.on)); }

auto reach_of(const Side& side) -> double {
  double least = 1e300, most = -1e300;
  for (const Point2 p : side.on) {
    const double t = geometry::dot(side.direction, p);
    least = std::min(least, t), most = std::max(most, t);
  }
  return most - least;
}

/// Between the bends; corners, which openings have rounded, do not count where a side is long enough without them.
auto sides_of(const Ring& ring, const Options& how) -> std::vector<Side> {
  const auto points = samples_of(ring, how.cell);
  const auto bends = bends_of(points, how.tolerance);
  const auto corner = static_cast<std::size_t>(std::ceil(how.corner_trim * how.tolerance / how.cell));
  std::vector<Side> sides;
  for (std::size_t k = 0; k < bends.size(); ++k) {
    std::size_t from = bends[k], to = k + 1 < bends.size() ? bends[k + 1] : bends[0] + points.size();
    if (to - from > 4 * corner) from += corner, to -= corner;
    Side side;
    for (std::size_t i = from; i <= to; ++i) side.on.push_back(points[i % points.size()]);
    side.direction = direction_through(side.on);
    fit_offset(side);
    sides.push_back(std::move(side));
  }
  return sides;
}

/// 0 … π/2.
auto folded(Point2 direction) -> double {
  const double angle = std::fmod(geometry::arc_tangent(direction.y, direction.x) + 2 * pi, pi / 2);
  return angle < pi / 2 ? angle : 0;
}

/// Between two angles of that kind, −π/4 … π/4.
auto turn(double from, double to) -> double {
  double difference = to - from;
  if (difference > pi / 4) difference -= pi / 2;
  if (difference < -pi / 4) difference += pi / 2;
  return difference;
}

struct Weighted {
  double angle = 0, length = 0;
};

/// Where most of the length lies, then the mean around it: long sides know their direction best.
auto peak_of(const std::vector<Weighted>& sides, const Options& how) -> double {
  constexpr std::size_t bins = 180;  // half a degree: a tenth of direction_width
  double best = 0, most = -1;
  for (std::size_t b = 0; b < bins; ++b) {
    const double angle = static_cast<double>(b) * (pi / 2) / bins;
    double sum = 0;
    for (const auto& side : sides) {
      const double t = turn(angle, side.angle) / how.direction_width;
      sum += side.length * side.length * geometry::exponential(-0.5 * t * t);
    }
    if (sum > most) most = sum, best = angle;
  }
  for (int round = 0; round < 3; ++round) {
    double sum = 0, weight = 0;
    for (const auto& side : sides) {
      const double t = turn(best, side.angle);
      if (std::abs(t) > 2 * how.direction_width) continue;
      const double w = side.length * side.length * side.length;
      sum += w * t, weight += w;
    }
    if (weight > 0) best += sum / weight;
  }
  return std::fmod(best + pi / 2, pi / 2);
}

/// Turns the side about its middle into a direction that the building has, where that moves its ends by little.
void snap(Side& side, const std::vector<double>& directions, const Options& how) {
  const double own = folded(side.direction), half = reach_of(side) / 2;
  double least = how.snap_turn;
  std::optional<double> by;
  for (const double direction : directions) {
    const double t = turn(own, direction);
    if (std::abs(t) >= least || half * geometry::sine(std::abs(t)) > how.snap_moved * how.tolerance) continue;
    least = std::abs(t);
    by = t;
  }
  if (!by) return;
  const double angle = geometry::arc_tangent(side.direction.y, side.direction.x) + *by;
  side.direction = {geometry::cosine(angle), geometry::sine(angle)};
  side.free = false;
  fit_offset(side);
}

auto angle_between(const Side& a, const Side& b) -> double {
  return geometry::arc_tangent(geometry::cross(a.direction, b.direction), geometry::dot(a.direction, b.direction));
}

auto crossing(const Side& a, const Side& b) -> Point2 {
  const Point2 n = geometry::left_of(a.direction), m = geometry::left_of(b.direction);
  const double det = geometry::cross(n, m);
  return {(a.offset * m.y - b.offset * n.y) / det, (n.x * b.offset - m.x * a.offset) / det};
}

/// One side for two neighbours that go on in about the same direction.
auto joined(Side a, const Side& b) -> Side {
  const bool keep_first = a.free == b.free ? a.on.size() >= b.on.size() : !a.free;
  a.on.insert(a.on.end(), b.on.begin(), b.on.end());
  if (a.free && b.free) a.direction = direction_through(a.on);
  else if (!keep_first) a.direction = b.direction;
  a.free = a.free && b.free;
  fit_offset(a);
  return a;
}

auto parallel(const Side& a, const Side& b, const Options& how) -> bool {
  return std::abs(geometry::cross(a.direction, b.direction)) < geometry::sine(how.parallel_turn);
}

/// Whether the lines of two neighbours meet near where the outline goes from one to the other.
auto meet(const Side& a, const Side& b, const Options& how) -> bool {
  if (parallel(a, b, how)) return false;
  const Point2 corner = crossing(a, b), between = 0.5 * (a.on.back() + b.on.front());
  return geometry::length(corner - between) <=
         how.corner_reach * how.tolerance + geometry::length(b.on.front() - a.on.back());
}

/// Neighbours on about one line are joined.
void join_lines(std::vector<Side>& sides, const Options& how) {
  for (std::size_t k = 0; k < sides.size() && sides.size() > 3;) {
    const std::size_t next = (k + 1) % sides.size();
    const Point2 normal = geometry::left_of(sides[k].direction);
    const double off = std::abs(geometry::dot(normal, mean_of(sides[next].on)) - sides[k].offset);
    if (std::abs(angle_between(sides[k], sides[next])) < how.corner_turn && off <= how.tolerance) {
      sides[k] = joined(sides[k], sides[next]);
      sides.erase(sides.begin() + static_cast<std::ptrdiff_t>(next));
      k = 0;
    } else {
      ++k;
    }
  }
}

/// Neighbours that run the same way, or back, beside each other get a step between them.
auto with_steps(const std::vector<Side>& sides, const Options& how) -> std::vector<Side> {
  std::vector<Side> out;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    out.push_back(sides[k]);
    const Side& next = sides[(k + 1) % sides.size()];
    const double angle = std::abs(angle_between(sides[k], next));
    if ((angle >= how.corner_turn && angle <= pi - how.corner_turn) || meet(sides[k], next, how)) continue;
    const Point2 from = sides[k].on.back(), to = next.on.front(), across = geometry::left_of(sides[k].direction);
    Side step;
    step.direction = geometry::dot(across, to - from) >= 0 ? across : -1.0 * across;
    step.on = {from, to};
    step.free = false;
    fit_offset(step);
    out.push_back(std::move(step));
  }
  return out;
}

/// Cut-off corners are corners: sides in a direction of their own, near to where their neighbours meet.
void fill_corners(std::vector<Side>& sides, const Options& how) {
  for (std::size_t k = 0; k < sides.size() && sides.size() > 4;) {
    const Side &before = sides[(k + sides.size() - 1) % sides.size()], &next = sides[(k + 1) % sides.size()];
    const double angle = std::abs(angle_between(before, next));
    if (sides[k].free && angle > how.corner_turn && angle < pi - how.corner_turn) {
      const Point2 corner = crossing(before, next);
      const double away = std::abs(geometry::dot(geometry::left_of(sides[k].direction), corner) - sides[k].offset);
      if (away <= how.snap_moved * how.tolerance && reach_of(sides[k]) <= how.bevel_length * how.tolerance) {
        sides.erase(sides.begin() + static_cast<std::ptrdiff_t>(k));
        k = 0;
        continue;
      }
    }
    ++k;
  }
}

/// m; negative where the corners have passed each other.
auto length_of(const std::vector<Side>& sides, std::size_t k) -> double {
  const Side &before = sides[(k + sides.size() - 1) % sides.size()], &next = sides[(k + 1) % sides.size()];
  return geometry::dot(sides[k].direction, crossing(sides[k], next) - crossing(before, sides[k]));
}

/// Whether it went: its neighbours meet then, or become one.
auto dropped(std::vector<Side>& sides, std::size_t k, const Options& how) -> bool {
  const std::size_t before = (k + sides.size() - 1) % sides.size(), next = (k + 1) % sides.size();
  const double angle = std::abs(angle_between(sides[before], sides[next]));
  if (angle >= how.corner_turn && angle <= pi - how.corner_turn) {
    const Point2 corner = crossing(sides[before], sides[next]);
    if (geometry::length(corner - mean_of(sides[k].on)) > how.drop_reach * how.tolerance) return false;
    sides.erase(sides.begin() + static_cast<std::ptrdiff_t>(k));
    return true;
  }
  if (sides.size() < 6 || angle > pi / 2) return false;
  sides[before] = joined(sides[before], sides[next]);
  std::array<std::size_t, 2> gone{k, next};
  std::ranges::sort(gone, std::greater());
  for (const std::size_t side : gone) sides.erase(sides.begin() + static_cast<std::ptrdiff_t>(side));
  return true;
}

/// The shortest first, as long as one goes.
void drop_short(std::vector<Side>& sides, const Options& how) {
  for (bool more = true; more && sides.size() > 4;) {
    more = false;
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t k = 0; k < sides.size(); ++k)
      if (const double length = length_of(sides, k); !(length >= how.shortest)) order.emplace_back(length, k);
    std::ranges::sort(order);
    for (const auto& [length, k] : order)
      if (dropped(sides, k, how)) {
        more = true;
        break;
      }
  }
}

auto straight_ring(const Ring& ring, const std::vector<double>& directions, const Options& how) -> Ring {
  auto sides = sides_of(ring, how);
  for (auto& side : sides) snap(side, directions, how);
  join_lines(sides, how);
  fill_corners(sides, how);
  sides = with_steps(sides, how);
  if (sides.size() < 3) return {};
  drop_short(sides, how);
  Ring out;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const Side& before = sides[(k + sides.size() - 1) % sides.size()];
    if (parallel(before, sides[k], how)) return {};
    out.push_back(crossing(before, sides[k]));
  }
  return out;
}

auto simplified_ring(const Ring& ring, const Options& how) -> Ring {
  const auto points = samples_of(ring, how.cell);
  Ring out;
  for (const std::size_t bend : bends_of(points, how.cell)) out.push_back(points[bend % points.size()]);
  return out;
}

auto total_area(const std::vector<Polygon>& polygons) -> double {
  double sum = 0;
  for (const auto& polygon : polygons) sum += geometry::area(polygon);
  return sum;
}

/// Intersection over union.
auto overlap(const Polygon& a, const Polygon& b) -> base::Result<double> {
  const auto common = geometry::intersect(a, b);
  if (!common) return common.failure();
  const double both = total_area(*common);
  return both / (geometry::area(a) + geometry::area(b) - both);
}

}  // namespace

auto directions_of(const Polygon& outline, const Options& how) -> std::vector<double> {
  std::vector<Weighted> sides;
  double perimeter = 0;
  const auto take = [&](const Ring& ring) {
    for (const auto& side : sides_of(ring, how)) {
      const double length = reach_of(side);
      sides.push_back({folded(side.direction), length});
      perimeter += length;
    }
  };
  take(outline.outer);
  for (const auto& hole : outline.holes) take(hole);
  std::vector<double> out;
  while (!sides.empty() && out.size() < how.directions) {
    double left = 0;
    for (const auto& side : sides) left += side.length;
    if (!out.empty() && left < how.direction_share * perimeter) break;
    out.push_back(peak_of(sides, how));
    std::erase_if(sides,
                  [&](const Weighted& side) { return std::abs(turn(out.back(), side.angle)) < how.corner_turn; });
  }
  return out;
}

auto regularised(const Polygon& outline, const Options& how) -> base::Result<std::vector<Polygon>> {
  const auto directions = directions_of(outline, how);
  Polygon straight{straight_ring(outline.outer, directions, how), {}};
  for (const auto& hole : outline.holes)
    if (auto ring = straight_ring(hole, directions, how); ring.size() >= 3 && geometry::signed_area(ring) < 0)
      straight.holes.push_back(std::move(ring));
  if (straight.outer.size() >= 3 && geometry::signed_area(straight.outer) > 0 && geometry::is_simple(straight)) {
    const auto shared = overlap(straight, outline);
    if (!shared) return shared.failure();
    if (*shared >= how.minimum_overlap) return std::vector{straight};
  }
  Polygon simple{simplified_ring(outline.outer, how), {}};
  for (const auto& hole : outline.holes) simple.holes.push_back(simplified_ring(hole, how));
  return geometry::make_valid(simple);
}

}  // namespace mansard::derive::detail
