#include "mansard/geometry/extent.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using mansard::geometry::extent_of;
using mansard::geometry::Point2;

TEST(Extent, is_that_of_a_turned_rectangle) {
  const double c = std::cos(0.4), s = std::sin(0.4);
  const auto at = [&](double x, double y) { return Point2{7 + c * x - s * y, -3 + s * x + c * y}; };
  const auto extent = extent_of({at(0, 0), at(5, 0), at(5, 0.5), at(0, 0.5), at(2, 0.25)});
  EXPECT_NEAR(extent.width, 0.5, 1e-12);
  EXPECT_NEAR(extent.length, 5, 1e-12);
}

TEST(Extent, of_a_triangle_has_its_least_height_as_width_wherever_it_is) {
  // The rectangles on its three sides have one area.
  const double height = 1.2;
  for (int turn = 0; turn < 60; ++turn)
    for (int first = 0; first < 3; ++first) {
      const double c = std::cos(0.1 * turn), s = std::sin(0.1 * turn);
      std::vector<Point2> corners{{0, 0}, {2, 0}, {0.9, height}};
      std::ranges::rotate(corners, corners.begin() + first);
      for (auto& p : corners) p = {c * p.x - s * p.y + 7, s * p.x + c * p.y - 3};
      EXPECT_NEAR(extent_of(corners).width, height, 1e-12) << turn;
    }
}

TEST(Extent, of_points_on_a_line_is_none) {
  EXPECT_EQ(extent_of({{0, 0}, {1, 1}, {2, 2}}).width, 0);
  EXPECT_EQ(extent_of({}).length, 0);
}

}  // namespace
