// A level strip along one side of a part: a step in the profile, not a slope.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mansard/refine/detail/forms.hpp"
#include "scans.hpp"

namespace {

namespace geometry = mansard::geometry;
namespace model = mansard::model;

using namespace scans;
namespace detail = refine::detail;

auto house() -> geometry::Ring { return rectangle(10, 20, 12, 9); }
auto setback_of(double depth, double low, double high) -> Profile {
  return {{0, 0}, {0, low}, {depth, low}, {depth, high}};
}
/// A flat roof at 9 m; along the first side a strip at 6.5 m.
auto with_strip(double depth) -> Plan {
  return plan(house(), {setback_of(depth, 6.5, 9), wall(9), wall(9), wall(9)}, 9);
}
auto proposed(const Plan& truth) -> std::vector<std::vector<Profile>> {
  const auto flat = flat_draft(house(), 9).plan;
  return detail::setbacks_of(flat, detail::look(model::polygon_of(flat), ground, scan({truth}), {}), {});
}
auto has_terrace(const Profile& profile) -> bool {
  for (std::size_t i = 0; i + 1 < profile.size(); ++i)
    if (profile[i + 1].height == profile[i].height && profile[i + 1].inward > profile[i].inward) return true;
  return false;
}

TEST(Setback, is_proposed_where_it_is_as_deep_and_as_high_as_it_is) {
  for (const double depth : {1.0, 1.5, 2.5}) {
    const auto found = proposed(with_strip(depth));
    ASSERT_EQ(found.size(), 4U);
    ASSERT_FALSE(found[0].empty()) << depth;
    const auto& profile = found[0].front();
    ASSERT_EQ(profile.size(), 3U);
    EXPECT_NEAR(profile[1].height, 6.5, 0.15) << depth;
    EXPECT_NEAR(profile[2].inward, depth, 0.2);
    EXPECT_EQ(profile[2].height, profile[1].height);
    for (std::size_t side = 1; side < 4; ++side) EXPECT_TRUE(found[side].empty()) << depth << ", side " << side;
  }
}

TEST(Setback, is_not_proposed_where_there_is_a_slope_or_nothing) {
  const auto gabled = plan(house(), {roof(5, 0.9), wall(5), roof(5, 0.9), wall(5)}, 12);
  for (const auto& side : proposed(gabled)) EXPECT_TRUE(side.empty());
  for (const auto& side : proposed(plan(house(), {wall(9), wall(9), wall(9), wall(9)}, 9))) EXPECT_TRUE(side.empty());
}

TEST(Setback, is_not_proposed_for_a_step_lower_than_a_storeys_third) {
  const auto low = plan(house(), {setback_of(1.5, 8.5, 9), wall(9), wall(9), wall(9)}, 9);
  for (const auto& side : proposed(low)) EXPECT_TRUE(side.empty());
}

TEST(Setback, is_not_proposed_where_a_tower_stands_behind_a_part_of_the_side) {
  const auto around = plan(house(), {wall(6), wall(6), wall(6), wall(6)}, 6);
  const auto tower = plan(rectangle(14, 22, 3, 2), {wall(9), wall(9), wall(9), wall(9)}, 9);
  const auto site = detail::look({house(), {}}, ground, scan({around, tower}), {});
  const auto found = detail::setbacks_of(around, site, {});
  for (std::size_t side = 0; side < 4; ++side) EXPECT_TRUE(found[side].empty()) << side;
}

TEST(Setback, becomes_a_terrace_of_the_profile) {
  const auto truth = with_strip(1.5);
  const refine::Draft drafts[]{flat_draft(house(), 9)};
  const auto found = refine::refine(drafts, scan({truth}), {}, {});
  ASSERT_EQ(found.parts.size(), 1U);
  const auto& made = found.parts[0].plan;
  EXPECT_TRUE(std::ranges::any_of(made.profiles, has_terrace));
  EXPECT_LT(difference(found.parts, {truth}), 0.5);
}

}  // namespace
