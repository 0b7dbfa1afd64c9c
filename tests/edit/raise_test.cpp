#include <gmock/gmock.h>

#include "edit/plans.hpp"

namespace mansard::edit {
namespace {

using geometry::Point2;
using model::Plan;
using testing::HasSubstr;
using testing::IsEmpty;

auto mesh_of(const model::Solid& solid) -> geometry::Mesh {
  return {solid.vertices, solid::triangulate(solid)->triangles};
}

auto party_walls(const RaisedPart& part) -> double { return label::areas(*part.model).party_wall; }

TEST(Raise, makes_the_solid_that_export_makes_and_measures_it) {
  const std::vector<NamedPlan> parts{{"a-1", test::house()}};
  const auto solid = pipeline::raise_part(parts[0].plan, {})->solid;
  const rays::Scene scan(mesh_of(solid));
  const auto raised = raise(parts, {.neighbours = {}, .before = {}, .mesh = &scan}, {});
  ASSERT_TRUE(raised.valid());
  ASSERT_EQ(raised.parts.size(), 1U);
  EXPECT_EQ(raised.parts[0].model->solid.vertices, solid.vertices);
  EXPECT_NEAR(raised.parts[0].volume, 10 * 8 * 5 + 10 * 8 * 4 / 2, 0.01);
  EXPECT_EQ(raised.parts[0].outcome, extrude::Outcome::full);
  ASSERT_TRUE(raised.mse);
  EXPECT_LT(*raised.mse, 1e-6);

  auto higher = parts;
  for (auto& profile : higher[0].plan.profiles)
    for (std::size_t i = 1; i < profile.size(); ++i) profile[i].height += 0.5;
  higher[0].plan.cap += 0.5;
  const auto lifted = raise(higher, {.neighbours = {}, .before = {}, .mesh = &scan}, {});
  EXPECT_NEAR(lifted.mse.value(), 0.25, 1e-3);
  EXPECT_FALSE(raise(parts, {}, {}).mse);
}

TEST(Raise, weighs_the_error_of_the_parts_by_their_area) {
  const std::vector<NamedPlan> parts{{"a-1", test::plan_of(test::rectangle(0, 0, 10, 9), {test::wall}, 0, 5)},
                                     {"a-2", test::plan_of(test::rectangle(10, 0, 13, 10), {test::wall}, 0, 7)}};
  geometry::Mesh level{{{-5, -5, 5}, {20, -5, 5}, {20, 15, 5}, {-5, 15, 5}}, {{0, 1, 2}, {0, 2, 3}}};
  const rays::Scene scan(level);
  const auto raised = raise(parts, {.neighbours = {}, .before = {}, .mesh = &scan}, {});
  EXPECT_NEAR(raised.parts[0].mse.value(), 0, 1e-6);
  EXPECT_NEAR(raised.parts[1].mse.value(), 4, 1e-6);
  EXPECT_NEAR(raised.mse.value(), 4 * 30.0 / 120, 1e-6);
}

TEST(Raise, raises_the_pieces_of_a_split_with_a_party_wall_between_them) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    base::Random random(seed);
    const auto whole = test::plan_of(test::star(random, 4 + random.index(8)), {test::pitch, test::wall});
    const double angle = random.uniform(0, 3.14);
    const Point2 far{15 * std::cos(angle), 15 * std::sin(angle)};
    const std::vector<Point2> line{far, {random.uniform(-1, 1), random.uniform(-1, 1)}, -1.0 * far};
    const auto parts = split("a", {{"a-1", whole}}, "a-1", line);
    if (!parts) continue;
    const auto raised = raise(*parts, {}, {});
    EXPECT_THAT(raised.diagnostics, IsEmpty());
    ASSERT_TRUE(raised.valid());
    for (const auto& part : raised.parts) {
      EXPECT_THAT(solid::check(part.model->solid), IsEmpty());
      EXPECT_GT(party_walls(part), 0) << part.id;
    }
  }
}

TEST(Raise, knows_party_walls_with_neighbouring_buildings) {
  const std::vector<NamedPlan> parts{{"a-1", test::house()}};
  const std::vector<Plan> beside{test::house(10)}, away{test::house(30)};
  EXPECT_NEAR(party_walls(raise(parts, {.neighbours = beside, .before = {}, .mesh = nullptr}, {}).parts[0]),
              8 * 5 + 8 * 4 / 2, 0.1);
  EXPECT_EQ(party_walls(raise(parts, {.neighbours = away, .before = {}, .mesh = nullptr}, {}).parts[0]), 0);
}

