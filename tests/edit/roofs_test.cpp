// Roofs in one step, among neighbours.
#include "mansard/edit/roofs.hpp"

#include <gmock/gmock.h>

#include "edit/plans.hpp"
#include "mansard/solid/append_surface.hpp"

namespace mansard::edit {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

auto scan_of(const std::vector<model::Plan>& plans) -> rays::Scene {
  geometry::Mesh mesh;
  for (const auto& plan : plans) solid::append_surface(pipeline::raise_part(plan, {})->solid, mesh);
  return rays::Scene(mesh);
}

TEST(Roofs, know_edges_with_neighbours) {
  const auto one = test::house();
  EXPECT_THAT(shared_edges(one, {}), ElementsAre(false, false, false, false));
  const std::vector<model::Plan> beside{test::plan_of(test::rectangle(10, 2, 15, 20), {test::wall}),
                                        test::plan_of(test::rectangle(2, 8.03, 5, 12), {test::wall}),
                                        test::plan_of(test::rectangle(0, -5, 10, -1), {test::wall})};
  EXPECT_THAT(shared_edges(one, beside), ElementsAre(false, true, false, false));  // 6 of 8 m, 3 of 10 m, and 1 m away
}

TEST(Roofs, of_every_kind_suit_the_scan_of_that_kind) {
  const auto truth = test::house();
  const auto scan = scan_of({truth});
  auto flat = test::plan_of(test::rectangle(0, 0, 10, 8), {{{0, 0}, {0, 5}}}, 0, 5);
  ASSERT_TRUE(error_of(flat, scan, {}));
  EXPECT_GT(*error_of(flat, scan, {}), 1);
  const auto gable = roof_of(refine::Kind::gable, flat, {}, scan, {});
  ASSERT_TRUE(gable) << base::to_string(gable.error());
  EXPECT_LT(gable->mse.value(), 1e-3);
  for (const auto kind : refine::kinds) {
    const auto other = roof_of(kind, flat, {}, scan, {});
    ASSERT_TRUE(other) << refine::to_string(kind);
    EXPECT_GE(other->mse.value() + 1e-6, gable->mse.value()) << refine::to_string(kind);
  }
  auto off = truth;
  for (auto& profile : off.profiles)
    for (std::size_t i = 1; i < profile.size(); ++i) profile[i].height += 0.4;
  off.cap += 0.4;
  const auto fitted = fitted_roof(off, scan, {});
  ASSERT_TRUE(fitted);
  EXPECT_LT(fitted->mse.value(), 1e-3);
}

TEST(Roofs, that_are_worse_or_above_the_scan_are_told) {
  const std::vector<NamedPlan> own{{"a-1", test::house()}};
  const auto scan = scan_of({test::house()});
  const Site site{.neighbours = {}, .before = {}, .mesh = &scan};
  EXPECT_THAT(doubts_of(raise(own, site, {}), 0.01, scan), IsEmpty());
  auto higher = own;
  for (auto& profile : higher[0].plan.profiles)
    for (std::size_t i = 1; i < profile.size(); ++i) profile[i].height += 1;
  higher[0].plan.cap += 1;
  auto doubts = doubts_of(raise(higher, site, {}), 0.01, scan);
  ASSERT_EQ(doubts.size(), 1U);
  EXPECT_EQ(doubts[0].code, "edit-error");
  EXPECT_THAT(doubts[0].message, testing::HasSubstr("from 0.10 m to 1.00 m"));
  EXPECT_THAT(doubts_of(raise(higher, site, {}), 0.9, scan), IsEmpty());
  EXPECT_THAT(doubts_of(raise(higher, site, {}), std::nullopt, scan), IsEmpty());
  for (auto& profile : higher[0].plan.profiles)
    for (std::size_t i = 1; i < profile.size(); ++i) profile[i].height += 2;
  higher[0].plan.cap += 2;
  doubts = doubts_of(raise(higher, site, {}), 9, scan);
  ASSERT_EQ(doubts.size(), 1U);
  EXPECT_EQ(doubts[0].code, "edit-above");
  EXPECT_EQ(doubts[0].subject, "a-1");
}

}  // namespace
}  // namespace mansard::edit
