#include "mansard/geometry/fit.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "mansard/base/run.hpp"
#include "mansard/geometry/polygon.hpp"

namespace {

using namespace mansard::geometry;
using mansard::base::Random;

TEST(Line_sums, find_the_line_that_points_are_on) {
  LineSums sums;
  for (const double x : {-2.0, 0.5, 1.0, 7.0}) sums.add(x, 3 + 0.25 * x, 1 + x * x);
  const double slope = sums.joint() / sums.spread();
  EXPECT_NEAR(slope, 0.25, 1e-12);
  EXPECT_NEAR(sums.line(slope).at_zero, 3, 1e-12);
  EXPECT_NEAR(sums.residual(), 0, 1e-9);
}

TEST(Line_sums, of_a_difference_of_sets_are_those_of_what_is_left) {
  LineSums all, some, rest;
  Random random(1, 0);
  for (int i = 0; i < 100; ++i) {
    const double x = random.uniform(), z = random.uniform();
    all.add(x, z);
    (i < 40 ? some : rest).add(x, z);
  }
  const auto left = all - some;
  EXPECT_NEAR(left.residual(), rest.residual(), 1e-9);
  some += rest;
  EXPECT_NEAR(some.residual(), all.residual(), 1e-9);
}

TEST(Line_sums, leave_no_more_squares_than_the_best_level_line) {
  Random random(2, 0);
  LineSums sums;
  for (int i = 0; i < 50; ++i) sums.add(random.uniform(), random.uniform());
  EXPECT_LE(sums.residual(), sums.residual_level());
}

TEST(Plane_sums, find_the_plane_that_points_are_on) {
  PlaneSums sums;
  Random random(3, 0);
  for (int i = 0; i < 20; ++i) {
    const double x = 10 * random.uniform(), y = 10 * random.uniform();
    sums.add(x, y, 4 + 0.5 * x - 2 * y);
  }
  const auto plane = sums.plane(sums.centred().slopes());
  EXPECT_NEAR(plane.slope.x, 0.5, 1e-10);
  EXPECT_NEAR(plane.slope.y, -2, 1e-10);
  EXPECT_NEAR(plane.at(3, 3), -0.5, 1e-9);
}

TEST(Plane_sums, of_points_on_one_line_in_plan_have_no_determinant) {
  PlaneSums sums;
  for (const double x : {0.0, 1.0, 2.0, 4.0}) sums.add(x, 2 * x, x);
  EXPECT_NEAR(sums.centred().determinant(), 0, 1e-12);
}

TEST(Axis_sums, find_the_line_through_segments_of_any_direction) {
  Random random(4, 0);
  for (int i = 0; i < 100; ++i) {
    const double angle = 7 * random.uniform();
    const Point2 along{std::cos(angle), std::sin(angle)}, at{random.uniform(), random.uniform()};
    AxisSums sums;
    sums.add(at, at + 2.0 * along);
    sums.add(at + 3.0 * along, at + 5.0 * along);
    EXPECT_NEAR(std::abs(dot(sums.direction(), along)), 1, 1e-12);
    EXPECT_NEAR(sums.residual(), 0, 1e-12);
    EXPECT_NEAR(length(sums.centre() - (at + 2.5 * along)), 0, 1e-12);
  }
}

TEST(Box, of_points_holds_them_all_and_is_empty_without_any) {
  const std::vector<Point3> points{{1, 2, 3}, {-1, 5, 0}};
  const auto box = Box3::of(points);
  EXPECT_EQ(box.least, (Point3{-1, 2, 0}));
  EXPECT_EQ(box.most, (Point3{1, 5, 3}));
  EXPECT_EQ(Box2::of(points).most, (Point2{1, 5}));
  EXPECT_EQ(box.plan().least, (Point2{-1, 2}));
  EXPECT_TRUE(Box3::of(std::vector<Point3>{}).empty());
  EXPECT_EQ(Box2::of(Segment2{{3, 0}, {1, 4}}).least, (Point2{1, 0}));
}

TEST(Box, that_includes_an_empty_one_stays_as_it_is) {
  auto box = Box2::of(std::array{Point2{0, 0}, Point2{1, 1}});
  box.include(Box2{});
  EXPECT_EQ(box.most, (Point2{1, 1}));
  box.include(Box2::of(std::array{Point2{3, -1}}));
  EXPECT_EQ(box.least, (Point2{0, -1}));
  EXPECT_EQ(box.most, (Point2{3, 1}));
}

TEST(Box, of_polygons_holds_their_outlines) {
  const std::vector<Polygon> polygons{{{{0, 0}, {1, 0}, {1, 1}}, {}}, {{{5, 5}, {6, 5}, {6, 7}}, {}}};
  EXPECT_EQ(bounds(polygons).most, (Point2{6, 7}));
  EXPECT_EQ(bounds(polygons).least, (Point2{0, 0}));
}

}  // namespace
