#include "mansard/geometry/predicates.hpp"

#include <gmpxx.h>

#include <array>

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

/// A sum or product of two doubles: its nearest double, and what rounding took off, exactly.
struct Exact {
  double near = 0, rest = 0;
};

/// D. E. Knuth's TwoSum (The Art of Computer Programming 2, 4.2.2): exact unless it overflows.
auto sum_of(double a, double b) -> Exact {
  const double near = a + b, of_b = near - a, of_a = near - of_b;
  return {near, (a - of_a) + (b - of_b)};
}

/// T. J. Dekker's product (1971), of halves of 26 bits: exact where nothing overflows and nothing underflows.
auto product_of(double a, double b) -> Exact {
  const auto high_of = [](double value) {
    constexpr double splitter = 0x1p27 + 1;
    const double scaled = splitter * value;
    return scaled - (scaled - value);
  };
  const double near = a * b, a_high = high_of(a), b_high = high_of(b), a_low = a - a_high, b_low = b - b_high;
  return {near, a_low * b_low - (((near - a_high * b_high) - a_low * b_high) - a_high * b_low)};
}

/// Coordinates of which no sum or product of two overflows, and the last bit of a product, 2^-104 of it, is a double.
auto is_moderate(Point2 p) -> bool {
  constexpr double least = 1e-100, most = 1e100;
  const auto is = [](double v) { return v == 0 || (std::abs(v) >= least && std::abs(v) <= most); };
  return is(p.x) && is(p.y);
}

/// The sign of the sum of all, which J. R. Shewchuk's Grow-Expansion (section 2.4) makes exactly: components that do
/// not overlap, in the order of their sizes, so that the last that is not 0 has the sign.
template <std::size_t N>
auto sign_of_sum(const std::array<double, N>& terms) -> int {
  std::array<double, N> components{};
  std::size_t count = 0;
  for (double term : terms) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto [near, rest] = sum_of(term, components[i]);
      term = near;
      components[i] = rest;
    }
    components[count++] = term;
  }
  for (std::size_t i = N; i-- > 0;)
    if (components[i] != 0) return sign(components[i]);
  return 0;
}

/// Of moderate coordinates.
auto moderate_orientation(Point2 a, Point2 b, Point2 c) -> int {
  const auto ax = sum_of(a.x, -c.x), ay = sum_of(a.y, -c.y), bx = sum_of(b.x, -c.x), by = sum_of(b.y, -c.y);
  if (ax.rest == 0 && ay.rest == 0 && bx.rest == 0 && by.rest == 0) {
    // The nearest doubles are in the order of the products, or the same.
    const auto left = product_of(ax.near, by.near), right = product_of(ay.near, bx.near);
    return left.near != right.near ? sign(left.near - right.near) : sign(left.rest - right.rest);
  }
  const auto ab = product_of(a.x, b.y), ac = product_of(a.x, -c.y), cb = product_of(-c.x, b.y);
  const auto ba = product_of(-a.y, b.x), ca = product_of(a.y, c.x), bc = product_of(c.y, b.x);
  return sign_of_sum(std::array{ab.rest, ac.rest, cb.rest, ba.rest, ca.rest, bc.rest, ab.near, ac.near, cb.near,
                                ba.near, ca.near, bc.near});
}

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
  if (is_moderate(a) && is_moderate(b) && is_moderate(c)) return moderate_orientation(a, b, c);
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
