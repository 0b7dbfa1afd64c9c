#include "mansard/refine/refine.hpp"
#include "mansard/refine/law.hpp"
#include "mansard/solid/solid.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "scans.hpp"

namespace {

namespace geometry = mansard::geometry;
namespace solid = mansard::solid;

namespace model = mansard::model;

using namespace scans;
using refine::Effort;
using refine::Options;
using testing::ElementsAre;

auto house() -> geometry::Ring { return rectangle(10, 20, 12, 8); }
auto gabled() -> Plan { return plan(house(), {roof(5, 0.9), wall(5), roof(5, 0.9), wall(5)}, 12); }
auto hipped() -> Plan { return plan(house(), {roof(5, 0.9), roof(5, 0.9), roof(5, 0.9), roof(5, 0.9)}, 12); }
auto mansard_roofed() -> Plan {
  const Profile steep{{0, 0}, {0, 5}, {1, 7.5}, {2, 7.9}};
  return plan(house(), {steep, wall(5), steep, wall(5)}, 12);
}

auto with(Effort effort) -> Options {
  Options options;
  options.effort = effort;
  return options;
}

auto refined(const std::vector<refine::Draft>& drafts, const rays::Scene& mesh, const Options& options = {})
    -> std::vector<refine::Part> {
  auto out = refine::refine(drafts, mesh, options, {});
  EXPECT_TRUE(out.failed.empty());
  for (const auto& part : out.parts) EXPECT_THAT(solid::check(part.raised.solid), testing::IsEmpty());
  return std::move(out.parts);
}

TEST(Refine, finds_a_gable_where_the_draft_is_flat) {
  const auto parts = refined({flat_draft(house(), 6)}, scan({gabled()}), with(Effort::planes));
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_THAT(pitched_sides(parts[0].plan), ElementsAre(0, 2));
  EXPECT_NEAR(top_of(parts[0].raised.solid), ground + 5 + 0.9 * 4, 0.05);
  EXPECT_LT(difference(parts, {gabled()}), 0.03);
}

TEST(Refine, finds_a_hip_where_the_draft_is_a_gable) {
  auto draft = flat_draft(house(), 6);
  draft.plan = gabled();
  draft.caps = {12};
  const auto parts = refined({draft}, scan({hipped()}), with(Effort::planes));
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_THAT(pitched_sides(parts[0].plan), ElementsAre(0, 1, 2, 3));
  EXPECT_LT(difference(parts, {hipped()}), 0.03);
}

TEST(Refine, moves_both_pitches_of_a_mansard) {
  auto draft = flat_draft(house(), 6);
  const Profile off{{0, 0}, {0, 4.4}, {1.4, 7.2}, {2.4, 7.8}};
  draft.plan = plan(house(), {off, wall(5), off, wall(5)}, 12);
  draft.caps = {12};
  const auto parts = refined({draft}, scan({mansard_roofed()}), with(Effort::planes));
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_LT(difference(parts, {mansard_roofed()}), 0.05);
}

TEST(Refine, leaves_the_strip_between_a_wall_and_a_wider_footprint_to_the_roof) {
  // A surface between the samples of a scan from above falls from the eaves to the ground within the footprint.
  model::Accuracy accuracy;
  accuracy.noise = 0.015, accuracy.correlated_area = 0.15, accuracy.spacing = 0.2, accuracy.blur = 0;
  accuracy.edge_noise = 0.1;
  auto draft = flat_draft(rectangle(9.7, 20, 12.5, 8), 5);
  const Profile foot{{0, 0}, {0, 3.6}, {0.3, 5}};
  draft.alternatives.assign(4, {foot});
  const auto flat = plan(house(), {wall(5), wall(5), wall(5), wall(5)}, 5);
  const auto parts = refined({draft}, scan({flat}, 0.02), refine::decided_by({}, accuracy));
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_THAT(pitched_sides(parts[0].plan), ElementsAre());
}

TEST(Refine, ends_a_roof_at_the_level_the_scan_shows) {
  Plan cut = hipped();
  cut.cap = 7;
  const auto parts = refined({flat_draft(house(), 6)}, scan({cut}), with(Effort::planes));
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_NEAR(top_of(parts[0].raised.solid), ground + 7, 0.04);
  EXPECT_LT(difference(parts, {cut}), 0.04);
}

TEST(Refine, leaves_profiles_alone_when_only_caps_may_change) {
  auto draft = flat_draft(house(), 6);
  draft.caps = {6, 7.2, 9};
  const auto parts = refined({draft}, scan({gabled()}), with(Effort::caps));
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].plan.profiles, draft.plan.profiles);
  EXPECT_EQ(parts[0].plan.cap, 7.2);  // the mean of the gable's heights is 6.8
}

