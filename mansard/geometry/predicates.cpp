#include "mansard/geometry/predicates.hpp"

#include <gmpxx.h>

namespace mansard::geometry {
namespace {

auto sign(double value) -> int { return (value > 0) - (value < 0); }

auto within(const Segment2& s, Point2 p) -> bool {
  return std::min(s.start.x, s.end.x) <= p.x && p.x <= std::max(s.start.x, s.end.x) &&
         std::min(s.start.y, s.end.y) <= p.y && p.y <= std::max(s.start.y, s.end.y);
}

}  // namespace

auto orientation(Point2 a, Point2 b, Point2 c) -> int {
  const double left = (a.x - c.x) * (b.y - c.y);
  const double right = (a.y - c.y) * (b.x - c.x);
  const double area = left - right;
  // Shewchuk's bound for this expression: (3 + 16u)u with u = 2^-53; products that underflow fail it and go on.
  constexpr double bound = 3.3306690738754716e-16;
  if (std::abs(area) > bound * (std::abs(left) + std::abs(right)) && std::abs(area) > 1e-290) return sign(area);
  const mpq_class ax(a.x), ay(a.y), bx(b.x), by(b.y), cx(c.x), cy(c.y);
  return sgn(mpq_class((ax - cx) * (by - cy) - (ay - cy) * (bx - cx)));
}

auto meet(const Segment2& a, const Segment2& b) -> bool {
  const int a1 = orientation(b.start, b.end, a.start), a2 = orientation(b.start, b.end, a.end);
  const int b1 = orientation(a.start, a.end, b.start), b2 = orientation(a.start, a.end, b.end);
  if (a1 * a2 < 0 && b1 * b2 < 0) return true;
  return (a1 == 0 && within(b, a.start)) || (a2 == 0 && within(b, a.end)) || (b1 == 0 && within(a, b.start)) ||
         (b2 == 0 && within(a, b.end));
}

}  // namespace mansard::geometry
