// The ground that is left of a footprint; a failing subtraction keeps it.
#include "mansard/pipeline/detail/uncovered.hpp"

#include <gmock/gmock.h>

#include "pipeline/houses.hpp"

namespace mansard::pipeline::detail {
namespace {

using geometry::Polygon;
using test::rectangle;

auto area_of(const std::vector<Polygon>& polygons) -> double {
  double sum = 0;
  for (const auto& polygon : polygons) sum += geometry::area(polygon);
  return sum;
}

TEST(Uncovered, is_what_neighbours_leave_without_slivers) {
  const std::vector<Polygon> footprint{rectangle(0, 0, 20, 10)};
  EXPECT_EQ(uncovered(footprint, {}).polygons, footprint);
  const auto half = uncovered(footprint, std::vector{rectangle(10, -1, 30, 11)});
  EXPECT_DOUBLE_EQ(area_of(half.polygons), 100);
  EXPECT_TRUE(half.warnings.empty());
  EXPECT_TRUE(uncovered(footprint, std::vector{rectangle(0.2, -1, 30, 11)}).polygons.empty());
}

TEST(Uncovered, keeps_a_footprint_from_which_a_neighbour_cannot_be_subtracted) {
  const std::vector<Polygon> footprint{rectangle(0, 0, 20, 10)};
  const Polygon bow_tie{{{5, -5}, {15, 5}, {15, -5}, {5, 5}}, {}};
  ASSERT_FALSE(geometry::subtract(footprint[0], bow_tie)) << "the test needs a subtraction that fails";
  const auto left = uncovered(footprint, std::vector{bow_tie, rectangle(10, -1, 30, 11)});
  EXPECT_DOUBLE_EQ(area_of(left.polygons), 100);  // the other neighbour is still subtracted
  ASSERT_EQ(left.warnings.size(), 1U);
  EXPECT_EQ(left.warnings[0].severity, base::Severity::warning);
  EXPECT_EQ(left.warnings[0].code, "pipeline-cover-unchecked");
}

TEST(Uncovered, separates_rings_that_touch_in_a_point) {
  // The neighbour's corner touches the footprint's southern side from within.
  const std::vector<Polygon> footprint{rectangle(0, 0, 20, 10)};
  const Polygon neighbour{{{10, 0}, {12, 3}, {10, 6}, {8, 3}}, {}};
  const auto rest = geometry::subtract(footprint[0], neighbour);
  ASSERT_TRUE(rest && rest->size() == 1 && !geometry::is_simple(rest->front())) << "the rings must touch";
  const auto left = uncovered(footprint, std::vector{neighbour});
  EXPECT_NEAR(area_of(left.polygons), 188, 1);
  for (const auto& polygon : left.polygons) EXPECT_TRUE(geometry::is_simple(polygon));
  EXPECT_TRUE(left.warnings.empty());
}

}  // namespace
}  // namespace mansard::pipeline::detail
