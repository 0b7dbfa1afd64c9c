// Faces that a scan cannot have shown.
#include <gmock/gmock.h>

#include "mansard/refine/detail/judge.hpp"
#include "mansard/refine/detail/supported.hpp"
#include "scans.hpp"

namespace {

using namespace scans;
using refine::detail::Judge;
using testing::IsEmpty;
using testing::SizeIs;

const geometry::Ring house = rectangle(10, 20, 12, 8);

/// The house with sides like that at its short ends.
auto ended(Profile end) -> Plan { return plan(house, {roof(5, 0.8), end, roof(5, 0.8), end}, 12); }
auto terraced(double depth) -> Plan {
  const Profile step{{0, 0}, {0, 3}, {depth, 3}, {depth, 6}};
  return plan(house, {step, wall(6), wall(6), wall(6)}, 6);
}

class Bare : public testing::Test {
 protected:
  /// Judged over what the scan of another plan shows.
  auto judge(const Plan& seen) -> const Judge& {
    mesh_.emplace(scan({seen}));
    site_ = refine::detail::look({house, {}}, ground, *mesh_, options_);
    judge_.emplace(site_, options_, raising_, run_);
    return *judge_;
  }
  refine::Options options_;

 private:
  extrude::Options raising_;
  base::Run run_;
  std::optional<rays::Scene> mesh_;
  refine::detail::Site site_;
  std::optional<Judge> judge_;
};

TEST_F(Bare, small_hips_are_and_gables_and_wide_hips_are_not) {
  const auto& judged = judge(ended(wall(5)));
  EXPECT_THAT(judged(ended(wall(5)))->bare, IsEmpty());
  EXPECT_THAT(judged(ended(roof(5, 6)))->bare, SizeIs(2));  // a plane of 0.53 m at either end
  EXPECT_THAT(judged(ended(roof(5, 0.8)))->bare, IsEmpty());
}

TEST_F(Bare, narrow_terraces_are_and_wide_ones_are_not) {
  const auto& judged = judge(terraced(1.5));
  EXPECT_THAT(judged(terraced(0.5))->bare, SizeIs(1));
  EXPECT_THAT(judged(terraced(1.5))->bare, IsEmpty());
}

TEST_F(Bare, a_steep_face_is_where_the_scan_shows_a_wall) {
  const Plan sloped = plan(house, {{{0, 0}, {1.2, 6}}, wall(6), wall(6), wall(6)}, 6);
  EXPECT_THAT(judge(sloped)(sloped)->bare, IsEmpty());
  const Plan upright = plan(house, std::vector<Profile>(4, wall(6)), 6);
  EXPECT_THAT(judge(upright)(sloped)->bare, SizeIs(1));
}

TEST_F(Bare, each_costs_as_much_as_a_part) {
  const auto& judged = judge(terraced(1.5));
  const auto narrow = judged(terraced(0.5));
  // All but the wall behind the terrace, which ends with it.
  const double faces = options_.face_price * static_cast<double>(narrow->sketch.faces.size() - 1);
  EXPECT_NEAR(narrow->cost - narrow->misfit - faces, options_.part_price, 1e-9);
}

TEST_F(Bare, a_small_hip_becomes_a_gable) {
  const auto& judged = judge(ended(wall(5)));
  const auto made = refine::detail::supported(*judged(ended(roof(5, 6))), judged);
  EXPECT_THAT(made.bare, IsEmpty());
  EXPECT_THAT(pitched_sides(made.plan), testing::ElementsAre(0, 2));
}

TEST_F(Bare, a_hip_under_a_cap_ends_in_a_ridge) {
  Plan capped = ended(wall(5));
  capped.cap = 5 + 0.8 * 4 - 0.1;  // a strip of 0.25 m
  const auto& judged = judge(ended(wall(5)));
  EXPECT_THAT(judged(capped)->bare, SizeIs(1));
  EXPECT_THAT(refine::detail::supported(*judged(capped), judged).bare, IsEmpty());
}

TEST_F(Bare, a_narrow_terrace_becomes_a_wall_or_goes) {
  const auto& judged = judge(plan(house, std::vector<Profile>(4, wall(6)), 6));
  const auto made = refine::detail::supported(*judged(terraced(0.5)), judged);
  EXPECT_THAT(made.bare, IsEmpty());
  EXPECT_LT(made.misfit, 1);
}

}  // namespace
