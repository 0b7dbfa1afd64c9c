// Planes that bend along their side.
#include "mansard/refine/detail/bends.hpp"

#include <gtest/gtest.h>

#include "judged_by_scan.hpp"

namespace {

using namespace scans;
namespace detail = refine::detail;

/// A roof over a house of 10 x 8 m between two walls, with that profile on both long sides.
auto gable(const Profile& side) -> Plan { return plan(rectangle(10, 20, 10, 8), {side, wall(12), side, wall(12)}, 12); }

class Bends : public JudgedByScan {
 protected:
  /// What becomes of the first roof, by a scan of the other.
  auto bent(const Plan& roof, const Plan& truth, double noise) -> detail::Judged {
    model::Accuracy accuracy;
    accuracy.noise = noise, accuracy.correlated_area = 0.1, accuracy.blur = 0, accuracy.edge_noise = noise / 5;
    before_ = judged(roof, {truth}, noise, accuracy);
    return detail::bent(before_, *judge_);
  }
  detail::Judged before_;
};

TEST_F(Bends, are_found_where_a_ledge_runs_along_the_eaves) {
  const Profile ledge{{0, 0}, {0, 6}, {0.5, 6}, {1.5, 7}};
  const auto out = bent(gable(roof(5.5, 1)), gable(ledge), 0.005);
  EXPECT_LT(out.cost, before_.cost - options_.face_price);
  for (const std::size_t side : {0U, 2U}) {
    const auto& profile = out.plan.profiles[side];
    ASSERT_EQ(profile.size(), 4U);
    EXPECT_NEAR(profile[1].height, 6, 0.03);
    EXPECT_NEAR(profile[2].inward, 0.5, 0.03);
    EXPECT_NEAR(profile[2].height, 6, 0.03);
    EXPECT_NEAR(profile[3].height - profile[2].height, profile[3].inward - profile[2].inward, 0.01);
  }
}

TEST_F(Bends, are_found_where_the_upper_roof_is_gentler) {
  const Profile knee{{0, 0}, {0, 5}, {1.6, 7.4}, {2.6, 7.7}};
  const auto out = bent(gable(roof(5.8, 0.7)), gable(knee), 0.02);
  for (const std::size_t side : {0U, 2U}) {
    const auto& profile = out.plan.profiles[side];
    ASSERT_EQ(profile.size(), 4U);
    EXPECT_NEAR(profile[2].inward, 1.6, 0.05);
    EXPECT_NEAR(profile[2].height, 7.4, 0.05);
  }
}

TEST_F(Bends, are_not_made_of_noise) {
  const auto truth = gable(roof(6, 0.7));
  EXPECT_EQ(bent(truth, truth, 0.15).plan, truth);
}

TEST_F(Bends, are_no_walls) {
  const Profile step{{0, 0}, {0, 6}, {0.6, 6}, {0.6, 7.5}, {1.6, 7.7}};
  const auto roof = gable({{0, 0}, {0, 6}, {2, 8}});
  const auto out = bent(roof, gable(step), 0.005);
  for (const auto& profile : out.plan.profiles)
    for (std::size_t i = 1; i + 1 < profile.size(); ++i) {
      const double run = profile[i + 1].inward - profile[i].inward;
      EXPECT_LT(profile[i + 1].height - profile[i].height, options_.forms.max_slope * run);
    }
}

}  // namespace
