// orientation() against integers of any length: every finite double is a multiple of 2^-1074.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "mansard/base/run.hpp"
#include "mansard/geometry/predicates.hpp"

namespace mansard::geometry {
namespace {

constexpr double largest = std::numeric_limits<double>::max();
constexpr double smallest = std::numeric_limits<double>::denorm_min();

/// The double in units of 2^-1074.
auto exact(double value) -> mpz_class {
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  mpz_class whole(std::ldexp(fraction, 53));
  exponent += 1074 - 53;
  if (exponent >= 0) return whole << static_cast<unsigned long>(exponent);
  return whole >> static_cast<unsigned long>(-exponent);  // nothing is lost: denormals end in zeros
}

auto slow_orientation(Point2 a, Point2 b, Point2 c) -> int {
  const mpz_class ax = exact(a.x) - exact(c.x), ay = exact(a.y) - exact(c.y);
  const mpz_class bx = exact(b.x) - exact(c.x), by = exact(b.y) - exact(c.y);
  return sgn(mpz_class(ax * by - ay * bx));
}

/// In every order of the points, mirrored, and turned by 90°.
void expect_exact(Point2 a, Point2 b, Point2 c) {
  const std::array<Point2, 3> points{a, b, c};
  constexpr std::array<std::array<std::size_t, 3>, 6> orders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}}};
  for (const auto& [i, j, k] : orders)
    for (const bool mirrored : {false, true}) {
      const auto placed = [&](std::size_t n) { return mirrored ? Point2{points[n].y, points[n].x} : points[n]; };
      const Point2 p = placed(i), q = placed(j), r = placed(k);
      ASSERT_EQ(orientation(p, q, r), slow_orientation(p, q, r))
          << std::hexfloat << "(" << p.x << ", " << p.y << ") (" << q.x << ", " << q.y << ") (" << r.x << ", " << r.y
          << ")";
    }
}

/// The number with its last bits changed by up to three.
auto nudged(double value, base::Random& random) -> double {
  const auto steps = static_cast<int>(random.index(7)) - 3;
  for (int i = 0; i < std::abs(steps); ++i) value = std::nextafter(value, steps < 0 ? -largest : largest);
  return value;
}

/// Three points nearly on one line, with lengths of about 2^first and 2^second from the third, which is about 2^third
/// from the origin.
void check_nearly_collinear(int first, int second, int third, base::Random& random) {
  const auto length = [&](int exponent) { return std::ldexp(random.uniform(0.5, 1), exponent); };
  const auto sign = [&] { return random.index(2) == 0 ? 1.0 : -1.0; };
  const Point2 along{random.uniform(-1, 1), random.uniform(-1, 1)};
  const Point2 c{sign() * length(third), sign() * length(third)};
  const Point2 a = c + sign() * length(first) * along, b = c + sign() * length(second) * along;
  expect_exact({nudged(a.x, random), nudged(a.y, random)}, {nudged(b.x, random), nudged(b.y, random)}, c);
}

TEST(Orientation, is_exact_where_the_products_underflow_between_two_denormals) {
  // Both products are near 1.5 units of the smallest denormal, on either side of it, and round to 2 and 1 units: the
  // difference is one unit although what the subtractions lost gives it the opposite sign.
  base::Random random(7);
  const double unit = std::ldexp(1.0, -537);         // its square is the smallest denormal
  const double lost = 0.999 * std::ldexp(1.0, -53);  // by the subtraction from a number between 1 and 2
  int opposite = 0;
  for (int i = 0; i < 20'000; ++i) {
    const double bx = random.uniform(1.05, 1.45);
    const double ay = 1.5 / bx;
    if (std::fma(ay, bx, -1.5) >= 0) continue;  // rounded up
    const Point2 c{unit * lost / 2, -unit * lost};
    const Point2 a{unit, unit * ay}, b{unit * bx, unit * 1.5};
    ASSERT_EQ(orientation(a, b, c), slow_orientation(a, b, c));
    const double left = (a.x - c.x) * (b.y - c.y), right = (a.y - c.y) * (b.x - c.x);
    if ((left > right) - (left < right) == -slow_orientation(a, b, c)) ++opposite;
  }
  EXPECT_GT(opposite, 100) << "these points do not need what they are to test";
}

TEST(Orientation, is_exact_near_the_smallest_numbers) {
  base::Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const auto exponent = [&] { return -1074 + static_cast<int>(random.index(80)); };
    check_nearly_collinear(exponent(), exponent(), exponent(), random);
  }
  expect_exact({smallest, 0}, {0, smallest}, {0, 0});
  expect_exact({smallest, smallest}, {2 * smallest, 2 * smallest}, {3 * smallest, 3 * smallest});
  expect_exact({smallest, smallest}, {2 * smallest, 2 * smallest}, {3 * smallest, 4 * smallest});
  expect_exact({-smallest, smallest}, {largest, smallest}, {0, 0});
}

TEST(Orientation, is_exact_where_the_products_are_denormal) {
  base::Random random(2);
  for (int i = 0; i < 4000; ++i) {
    const auto exponent = [&] { return -545 + static_cast<int>(random.index(40)); };
    check_nearly_collinear(exponent(), exponent(), exponent() - static_cast<int>(random.index(60)), random);
  }
}

TEST(Orientation, is_exact_near_the_largest_numbers) {
  base::Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const auto exponent = [&] { return 1023 - static_cast<int>(random.index(20)); };
    check_nearly_collinear(exponent(), exponent(), exponent(), random);
  }
  // Differences overflow to infinity, and their products to no number.
  expect_exact({largest, largest}, {-largest, -largest}, {0, 0});
  expect_exact({largest, largest}, {-largest, -largest}, {0, 1});
  expect_exact({largest, largest}, {-largest, -largest}, {0, smallest});
  expect_exact({largest, -largest}, {-largest, largest}, {largest, largest});
  expect_exact({largest, 0}, {-largest, 0}, {largest, smallest});
  expect_exact({largest, 1}, {-largest, 1}, {largest, 1});
}

TEST(Orientation, is_exact_where_products_overflow) {
  base::Random random(4);
  for (int i = 0; i < 4000; ++i) {
    const auto exponent = [&] { return 500 + static_cast<int>(random.index(30)); };
    check_nearly_collinear(exponent(), exponent(), exponent(), random);
  }
}

TEST(Orientation, is_exact_for_coordinates_of_any_sizes_together) {
  base::Random random(5);
  for (int i = 0; i < 4000; ++i) {
    const auto exponent = [&] { return -1074 + static_cast<int>(random.index(2097)); };
    check_nearly_collinear(exponent(), exponent(), exponent(), random);
    const auto number = [&] { return std::ldexp(random.uniform(-1, 1), exponent()); };
    expect_exact({number(), number()}, {number(), number()}, {number(), number()});
  }
}

TEST(Orientation, is_exact_in_metres) {
  base::Random random(6);
  for (int i = 0; i < 4000; ++i) {
    const auto exponent = [&] { return -10 + static_cast<int>(random.index(34)); };
    check_nearly_collinear(exponent(), exponent(), exponent(), random);
  }
}

}  // namespace
}  // namespace mansard::geometry
