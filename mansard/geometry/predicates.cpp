#include "mansard/geometry/predicates.hpp"

#include <gmpxx.h>

namespace mansard::geometry {
namespace {

/// Shewchuk's bound (Adaptive Precision Floating-Point Arithmetic, 1997, section 4.3) on the rounding error of
/// orientation's `area` relative to |left| + |right|: (3 + 16 u) u with u = 2^-53. It holds where nothing underflows.
constexpr double relative_bound = 3.3306690738754716e-16;

/// What underflow adds: sums and differences of doubles never underflow; each product, and the product of the bound
/// above, is then off by at most 2^-1075. The four together stay below 2^-1073, so any area above this number, which is
/// far greater (2^-963), is greater than all of it.
constexpr double underflow_bound = 1e-290;

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
  // Where differences or products overflow, `area` is infinite or no number and fails the comparison.
  if (std::abs(area) > relative_bound * (std::abs(left) + std::abs(right)) && std::abs(area) > underflow_bound)
    return sign(area);
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
