#include "mansard/extrude/detail/chart.hpp"

#include <algorithm>
#include <cmath>

namespace mansard::extrude::detail {
namespace {

using geometry::Point2;

// Error bounds of doubles in a chart. A point is the double nearest to the exact one: 1 u of each coordinate. Along an
// vertical face a x + b y has 1 u of the direction, 1 u of x and 1 u of the product, and 1 u of the sum: 4 u (|a x| +
// |b y|). So every coordinate is off by at most 4 u `size`, where size is |a x| + |b y| and not |a x + b y|: far from
// the origin a face can be near 0 along itself.
//
// cross_sign multiplies differences of two: off by δ = 8 u size and 1 u of their own each. With E the sum of the four
// absolute differences, their products are off by δ E + 2 δ² + 3 u (|left| + |right|), and the difference of these by 1
// u more:
//   δ E + 2 δ² + 4 u (|left| + |right|).
// The bound is eight times the first, and twice the last.
constexpr double places_error = 64 * unit_roundoff, product_error = 8 * unit_roundoff;

/// m. Coordinates are below 2²² m (`widest`), so that doubles of two points are apart by 2 · 4 u · √2 · 2²² = 6e-9 m
/// where the points are equal: what differs by more is decided.
constexpr double slack = 1e-6;

}  // namespace

auto exact_place(const Planes& planes, const TracePoint& point) -> ExactPlace {
  const Planes::Exact e = planes.exact(point.planes);
  const auto metres = [](const Rational& quanta) -> Rational { return quanta / quanta_per_metre; };
  return {metres(e.x), metres(e.y), metres(point.on_level ? Rational(mpz_class(point.level)) : e.t)};
}

auto Places::same(std::uint32_t i, std::uint32_t j) const -> bool {
  if (places_[i] != places_[j]) return false;
  const ExactPlace &p = (*this)(i), &q = (*this)(j);
  return p.x == q.x && p.y == q.y && p.z == q.z;
}

Chart::Chart(const Places& places, const FaceNode& node)
    : places_(places),
      node_(node),
      upright_(node.kind == model::FaceKind::connector || (node.kind == model::FaceKind::side && node.slope == 0)),
      looks_down_(node.kind == model::FaceKind::base || node.kind == model::FaceKind::soffit),
      along_(node.direction.approximate()) {}

auto Chart::exact(std::uint32_t i) const -> ExactPoint {
  const ExactPlace& p = places_(i);
  if (looks_down_) return {p.y, p.x};
  if (!upright_) return {p.x, p.y};
  return {Rational(node_.direction.a) * p.x + Rational(node_.direction.b) * p.y, p.z * node_.direction.l};
}

auto Chart::nearly(std::uint32_t i) const -> Near {
  const geometry::Point3 p = places_.nearest(i);
  const auto of = [](Point2 at) { return Near{at, std::max(std::abs(at.x), std::abs(at.y))}; };
  if (looks_down_) return of({p.y, p.x});
  if (!upright_) return of({p.x, p.y});
  const double ax = along_.x * p.x, by = along_.y * p.y;
  return {{ax + by, p.z}, std::max(std::abs(ax) + std::abs(by), std::abs(p.z))};
}

auto Chart::cross_sign(std::uint32_t p, std::uint32_t q, std::uint32_t o, std::uint32_t r) const -> int {
  const Near a = nearly(p), b = nearly(q), c = nearly(o), d = nearly(r);
  const double size = std::max({a.size, b.size, c.size, d.size});
  const Point2 u = b.at - a.at, v = d.at - c.at;
  const double left = u.x * v.y, right = u.y * v.x;
  const double extent = std::abs(u.x) + std::abs(u.y) + std::abs(v.x) + std::abs(v.y) + size * product_error;
  const double unsure = product_error * (std::abs(left) + std::abs(right)) + places_error * size * extent;
  if (left - right > unsure) return 1;
  if (left - right < -unsure) return -1;
  const ExactPoint P = exact(p), Q = exact(q), O = exact(o), R = exact(r);
  return sgn(Rational((Q.x - P.x) * (R.y - O.y) - (Q.y - P.y) * (R.x - O.x)));
}

auto Chart::dot_sign(std::uint32_t p, std::uint32_t q, std::uint32_t o, std::uint32_t r) const -> int {
  const ExactPoint P = exact(p), Q = exact(q), O = exact(o), R = exact(r);
  return sgn(Rational((Q.x - P.x) * (R.x - O.x) + (Q.y - P.y) * (R.y - O.y)));
}

auto Chart::orientation(const Loop& loop) const -> int {
  std::size_t least = 0;
  for (std::size_t i = 1; i < loop.size(); ++i)
    if (before(loop[i], loop[least])) least = i;
  const std::size_t n = loop.size();
  const std::uint32_t a = loop[(least + n - 1) % n], b = loop[least], c = loop[(least + 1) % n];
  return cross_sign(a, b, b, c);
}

auto Chart::side(const Loop& loop, std::uint32_t point) const -> int {
  const ExactPoint p = exact(point);
  const double y = nearly(point).at.y;
  bool inside = false;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const std::uint32_t from = loop[i], to = loop[(i + 1) % loop.size()];
    const double y_from = nearly(from).at.y, y_to = nearly(to).at.y;
    if (std::max(y_from, y_to) < y - slack || std::min(y_from, y_to) > y + slack) continue;
    const ExactPoint a = exact(from), b = exact(to);
    const int area = sgn(Rational((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)));
    if (area == 0 && std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
        p.y <= std::max(a.y, b.y))
      return 0;
    if ((a.y > p.y) != (b.y > p.y) && (area > 0) == (b.y > a.y)) inside = !inside;
  }
  return inside ? 1 : -1;
}

auto Chart::before(std::uint32_t i, std::uint32_t j) const -> bool {
  const double x = nearly(i).at.x - nearly(j).at.x;
  if (std::abs(x) > slack) return x < 0;
  const ExactPoint p = exact(i), q = exact(j);
  return p.x < q.x || (p.x == q.x && p.y < q.y);
}

}  // namespace mansard::extrude::detail