TEST(Refine, pays_no_more_for_faces_than_they_are_worth) {
  Options dear = with(Effort::planes);
  dear.face_price = 500;
  const auto parts = refined({flat_draft(house(), 6)}, scan({gabled()}), dear);
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_TRUE(pitched_sides(parts[0].plan).empty());
}

TEST(Refine, joins_two_parts_under_one_roof) {
  const std::vector<refine::Draft> halves{flat_draft(rectangle(10, 20, 5, 8), 6),
                                          flat_draft(rectangle(15, 20, 7, 8), 6)};
  const auto parts = refined(halves, scan({gabled()}));
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_NEAR(geometry::area(model::polygon_of(parts[0].plan)), 96, 1e-6);
  EXPECT_LT(difference(parts, {gabled()}), 0.03);
  EXPECT_FALSE(parts[0].changes.empty());
}

TEST(Refine, never_joins_what_belongs_to_two_owners) {
  const std::vector<refine::Draft> halves{flat_draft(rectangle(10, 20, 5, 8), 6, 1),
                                          flat_draft(rectangle(15, 20, 7, 8), 6, 2)};
  EXPECT_EQ(refined(halves, scan({gabled()})).size(), 2U);
}

TEST(Refine, keeps_two_parts_of_different_height) {
  const Plan low = plan(rectangle(10, 20, 5, 8), std::vector<Profile>(4, wall(6)), 6);
  const Plan high = plan(rectangle(15, 20, 7, 8), std::vector<Profile>(4, wall(9)), 9);
  const auto parts =
      refined({flat_draft(rectangle(10, 20, 5, 8), 6), flat_draft(rectangle(15, 20, 7, 8), 9)}, scan({low, high}));
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_NEAR(parts[0].plan.cap, 6, 0.03);
  EXPECT_NEAR(parts[1].plan.cap, 9, 0.03);
}

TEST(Refine, gives_a_tower_a_plan_of_its_own) {
  const Plan tower = plan(rectangle(13, 22, 4, 3), std::vector<Profile>(4, wall(9)), 9);
  Plan around = plan(house(), std::vector<Profile>(4, wall(6)), 6);
  const auto parts = refined({flat_draft(house(), 6)}, scan({around, tower}));
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].plan.holes.size(), 1U);
  EXPECT_NEAR(geometry::area(model::polygon_of(parts[1].plan)), 12, 1.5);  // the scan slopes 0.2 m outwards
  EXPECT_NEAR(parts[0].plan.cap, 6, 0.03);
  EXPECT_NEAR(parts[1].plan.cap, 9, 0.05);
  double covered = 0;
  for (const auto& part : parts) covered += geometry::area(model::polygon_of(part.plan));
  EXPECT_NEAR(covered, 96, 1e-6);
}

