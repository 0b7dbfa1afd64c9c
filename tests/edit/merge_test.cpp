#include <gmock/gmock.h>

#include "edit/plans.hpp"

namespace mansard::edit {
namespace {

using model::Plan;
using testing::HasSubstr;

auto one_of(const Plan& a, const Plan& b) -> Plan {
  auto one = merge(a, b);
  EXPECT_TRUE(one) << base::to_string(one.error());
  return one ? std::move(*one) : Plan();
}

auto refusal_of(const Plan& a, const Plan& b) -> std::string {
  const auto one = merge(a, b);
  EXPECT_FALSE(one);
  if (one) return {};
  EXPECT_EQ(one.error().code, "edit-merge");
  return one.error().message;
}

TEST(Merge, makes_one_outline_of_two_houses_and_drops_corners_that_only_the_wall_needed) {
  const auto one = one_of(test::house(0), test::house(10));
  EXPECT_EQ(one.outer.points.size(), 4U);
  EXPECT_NEAR(test::area_of(one), 160, 1e-12);
  EXPECT_EQ(*test::profile_at(one, {3, 0}), test::pitch);
  EXPECT_EQ(*test::profile_at(one, {20, 3}), test::wall);
  EXPECT_EQ(one.outer.profile_of_edge.size(), 4U);
}

TEST(Merge, keeps_a_corner_where_the_profiles_differ) {
  const auto flat = test::plan_of(test::rectangle(10, 0, 20, 8), {test::wall});
  const auto one = one_of(test::house(0), flat);
  EXPECT_EQ(one.outer.points.size(), 6U);
  EXPECT_EQ(*test::profile_at(one, {5, 0}), test::pitch);
  EXPECT_EQ(*test::profile_at(one, {15, 0}), test::wall);
}

TEST(Merge, lifts_the_profiles_of_the_higher_base_and_keeps_the_higher_cap) {
  auto upper = test::plan_of(test::rectangle(10, 0, 20, 8), {test::pitch, {{0, 0}, {2, 3}}}, 2, 9);
  const auto one = one_of(test::plan_of(test::rectangle(0, 0, 10, 8), {test::wall}, 0.5, 10), upper);
  EXPECT_EQ(one.base, 0.5);
  EXPECT_EQ(one.cap, 10.5);
  EXPECT_EQ(*test::profile_at(one, {5, 0}), test::wall);
  EXPECT_EQ(*test::profile_at(one, {15, 0}), (model::Profile{{0, 0}, {0, 6.5}, {3, 9.5}}));
  EXPECT_EQ(*test::profile_at(one, {20, 4}), (model::Profile{{0, 0}, {0, 1.5}, {2, 4.5}}));
}

TEST(Merge, takes_corners_within_a_centimetre_of_the_other_outline_to_be_on_it) {
  // The smaller one's corners stand against the middle of the long wall, a few millimetres off.
  const auto wide = test::plan_of(test::rectangle(0, 0, 10, 20), {test::wall});
  const auto beside = test::plan_of(test::rectangle(10.004, 5, 15, 9), {test::pitch});
  const auto one = one_of(wide, beside);
  EXPECT_EQ(one.outer.points.size(), 8U);
  EXPECT_NEAR(test::area_of(one), 200 + 20, 0.2);
  EXPECT_EQ(one_of(beside, wide).outer.points.size(), 8U);
  EXPECT_THAT(refusal_of(wide, test::plan_of(test::rectangle(10.03, 5, 15, 9), {test::pitch})), HasSubstr("0.000 m"));
}

TEST(Merge, closes_a_courtyard) {
  const auto left =
      test::plan_of({{{0, 0}, {5, 0}, {5, 3}, {3, 3}, {3, 7}, {5, 7}, {5, 10}, {0, 10}}, {}}, {test::wall});
  const auto right =
      test::plan_of({{{5, 0}, {10, 0}, {10, 10}, {5, 10}, {5, 7}, {7, 7}, {7, 3}, {5, 3}}, {}}, {test::wall});
  const auto one = one_of(left, right);
  EXPECT_EQ(one.outer.points.size(), 4U);
  ASSERT_EQ(one.holes.size(), 1U);
  EXPECT_EQ(one.holes[0].points.size(), 4U);
  EXPECT_LT(geometry::signed_area(one.holes[0].points), 0);
  EXPECT_NEAR(test::area_of(one), 100 - 16, 1e-12);
}

TEST(Merge, fills_a_courtyard) {
  const auto around =
      test::plan_of({test::rectangle(0, 0, 12, 12).outer, {{{4, 4}, {4, 8}, {8, 8}, {8, 4}}}}, {test::pitch});
  const auto one = one_of(around, test::plan_of(test::rectangle(4, 4, 8, 8), {test::wall}));
  EXPECT_TRUE(one.holes.empty());
  EXPECT_NEAR(test::area_of(one), 144, 1e-12);
}

TEST(Merge, refuses_parts_that_are_not_side_by_side) {
  const auto house = test::house();
  EXPECT_THAT(refusal_of(house, test::house(30)), HasSubstr("0.000 m of wall"));
  EXPECT_THAT(refusal_of(house, test::house(10, 8)), HasSubstr("0.000 m of wall"));  // corner to corner
  EXPECT_THAT(refusal_of(house, test::house(10, 7.95)), HasSubstr("0.050 m of wall"));
  EXPECT_THAT(refusal_of(house, test::house(9)), HasSubstr("overlap by"));
  EXPECT_THAT(refusal_of(house, house), HasSubstr("overlap by"));
}

TEST(Merge, refuses_an_outline_that_would_touch_itself) {
  // A wall shared in the north; in the south one corner meets the other's wall.
  const auto left = test::plan_of(test::rectangle(0, 0, 5, 10), {test::wall});
  const auto right = test::plan_of({{{5, 2}, {10, 0}, {10, 10}, {5, 10}, {5, 6}, {7, 5}}, {}}, {test::wall});
  EXPECT_THAT(refusal_of(left, right), HasSubstr("touch itself"));
}

}  // namespace
}  // namespace mansard::edit
