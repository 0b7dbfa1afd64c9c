// Roofs of one kind for the scan.
#include "mansard/refine/kinds.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "mansard/extrude/corner_edges.hpp"
#include "scans.hpp"

namespace {

using namespace scans;
using refine::Kind;
using testing::ElementsAre;

auto house() -> geometry::Ring { return rectangle(10, 20, 12, 8); }
auto flat_house(double height = 6) -> Plan { return flat_draft(house(), height).plan; }

auto roof_of(Kind kind, const Plan& plan, const rays::Scene& mesh, const std::vector<bool>& shared = {}) -> Plan {
  const auto made = refine::roof_of(kind, plan, shared, mesh, {}, {});
  EXPECT_TRUE(made) << base::to_string(made.error());
  return made ? *made : plan;
}
auto height_of(const Plan& plan) -> double { return top_of(extrude::raise(plan)->solid); }

/// m; root mean square, well inside.
auto error(const Plan& plan, const Plan& truth) -> double {
  refine::Part part;
  part.raised = *extrude::raise(plan);
  return difference({part}, {truth});
}

TEST(Kinds, are_found_with_their_direction_and_pitch) {
  const Plan along = plan(house(), {roof(5, 0.9), wall(5), roof(5, 0.9), wall(5)}, 12);
  const Plan across = plan(house(), {wall(5), roof(5, 0.6), wall(5), roof(5, 0.6)}, 12);
  const Plan uneven = plan(house(), {roof(4, 0.9), wall(5), roof(5, 0.6), wall(5)}, 12);
  const Plan shed = plan(house(), {wall(9), wall(9), roof(4, 0.4), wall(9)}, 9);
  const Plan hip = plan(house(), {roof(5, 0.7), roof(5, 0.7), roof(5, 0.7), roof(5, 0.7)}, 12);
  const Profile steep{{0, 0}, {0, 4}, {1, 6.5}, {2, 6.9}};
  const Plan gambrel = plan(house(), {steep, wall(4), steep, wall(4)}, 12);
  const Plan mansard = plan(house(), {steep, steep, steep, steep}, 12);
  const Plan pyramid = plan(house(), {roof(5, 3.0 / 4), roof(5, 3.0 / 6), roof(5, 3.0 / 4), roof(5, 3.0 / 6)}, 12);
  const Plan half_hip = plan(house(), {roof(5, 0.8), roof(6.8, 0.8), roof(5, 0.8), roof(6.8, 0.8)}, 12);
  const Profile end{{0, 0}, {0, 5}, {1.6, 6.28}, {1.6, 9}};
  const Plan gablet = plan(house(), {roof(5, 0.8), end, roof(5, 0.8), end}, 12);
  const Plan level = flat_house(7);
  for (const auto& [kind, truth] :
       {std::pair{Kind::gable, along}, std::pair{Kind::gable, across}, std::pair{Kind::gable, uneven},
        std::pair{Kind::shed, shed}, std::pair{Kind::hip, hip}, std::pair{Kind::gambrel, gambrel},
        std::pair{Kind::mansard, mansard}, std::pair{Kind::pyramid, pyramid}, std::pair{Kind::flat, level},
        std::pair{Kind::half_hip, half_hip}, std::pair{Kind::gablet, gablet}}) {
    SCOPED_TRACE(std::string(refine::to_string(kind)));
    const auto mesh = scan({truth});
    const Plan made = roof_of(kind, flat_house(), mesh);
    EXPECT_LT(error(made, truth), 0.06);
    EXPECT_EQ(pitched_sides(made), pitched_sides(truth));
    EXPECT_NEAR(height_of(made), height_of(truth), 0.15);
  }
}

TEST(Kinds, that_the_scan_does_not_show_are_roofs_of_that_kind_and_no_towers) {
  const auto mesh = scan({flat_house(6)});
  for (const Kind kind : refine::kinds) {
    SCOPED_TRACE(std::string(refine::to_string(kind)));
    const Plan made = roof_of(kind, flat_house(), mesh);
    if (kind == Kind::flat) continue;
    EXPECT_FALSE(pitched_sides(made).empty());
    EXPECT_LT(height_of(made), ground + 6 + 2.5);  // a steep foot is as high as one is
    EXPECT_EQ(extrude::raise(made)->outcome, extrude::Outcome::full);
  }
}

// A house in a row, deeper than wide: its long sides have neighbours.
TEST(Kinds, of_houses_in_a_row_rise_from_front_and_back) {
  const auto narrow = rectangle(10, 20, 5, 11);
  const Plan truth = plan(narrow, {roof(6, 0.8), wall(6), roof(6, 0.8), wall(6)}, 12);
  const auto mesh = scan({truth, plan(rectangle(15, 20, 5, 11), {roof(6, 0.8), wall(6), roof(6, 0.8), wall(6)}, 12)});
  const Plan made = roof_of(Kind::gable, flat_draft(narrow, 6).plan, mesh, {false, true, false, true});
  EXPECT_THAT(pitched_sides(made), ElementsAre(0, 2));
  EXPECT_LT(error(made, truth), 0.06);
}

TEST(Kinds, rise_from_a_side_with_a_lower_neighbour) {
  const Plan truth = plan(house(), {roof(5, 0.9), wall(5), roof(5, 0.9), wall(5)}, 12);
  const auto mesh = scan({truth, plan(rectangle(10, 28, 12, 4), std::vector<Profile>(4, wall(3)), 3)});
  const Plan made = roof_of(Kind::gable, flat_house(), mesh, {false, false, true, false});
  EXPECT_THAT(pitched_sides(made), ElementsAre(0, 2));
}

TEST(Kinds, are_refused_where_there_is_no_scan_or_no_such_roof) {
  geometry::Mesh elsewhere;
  elsewhere.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  elsewhere.triangles = {{0, 1, 2}};
  const auto unseen = refine::roof_of(Kind::gable, flat_house(), {}, rays::Scene(elsewhere), {}, {});
  ASSERT_FALSE(unseen);
  EXPECT_EQ(unseen.error().code, "refine-unseen");
  const auto triangle = flat_draft({{10, 20}, {22, 20}, {16, 28}}, 6).plan;
  const auto none = refine::roof_of(Kind::gable, triangle, {}, scan({triangle}), {}, {});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, "refine-kind");
  std::set<std::string> known;
  for (const auto& code : refine::codes()) known.insert(code.code);
  EXPECT_TRUE(known.contains("refine-unseen") && known.contains("refine-kind"));
}

