// Roofs of which the crown of a tree hides some, or all.
#include <gtest/gtest.h>

#include "tests/refine/scans.hpp"

namespace mansard {
namespace {

using namespace scans;

/// A level sheet.
auto sheet(geometry::Box2 box, double z) -> rays::Scene {
  const auto [a, b] = box;
  return rays::Scene({{{a.x, a.y, z}, {b.x, a.y, z}, {b.x, b.y, z}, {a.x, b.y, z}}, {{0, 1, 2}, {0, 2, 3}}});
}

TEST(Hidden, roofs_are_not_above_the_crown_that_hides_them) {
  const std::vector drafts{flat_draft(rectangle(0, 0, 6, 4), 13)};
  const auto elsewhere = sheet({{50, 50}, {60, 60}}, ground + 6), above = sheet({{-2, -2}, {8, 6}}, ground + 5);
  const auto free = refine::refine(drafts, elsewhere, {}, {});
  ASSERT_EQ(free.parts.size(), 1U);
  EXPECT_NEAR(top_of(free.parts[0].raised.solid), ground + 13, 0.01);  // nothing is known: as it was
  const auto below = refine::refine(drafts, elsewhere, {}, {}, {}, &above);
  ASSERT_EQ(below.parts.size(), 1U);
  EXPECT_NEAR(top_of(below.parts[0].raised.solid), ground + 5, 0.01);
}

TEST(Hidden, parts_are_joined_with_what_is_seen_beside_them) {
  const std::vector drafts{flat_draft(rectangle(0, 0, 8, 6), 6), flat_draft(rectangle(8, 0, 1.5, 6), 6.4)};
  const auto seen = sheet({{-1, -1}, {8, 7}}, ground + 6), above = sheet({{-1, -1}, {10, 7}}, ground + 8);
  EXPECT_EQ(refine::refine(drafts, seen, {}, {}).parts.size(), 2U);
  const auto joined = refine::refine(drafts, seen, {}, {}, {}, &above);
  ASSERT_EQ(joined.parts.size(), 1U);
  EXPECT_NEAR(top_of(joined.parts[0].raised.solid), ground + 6, 0.05);
  EXPECT_NEAR(geometry::area(model::polygon_of(joined.parts[0].plan)), 57, 0.1);
}

TEST(Hidden, an_annex_of_which_only_the_ground_beside_it_is_seen_keeps_its_height) {
  const std::vector drafts{flat_draft(rectangle(0, 0, 6, 4), 4.5)};
  const auto above = sheet({{-2, -2}, {8, 6}}, ground + 5);
  bool says_so = false;
  const auto top_with = [&](double width, double height) {
    const auto strip = sheet({{-2, -2}, {width, 6}}, ground + height);
    const auto refined = refine::refine(drafts, strip, {}, {}, {}, &above);
    EXPECT_EQ(refined.parts.size(), 1U);
    says_so = !refined.parts[0].changes.empty() &&
              refined.parts[0].changes.back() == "the crown of a tree hides it: its height, 4.5 m, is a guess";
    return top_of(refined.parts[0].raised.solid);
  };
  EXPECT_NEAR(top_with(0.5, 0.1), ground + 4.5, 0.01);
  EXPECT_TRUE(says_so);
  EXPECT_LT(top_with(3, 0.1), ground + 4) << "half of it is seen: a yard";
  EXPECT_NEAR(top_with(0.5, 3), ground + 3, 0.1) << "what is seen is roof";
}

TEST(Hidden, an_annex_under_the_roof_of_its_house_is_cut_out_below_the_crown) {
  // 13 by 6 m at 12 m; of the last 3 m a crown 6 m above the ground is all that is seen.
  const std::vector drafts{flat_draft(rectangle(0, 0, 13, 6), 12)};
  const auto seen = sheet({{-1, -1}, {10, 7}}, ground + 12);
  const rays::Scene above({{{-1, -1, ground + 12},
                            {10, -1, ground + 12},
                            {10, 7, ground + 12},
                            {-1, 7, ground + 12},
                            {10, -1, ground + 6},
                            {14, -1, ground + 6},
                            {14, 7, ground + 6},
                            {10, 7, ground + 6}},
                           {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}});
  const auto refined = refine::refine(drafts, seen, {}, {}, {}, &above);
  ASSERT_EQ(refined.parts.size(), 2U);
  std::vector<double> tops, areas;
  for (const auto& part : refined.parts) tops.push_back(top_of(part.raised.solid) - ground);
  for (const auto& part : refined.parts) areas.push_back(geometry::area(model::polygon_of(part.plan)));
  const std::size_t low = tops[0] < tops[1] ? 0 : 1;
  EXPECT_NEAR(tops[low], 6, 0.1);
  EXPECT_NEAR(areas[low], 18, 2);
  EXPECT_NEAR(tops[1 - low], 12, 0.1);
}

TEST(Hidden, roofs_that_are_seen_are_the_same_below_a_mesh_without_crowns) {
  const auto truth = plan(rectangle(10, 20, 12, 8), {roof(5, 0.9), wall(5), roof(5, 0.9), wall(5)}, 12);
  const auto mesh = scan({truth});
  const std::vector drafts{flat_draft(rectangle(10, 20, 12, 8), 6)};
  const auto without = refine::refine(drafts, mesh, {}, {}), with = refine::refine(drafts, mesh, {}, {}, {}, &mesh);
  ASSERT_EQ(without.parts.size(), with.parts.size());
  EXPECT_EQ(without.parts[0].plan, with.parts[0].plan);
}

}  // namespace
}  // namespace mansard
