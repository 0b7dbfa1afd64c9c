// Steps that a scan shows as steep slopes.
#include "mansard/refine/detail/steps.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "judged_by_scan.hpp"

namespace {

namespace geometry = mansard::geometry;
namespace model = mansard::model;

using namespace scans;
namespace detail = refine::detail;

auto house() -> geometry::Ring { return rectangle(10, 20, 6, 12); }

/// A flat roof at 9 m; along the first side, of 6 m, a strip of that depth at 6.5 m, or a slope from there.
auto stepped(double depth) -> Plan {
  return plan(house(), {{{0, 0}, {0, 6.5}, {depth, 6.5}, {depth, 9}}, wall(9), wall(9), wall(9)}, 9);
}
auto sloped(double gutter, double slope) -> Plan {
  return plan(house(), {roof(gutter, slope), wall(9), wall(9), wall(9)}, 9);
}

class Steps : public JudgedByScan {
 protected:
  /// The first roof, judged by a scan of the other.
  auto judged(const Plan& roof, const Plan& truth) -> detail::Judged {
    model::Accuracy accuracy;
    accuracy.noise = 0.1, accuracy.correlated_area = 6, accuracy.blur = 0.2, accuracy.edge_noise = 0.05;
    return JudgedByScan::judged(roof, {truth}, 0.02, accuracy);
  }
};

TEST_F(Steps, stand_in_for_the_slope_that_suits_a_smoothed_step) {
  const auto slope = judged(sloped(5.4, 1.7), stepped(1.4));
  ASSERT_EQ(detail::steep_faces(slope).size(), 1U);
  const auto step = detail::stepped(slope, *judge_, slope.cost + options_.face_price);
  EXPECT_TRUE(detail::steep_faces(step).empty());
  const auto& profile = step.plan.profiles[0];
  ASSERT_EQ(profile.size(), 3U);
  EXPECT_NEAR(profile[1].height, 6.5, 0.1);
  EXPECT_NEAR(profile[2].inward, 1.4, 0.15);
}

TEST_F(Steps, are_not_made_of_a_slope) {
  const auto slope = judged(sloped(6.5, 1.25), sloped(6.5, 1.25));
  ASSERT_EQ(detail::steep_faces(slope).size(), 1U);
  EXPECT_EQ(detail::stepped(slope, *judge_, slope.cost + options_.face_price).plan, slope.plan);
}

// The strip is higher than the pitch behind the steep one begins: the two meet, and there is no wall between them.
TEST_F(Steps, without_a_wall_repeat_no_point) {
  const auto pitches = plan(house(), {{{0, 0}, {0, 5.4}, {1, 7}, {3, 8}}, wall(9), wall(9), wall(9)}, 9);
  const auto slope =
      judged(pitches, plan(house(), {{{0, 0}, {0, 7.5}, {1.4, 7.5}, {1.4, 9}}, wall(9), wall(9), wall(9)}, 9));
  const auto faces = detail::steep_faces(slope);
  ASSERT_EQ(faces.size(), 1U);
  const auto plans = detail::with_step(slope, faces[0], *judge_);
  ASSERT_FALSE(plans.empty());
  for (const auto& one : plans)
    for (const auto& profile : one.profiles) EXPECT_EQ(std::ranges::adjacent_find(profile), profile.end());
}

TEST_F(Steps, are_no_face_more_than_the_slope) {
  const auto slope = judged(sloped(6.5, 1.25), stepped(1.4)), step = judged(stepped(1.4), stepped(1.4));
  EXPECT_EQ(step.sketch.faces.size(), slope.sketch.faces.size() + 1);
  EXPECT_NEAR(step.cost - step.misfit, slope.cost - slope.misfit, 1e-9);
}

}  // namespace
