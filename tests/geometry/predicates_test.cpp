#include "mansard/geometry/predicates.hpp"

#include <gtest/gtest.h>

#include "mansard/base/run.hpp"

namespace mansard::geometry {
namespace {

TEST(Orientation, tells_left_from_right_from_straight) {
  EXPECT_EQ(orientation({0, 0}, {1, 0}, {1, 1}), 1);
  EXPECT_EQ(orientation({0, 0}, {1, 0}, {1, -1}), -1);
  EXPECT_EQ(orientation({0, 0}, {1, 1}, {3, 3}), 0);
}

TEST(Orientation, is_exact_where_doubles_are_not) {
  // Points one unit in the last place off a line: the naive determinant rounds to 0 or to the wrong sign.
  const Point2 a{0.5, 0.5}, b{12, 12};
  const double up = std::nextafter(24.0, 25.0);
  EXPECT_EQ(orientation(a, b, {24, 24}), 0);
  EXPECT_EQ(orientation(a, b, {24, up}), 1);
  EXPECT_EQ(orientation(a, b, {up, 24}), -1);
  EXPECT_EQ(orientation({1e-200, 0}, {0, 1e-200}, {0, 0}), 1);  // the products underflow
}

TEST(Orientation, agrees_with_itself_under_every_permutation) {
  base::Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const Point2 a{random.uniform(), random.uniform()}, b{random.uniform(), random.uniform()};
    const double t = random.uniform(-2, 2);
    const Point2 c = a + t * (b - a);  // nearly collinear
    const int sign = orientation(a, b, c);
    EXPECT_EQ(orientation(b, c, a), sign);
    EXPECT_EQ(orientation(c, a, b), sign);
    EXPECT_EQ(orientation(b, a, c), -sign);
  }
}

TEST(Meet, holds_for_crossing_touching_and_overlapping_segments_only) {
  const Segment2 s{{0, 0}, {4, 0}};
  EXPECT_TRUE(meet(s, {{2, -1}, {2, 1}}));
  EXPECT_TRUE(meet(s, {{4, 0}, {5, 5}}));
  EXPECT_TRUE(meet(s, {{2, 0}, {2, 3}}));
  EXPECT_TRUE(meet(s, {{3, 0}, {9, 0}}));
  EXPECT_FALSE(meet(s, {{5, 0}, {9, 0}}));
  EXPECT_FALSE(meet(s, {{2, 1e-300}, {2, 3}}));
  EXPECT_FALSE(meet(s, {{0, 1}, {4, 1}}));
}

}  // namespace
}  // namespace mansard::geometry
