// Outlines that cannot be clipped or parted stay, with a warning.
#include "mansard/derive/detail/parting.hpp"

#include <gmock/gmock.h>

#include "mansard/derive/detail/regular.hpp"

namespace mansard::derive::detail {
namespace {

using geometry::Polygon;
using testing::HasSubstr;

auto box(double x0, double y0, double x1, double y1) -> Polygon {
  return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}};
}

auto area_of(const std::vector<Polygon>& polygons) -> double {
  double sum = 0;
  for (const auto& polygon : polygons) sum += geometry::area(polygon);
  return sum;
}

const Polygon bow_tie{{{5, -5}, {15, 5}, {15, -5}, {5, 5}}, {}};  // no operation takes it

TEST(Parting, takes_off_what_was_drawn_before_and_what_is_narrow_then) {
  std::vector<base::Diagnostic> warnings;
  EXPECT_DOUBLE_EQ(area_of(parted({box(0, 0, 20, 10)}, {box(10, 0, 30, 10)}, 0.8, warnings)), 100);
  EXPECT_TRUE(parted({box(0, 0, 20, 10)}, {box(0.5, -1, 30, 11)}, 0.8, warnings).empty());
  EXPECT_TRUE(warnings.empty());
}

TEST(Parting, keeps_an_outline_from_which_another_cannot_be_subtracted) {
  ASSERT_FALSE(geometry::subtract(box(0, 0, 20, 10), bow_tie)) << "the test needs a subtraction that fails";
  std::vector<base::Diagnostic> warnings;
  const auto left = parted({box(0, 0, 20, 10)}, {bow_tie, box(10, 0, 30, 10)}, 0.8, warnings);
  EXPECT_DOUBLE_EQ(area_of(left), 100);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].code, "derive-outline-kept");
  EXPECT_EQ(warnings[0].severity, base::Severity::warning);
  EXPECT_THAT(warnings[0].message, HasSubstr("near 10.0, 5.0"));
}

TEST(Clipping, keeps_an_outline_that_cannot_be_clipped) {
  std::vector<base::Diagnostic> warnings;
  EXPECT_DOUBLE_EQ(area_of(clipped(box(0, 0, 20, 10), {{5, 5}, {50, 50}}, warnings)), 75);
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(clipped(bow_tie, {{7, -10}, {50, 50}}, warnings), std::vector{bow_tie});
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings[0].message, HasSubstr("could not be clipped"));
}

TEST(Simple, separates_rings_that_touch) {
  std::vector<base::Diagnostic> warnings;
  const Polygon touching{{{0, 0}, {20, 0}, {20, 10}, {0, 10}}, {{{10, 0}, {8, 3}, {10, 6}, {12, 3}}}};
  const auto pieces = simple(touching, warnings);
  EXPECT_NEAR(area_of(pieces), 188, 1);
  for (const auto& piece : pieces) EXPECT_TRUE(geometry::is_simple(piece));
  EXPECT_TRUE(warnings.empty());
}

}  // namespace
}  // namespace mansard::derive::detail