TEST(Refine, moves_a_wall_that_stands_in_the_wrong_place) {
  const Plan low = plan(rectangle(10, 20, 5, 8), std::vector<Profile>(4, wall(6)), 6);
  const Plan high = plan(rectangle(15, 20, 7, 8), std::vector<Profile>(4, wall(9)), 9);
  const auto parts = refined({flat_draft(rectangle(10, 20, 6.2, 8), 6), flat_draft(rectangle(16.2, 20, 5.8, 8), 9)},
                             scan({low, high}));
  ASSERT_EQ(parts.size(), 2U);
  std::vector<double> areas;
  for (const auto& part : parts) areas.push_back(geometry::area(model::polygon_of(part.plan)));
  std::ranges::sort(areas);
  EXPECT_NEAR(areas[0], 40, 1.6);  // the wall within 0.2 m
  EXPECT_NEAR(areas[1], 56, 1.6);
}

TEST(Refine, keeps_the_draft_where_nothing_was_seen) {
  geometry::Mesh elsewhere;
  elsewhere.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  elsewhere.triangles = {{0, 1, 2}};
  const auto draft = flat_draft(house(), 6);
  const auto parts = refined({draft}, rays::Scene(elsewhere));
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].plan, draft.plan);
}

TEST(Refine, ends_at_the_bound_of_its_work_and_says_so) {
  const std::vector<refine::Draft> halves{flat_draft(rectangle(10, 20, 5, 8), 6, 4),
                                          flat_draft(rectangle(15, 20, 7, 8), 6, 4)};
  const auto mesh = scan({gabled()});
  const auto met_bound = [](const refine::Refined& made) {
    EXPECT_EQ(made.searches.size(), 1U);
    return !made.searches.empty() && made.searches.front().second.met_bound;
  };
  const auto unbounded = refine::refine(halves, mesh, {}, {});
  EXPECT_FALSE(met_bound(unbounded));
  const auto& [owner, search] = unbounded.searches.front();
  EXPECT_EQ(owner, 4U);
  EXPECT_EQ(search.corners, 8U);
  EXPECT_GT(search.samples, 0U);
  EXPECT_EQ(search.bound, 10000 * (search.samples + 100 * search.corners));
  EXPECT_GT(search.work, search.samples);
  EXPECT_LT(search.work, search.bound);
  Options bounded;
  bounded.search.most_work = 1;
  const auto out = refine::refine(halves, mesh, bounded, {});
  EXPECT_TRUE(met_bound(out));
  EXPECT_LT(out.searches.front().second.work, search.work);
  EXPECT_EQ(out.parts.size(), 2U);  // not joined, and both raised
  EXPECT_TRUE(out.failed.empty());
}

TEST(Refine, asks_for_a_bounded_number_of_roofs) {
  auto draft = flat_draft(house(), 6);
  draft.alternatives.assign(4, {roof(5, 0.3), roof(5, 0.5), roof(5, 0.7)});
  const auto mesh = scan({plan(house(), {roof(4, 0.3), wall(7), roof(6, 0.9), roof(5, 0.6)}, 8)});
  EXPECT_FALSE(refine::refine(std::span(&draft, 1), mesh, {}, {}).searches.front().second.met_bound);
  Options bounded;
  bounded.search.most_roofs = 1;
  EXPECT_TRUE(refine::refine(std::span(&draft, 1), mesh, bounded, {}).searches.front().second.met_bound);
}

TEST(Refine, gives_the_same_at_any_thread_count) {
  std::vector<refine::Draft> drafts;
  std::vector<Plan> truth;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto ring = rectangle(20.0 * static_cast<double>(i), 0, 11, 7 + 0.5 * static_cast<double>(i));
    drafts.push_back(flat_draft(ring, 6, i));
    truth.push_back(plan(ring, {roof(5, 0.7), roof(5, 1.1), roof(5, 0.7), wall(5)}, 12));
  }
  const auto mesh = scan(truth);
  base::limit_threads(1);
  const auto one = refined(drafts, mesh);
  base::limit_threads(0);
  const auto all = refined(drafts, mesh);
  ASSERT_EQ(one.size(), all.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i].plan, all[i].plan);
}

}  // namespace