TEST(Fitted, roofs_keep_their_form_and_move_to_the_scan) {
  const Plan truth = plan(house(), {roof(5, 0.9), wall(5), roof(5, 0.9), wall(5)}, 12);
  const Plan off = plan(house(), {roof(4.6, 0.7), wall(4.6), roof(5.2, 0.8), wall(5)}, 12);
  const auto made = refine::fitted(off, scan({truth}), {}, {});
  ASSERT_TRUE(made);
  EXPECT_THAT(pitched_sides(*made), ElementsAre(0, 2));
  EXPECT_LT(error(*made, truth), 0.05);
}

// A plan whose roof has a direction of its own: another roof has the walls' again.
TEST(Kinds, are_made_without_the_corner_edges_of_the_roof_before) {
  const Plan truth = plan(house(), {roof(5, 0.7), roof(5, 0.7), roof(5, 0.7), roof(5, 0.7)}, 12);
  const auto mesh = scan({truth});
  Plan before = flat_house();
  auto ring = extrude::with_corner_edge(before.outer, 1, normalised(geometry::Point2{1, 4}), 0);
  ASSERT_TRUE(ring);
  before.outer = *std::move(ring);
  const Plan made = roof_of(Kind::hip, before, mesh, {false, false, true, false, false});
  EXPECT_EQ(made.outer.points.size(), 4U);
  EXPECT_EQ(pitched_sides(made).size(), 4U);
  EXPECT_LT(error(made, truth), 0.06);
}

}  // namespace
