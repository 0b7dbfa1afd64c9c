// Rows of houses: equal ones come out equal, unequal ones do not.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "scans.hpp"

namespace {

using namespace scans;
using testing::HasSubstr;

constexpr double width = 6;

/// A house of a row along x, gabled to the street and to the garden.
struct House {
  double gutter = 5, slope = 0.9, depth = 8;
  [[nodiscard]] auto ring(std::size_t place) const -> geometry::Ring {
    return rectangle(10 + width * static_cast<double>(place), 20, width, depth);
  }
  [[nodiscard]] auto plan(std::size_t place) const -> Plan {
    return scans::plan(ring(place), {roof(gutter, slope), wall(gutter), roof(gutter, slope), wall(gutter)}, 20);
  }
};

/// The row scanned and refined, each house a building of its own; parts by place.
auto row(const std::vector<House>& houses, const refine::Options& options = {}, double noise = 0.15)
    -> std::vector<refine::Part> {
  std::vector<Plan> plans;
  std::vector<refine::Draft> drafts;
  for (std::size_t i = 0; i < houses.size(); ++i) {
    plans.push_back(houses[i].plan(i));
    auto draft = flat_draft(houses[i].ring(i), houses[i].gutter + 1, i);
    draft.plan = plans.back();
    for (auto& profile : draft.plan.profiles)
      if (profile.size() == 3) profile = roof(houses[i].gutter + 0.1, houses[i].slope - 0.05);
    draft.caps = {20};
    drafts.push_back(std::move(draft));
  }
  refine::Options planes = options;
  planes.effort = refine::Effort::planes;
  auto out = refine::refine(drafts, scan(plans, noise), planes, {});
  EXPECT_EQ(out.parts.size(), houses.size());
  for (const auto& part : out.parts) EXPECT_THAT(solid::check(part.raised.solid), testing::IsEmpty());
  return std::move(out.parts);
}

auto gutter(const refine::Part& part, std::size_t side) -> double {
  return part.plan.profiles[part.plan.outer.profile_of_edge[side]][1].height;
}
auto slope(const refine::Part& part, std::size_t side) -> double {
  const auto& p = part.plan.profiles[part.plan.outer.profile_of_edge[side]];
  return (p.at(2).height - p[1].height) / p[2].inward;
}

TEST(Alike, gives_equal_houses_of_a_row_one_gutter_height_one_pitch_and_one_ridge) {
  const auto parts = row({{}, {}, {}});
  for (const auto& part : parts)
    for (const std::size_t side : {0, 2}) {
      EXPECT_NEAR(gutter(part, side), gutter(parts[0], 0), 1e-9);
      EXPECT_NEAR(slope(part, side), slope(parts[0], 0), 1e-9);
      EXPECT_NEAR(top_of(part.raised.solid), top_of(parts[0].raised.solid), 1e-4);
    }
  EXPECT_NEAR(gutter(parts[0], 0), 5, 0.05);
  EXPECT_NEAR(slope(parts[0], 0), 0.9, 0.02);
}

TEST(Alike, changes_nothing_where_values_have_no_price) {
  refine::Options free;
  free.value_price = 0;
  const auto parts = row({{}, {}, {}}, free);
  EXPECT_GT(std::abs(gutter(parts[0], 0) - gutter(parts[0], 2)) + std::abs(gutter(parts[0], 0) - gutter(parts[1], 0)),
            1e-4);
}

TEST(Alike, leaves_what_the_scan_shows_to_differ) {
  const auto parts = row({{5, 0.9, 8}, {5.3, 0.9, 8}, {5.3, 0.75, 8}});
  for (const std::size_t side : {0, 2}) {
    EXPECT_NEAR(gutter(parts[0], side), 5, 0.06);
    EXPECT_NEAR(gutter(parts[1], side), 5.3, 0.06);
    EXPECT_NEAR(slope(parts[1], side), 0.9, 0.03);
    EXPECT_NEAR(slope(parts[2], side), 0.75, 0.03);
  }
  // Within each of them opposite sides are alike.
  for (const auto& part : parts) EXPECT_NEAR(slope(part, 0), slope(part, 2), 1e-9);
}

TEST(Alike, takes_heights_for_equal_that_differ_by_less_than_their_bias) {
  const auto apart = [](double bias) {
    refine::Options options;
    options.alike.bias = bias;
    const auto parts = row({{5, 0.9, 8}, {5.15, 0.9, 8}}, options, 0.02);
    return std::abs(gutter(parts[0], 0) - gutter(parts[1], 0));
  };
  EXPECT_NEAR(apart(0), 0.15, 0.03);
  EXPECT_NEAR(apart(0.03), 0.15, 0.03);
  EXPECT_LT(apart(0.5), 1e-9);
}

TEST(Alike, gives_houses_of_unlike_depth_one_ridge_height) {
  const auto ridge = [](double depth) { return 5 + 0.9 * depth / 2; };
  const double slope_of_second = (ridge(8) - 5) / (8.3 / 2);
  const auto parts = row({{5, 0.9, 8}, {5, slope_of_second, 8.3}});
  EXPECT_NEAR(top_of(parts[0].raised.solid), top_of(parts[1].raised.solid), 1e-3);
  EXPECT_NEAR(gutter(parts[0], 0), gutter(parts[1], 0), 1e-9);
  EXPECT_GT(std::abs(slope(parts[0], 0) - slope(parts[1], 0)), 0.01);
}

TEST(Alike, says_what_it_changed) {
  const auto parts = row({{}, {}, {}});
  EXPECT_TRUE(std::ranges::any_of(parts, [](const refine::Part& part) {
    return !part.changes.empty() && testing::Matches(HasSubstr("neighbours'"))(part.changes.back());
  }));
}

TEST(Alike, does_not_depend_on_what_does_not_touch) {
  // Two houses, and two more of them of them, apart by the width of a house that is not there.
  std::vector<Plan> plans;
  std::vector<refine::Draft> drafts;
  for (const std::size_t place : {0, 1, 3, 4}) {
    plans.push_back(House{}.plan(place));
    drafts.push_back({place, plans.back(), {20}, {}});
    for (auto& profile : drafts.back().plan.profiles)
      if (profile.size() == 3) profile = roof(5.1, 0.85);
  }
  refine::Options options;
  options.effort = refine::Effort::planes;
  const auto mesh = scan(plans, 0.15);
  const auto four = refine::refine(drafts, mesh, options, {});
  drafts.resize(2);
  const auto two = refine::refine(drafts, mesh, options, {});
  ASSERT_EQ(four.parts.size(), 4U);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(four.parts[i].plan, two.parts[i].plan);
}

}  // namespace