TEST(Raise, finds_ground_that_is_claimed_twice) {
  const std::vector<NamedPlan> parts{{"a-1", test::house()}, {"a-2", test::house(9.9)}};
  const auto raised = raise(parts, {}, {});
  ASSERT_EQ(raised.diagnostics.size(), 1U);
  EXPECT_EQ(raised.diagnostics[0].code, "edit-overlap");
  EXPECT_EQ(raised.diagnostics[0].subject, "a-2");
  EXPECT_THAT(raised.diagnostics[0].message, HasSubstr("part a-1"));
  EXPECT_FALSE(raised.valid());

  const std::vector<Plan> neighbours{test::house(0, 7.9), test::house(0, 30)};
  const auto against =
      raise(std::span(parts).subspan(0, 1), {.neighbours = neighbours, .before = {}, .mesh = nullptr}, {});
  ASSERT_EQ(against.diagnostics.size(), 1U);
  EXPECT_THAT(against.diagnostics[0].message, HasSubstr("neighbouring building"));
}

TEST(Raise, lets_the_seams_of_two_surveys_pass) {
  const std::vector<NamedPlan> parts{{"a-1", test::house()}};
  for (const double strip : {0.01, 0.019}) {
    const std::vector<Plan> neighbours{test::house(10 - strip)};
    EXPECT_TRUE(raise(parts, {.neighbours = neighbours, .before = {}, .mesh = nullptr}, {}).valid()) << strip;
  }
  const std::vector<Plan> neighbours{test::house(10 - 0.03)};
  EXPECT_FALSE(raise(parts, {.neighbours = neighbours, .before = {}, .mesh = nullptr}, {}).valid());
}

TEST(Raise, does_not_blame_an_edit_for_earlier_overlaps) {
  const std::vector<NamedPlan> before{{"a-1", test::house()}};
  const std::vector<Plan> neighbours{test::house(9.5)};
  auto lower = before;
  lower[0].plan.cap = 6;
  EXPECT_TRUE(raise(lower, {.neighbours = neighbours, .before = before, .mesh = nullptr}, {}).valid());
  auto wider = before;
  wider[0].plan = test::plan_of(test::rectangle(0, 0, 10.1, 8), {test::pitch, test::wall});
  EXPECT_FALSE(raise(wider, {.neighbours = neighbours, .before = before, .mesh = nullptr}, {}).valid());
  const std::vector<NamedPlan> two{{"a-1", test::house()}, {"a-2", test::house(9)}};
  EXPECT_TRUE(raise(two, {.neighbours = {}, .before = two, .mesh = nullptr}, {}).valid());
}

TEST(Raise, refuses_an_edit_whose_overlap_cannot_be_computed_unless_it_could_not_be_before) {
  const std::vector<NamedPlan> parts{{"a-1", test::house()}};
  const std::vector<Plan> neighbours{test::plan_of({{{5, 5}, {15, 15}, {15, 5}, {5, 15}}, {}}, {test::wall})};
  const auto raised = raise(parts, {.neighbours = neighbours, .before = {}, .mesh = nullptr}, {});
  EXPECT_FALSE(raised.valid());
  ASSERT_EQ(raised.diagnostics.size(), 1U);
  EXPECT_EQ(raised.diagnostics[0].code, "edit-overlap-unchecked");
  EXPECT_EQ(raised.diagnostics[0].subject, "a-1");
  const auto again = raise(parts, {.neighbours = neighbours, .before = parts, .mesh = nullptr}, {});
  EXPECT_TRUE(again.valid());
  ASSERT_EQ(again.diagnostics.size(), 1U);
  EXPECT_EQ(again.diagnostics[0].severity, base::Severity::warning);
}

TEST(Raise, says_of_a_part_that_cannot_be_raised_why_and_raises_the_others) {
  std::vector<NamedPlan> parts{{"a-1", test::plan_of({{{0, 0}, {4, 4}, {4, 0}, {0, 6}}, {}}, {test::wall})},
                               {"a-2", test::house(20)},
                               {"a-3", test::house(40)}};
  parts[2].plan.cap = -1;
  const auto raised = raise(parts, {}, {});
  EXPECT_FALSE(raised.valid());
  EXPECT_FALSE(raised.parts[0].model);
  ASSERT_EQ(raised.parts[0].diagnostics.size(), 1U);
  EXPECT_EQ(raised.parts[0].diagnostics[0].code, "extrude-not-simple");
  EXPECT_EQ(raised.parts[0].diagnostics[0].subject, "a-1");
  EXPECT_TRUE(raised.parts[1].model);
  EXPECT_EQ(raised.parts[2].diagnostics.at(0).code, "extrude-cap");
}

TEST(Raise, refuses_two_parts_of_one_id) {
  const std::vector<NamedPlan> parts{{"a-1", test::house()}, {"a-1", test::house(20)}};
  const auto raised = raise(parts, {}, {});
  ASSERT_EQ(raised.diagnostics.size(), 1U);
  EXPECT_EQ(raised.diagnostics[0].code, "edit-duplicate-id");
  EXPECT_FALSE(raised.valid());
}

TEST(Raise, takes_a_building_without_parts) { EXPECT_TRUE(raise({}, {}, {}).valid()); }

}  // namespace
}  // namespace mansard::edit
