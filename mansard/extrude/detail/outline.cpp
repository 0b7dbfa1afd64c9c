// The canonical outline in exact points: its corners, and whether it is simple.
#include <cmath>

#include "mansard/extrude/detail/footprint.hpp"
#include "mansard/extrude/detail/grid.hpp"

namespace mansard::extrude::detail {

using geometry::Point2;

auto corner_of(const CanonicalEdge& before, const CanonicalEdge& after) -> ExactPoint {
  const Direction &p = before.direction, &m = after.direction;
  const Rational divisor(to_integer(cross(p, m)));
  const Rational rp = before.offset * p.l, rm = after.offset * m.l;
  return {(rp * m.a - rm * p.a) / divisor, (rp * m.b - rm * p.b) / divisor};
}

namespace {

struct Edge {
  const ExactPoint *from, *to;
  Point2 a, b;
  std::size_t ring, index, size;
};

/// Exact. Doubles are off by at most `off` / 2, so that differences are off by `off` and 1 u of their own, their
/// products by off (|u| + |v|) + off² and 3 u of theirs, and the difference of these by 1 u more: off (|u| + |v| + 2
/// off) + 4 u (|left| + |right|). The bound is three times the first; 2^-51 is 4 u, and the first has the room for the
/// rounding of the bound, since |u| and |v| are at most 2^53 off.
auto side(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, Point2 da, Point2 db, Point2 dc, double off)
    -> int {
  const Point2 u = db - da, v = dc - da;
  const double left = u.x * v.y, right = u.y * v.x, area = left - right;
  const double bound = 3 * off * (std::abs(u.x) + std::abs(u.y) + std::abs(v.x) + std::abs(v.y) + 3 * off) +
                       0x1.0p-51 * (std::abs(left) + std::abs(right));
  if (std::abs(area) > bound) return area > 0 ? 1 : -1;
  return sgn(Rational((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)));
}

auto within(const ExactPoint& a, const ExactPoint& b, const ExactPoint& p) -> bool {
  return std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
         p.y <= std::max(a.y, b.y);
}

}  // namespace

auto clash_in(const std::vector<std::vector<ExactPoint>>& corners) -> std::optional<Clash> {
  std::vector<Edge> edges;
  std::vector<geometry::Box2> boxes;
  double greatest = 0;
  std::vector<geometry::Ring> rounded;
  for (const auto& ring : corners) {
    rounded.emplace_back();
    for (const ExactPoint& p : ring) {
      rounded.back().push_back(p.approximate());
      greatest = std::max({greatest, std::abs(rounded.back().back().x), std::abs(rounded.back().back().y)});
    }
  }
  const double off = 0x1.0p-51 * greatest;  // conversion truncates: within 2^-52, half of it
  for (std::size_t r = 0; r < corners.size(); ++r) {
    const std::size_t n = corners[r].size();
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t j = i + 1 < n ? i + 1 : 0;
      edges.push_back({&corners[r][i], &corners[r][j], rounded[r][i], rounded[r][j], r, i, n});
      boxes.push_back(geometry::Box2::of(geometry::Segment2{rounded[r][i], rounded[r][j]}).grown(2 * off));
    }
    // A ring that came out the wrong way round has edges that cross, or none that are long enough to be kept.
    if ((geometry::signed_area(rounded[r]) > 0) != (r == 0)) return Clash{r, 0, r, 0};
  }
  std::optional<Clash> clash;
  for_each_overlap(boxes, [&](std::size_t i, std::size_t j) {
    const Edge &p = edges[i], &q = edges[j];
    const auto next = [](const Edge& e) { return e.index + 1 < e.size ? e.index + 1 : 0; };
    // Neighbours are not parallel, or follow each other on one line: they share one point.
    if (p.ring == q.ring && (next(p) == q.index || next(q) == p.index)) return true;
    const int p1 = side(*q.from, *q.to, *p.from, q.a, q.b, p.a, off),
              p2 = side(*q.from, *q.to, *p.to, q.a, q.b, p.b, off);
    if (p1 * p2 > 0) return true;
    const int q1 = side(*p.from, *p.to, *q.from, p.a, p.b, q.a, off),
              q2 = side(*p.from, *p.to, *q.to, p.a, p.b, q.b, off);
    if (q1 * q2 > 0) return true;
    if ((p1 * p2 < 0 && q1 * q2 < 0) || (p1 == 0 && within(*q.from, *q.to, *p.from)) ||
        (p2 == 0 && within(*q.from, *q.to, *p.to)) || (q1 == 0 && within(*p.from, *p.to, *q.from)) ||
        (q2 == 0 && within(*p.from, *p.to, *q.to))) {
      clash = {p.ring, p.index, q.ring, q.index};
      return false;
    }
    return true;
  });
  return clash;
}

}  // namespace mansard::extrude::detail
