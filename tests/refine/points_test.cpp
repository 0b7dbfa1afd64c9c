// Scans that consist of points.
#include "mansard/refine/law.hpp"
#include "mansard/refine/refine.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "scans.hpp"

namespace {

using namespace scans;
using testing::ElementsAre;

/// The surface of a scan, and points at random places of it, so many a square metre; a share of them is far below.
auto pointed(const std::vector<Plan>& plans, double density, double strays = 0, std::uint64_t seed = 3) -> rays::Scene {
  auto mesh = scanned(plans);
  geometry::Mesh solids;
  for (const auto& p : plans) {
    const auto raised = extrude::raise(p);
    const auto first = static_cast<std::uint32_t>(solids.vertices.size());
    solids.vertices.insert(solids.vertices.end(), raised->solid.vertices.begin(), raised->solid.vertices.end());
    const auto pieces = solid::triangulate(raised->solid);
    for (const auto& t : pieces->triangles) solids.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  const rays::Scene truth(solids);
  const auto box = geometry::Box3::of(mesh.vertices).plan();
  base::Random random(seed);
  const auto count = static_cast<std::size_t>(density * (box.most.x - box.least.x) * (box.most.y - box.least.y));
  for (std::size_t i = 0; i < count; ++i) {
    const Point2 at{random.uniform(box.least.x, box.most.x), random.uniform(box.least.y, box.most.y)};
    const bool stray = random.uniform(0, 1) < strays;
    const double off = random.uniform(-0.05, 0.05);
    mesh.points.push_back({at.x, at.y, stray ? ground : truth.top(at).value_or(ground) + off});
  }
  return rays::Scene(std::move(mesh));
}

auto options_of(double density) -> refine::Options {
  model::Accuracy scan;
  scan.noise = 0.03;
  scan.correlated_area = scan.point_area = 1 / density;
  scan.spacing = std::sqrt(1 / density);
  return refine::decided_by({}, scan);
}

auto refined(const std::vector<refine::Draft>& drafts, const rays::Scene& mesh, const refine::Options& options)
    -> std::vector<refine::Part> {
  auto out = refine::refine(drafts, mesh, options, {});
  EXPECT_TRUE(out.failed.empty());
  for (const auto& part : out.parts) EXPECT_THAT(solid::check(part.raised.solid), testing::IsEmpty());
  return std::move(out.parts);
}

auto house() -> geometry::Ring { return rectangle(10, 20, 12, 8); }
auto gabled() -> Plan { return plan(house(), {roof(5, 0.9), wall(5), roof(5, 0.9), wall(5)}, 12); }

TEST(RefinePoints, finds_a_gable_at_any_density) {
  for (const double density : {3.0, 10.0, 30.0}) {
    const auto parts = refined({flat_draft(house(), 6)}, pointed({gabled()}, density), options_of(density));
    ASSERT_EQ(parts.size(), 1U) << density << " points/m²";
    EXPECT_THAT(pitched_sides(parts[0].plan), ElementsAre(0, 2));
    EXPECT_LT(difference(parts, {gabled()}), 0.04) << density << " points/m²";
  }
}

TEST(RefinePoints, is_not_led_astray_by_points_of_something_else) {
  // One in thirty, far below the roof: a squared error would be 2 m²·m² for each of some seventy points.
  const auto parts = refined({flat_draft(house(), 6)}, pointed({gabled()}, 20, 0.03), options_of(20));
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_THAT(pitched_sides(parts[0].plan), ElementsAre(0, 2));
  EXPECT_LT(difference(parts, {gabled()}), 0.04);
}

TEST(RefinePoints, has_the_wall_between_two_drafts_where_the_points_have_it) {
  const Plan low = plan(rectangle(10, 20, 5, 8), std::vector<Profile>(4, wall(6)), 6);
  const Plan high = plan(rectangle(15, 20, 7, 8), std::vector<Profile>(4, wall(9)), 9);
  for (const double off : {-0.6, 0.4, 0.7}) {
    const std::vector<refine::Draft> drafts{flat_draft(rectangle(10, 20, 5 + off, 8), 6),
                                            flat_draft(rectangle(15 + off, 20, 7 - off, 8), 9)};
    const auto parts = refined(drafts, pointed({low, high}, 12), options_of(12));
    ASSERT_EQ(parts.size(), 2U) << off;
    EXPECT_LT(difference(parts, {low, high}, 0.15), 0.03) << off;
    if (off < 0) continue;  // the high part has a terrace of 6 m there, which is as good
    for (const auto& part : parts) {
      const auto box = geometry::bounds(model::polygon_of(part.plan).outer);
      const bool is_low = std::abs(box.least.x - 10) < 1e-6;
      EXPECT_NEAR(is_low ? box.most.x : box.least.x, 15, 0.1) << off;
      EXPECT_NEAR(part.plan.cap, is_low ? 6 : 9, 0.03);
    }
  }
}

TEST(RefinePoints, keeps_the_draft_over_which_there_is_no_point) {
  auto mesh = scanned({gabled()});
  mesh.points = {{100, 100, 3}};
  const auto draft = flat_draft(house(), 6);
  const auto parts = refined({draft}, rays::Scene(mesh), options_of(10));
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].plan, draft.plan);
}

TEST(RefinePoints, has_a_step_that_the_planes_show_where_ground_is_seen_along_the_outline) {
  // Two flat roofs, 0.4 m apart. Ground points within the outline, 12 m below, are a hundred times the step's squares.
  const Plan low = plan(rectangle(10, 20, 5, 8), std::vector<Profile>(4, wall(12)), 12);
  const Plan high = plan(rectangle(15, 20, 7, 8), std::vector<Profile>(4, wall(12.4)), 12.4);
  const auto parts = refined({flat_draft(rectangle(9.7, 20, 12.3, 8), 12)}, pointed({low, high}, 20), options_of(20));
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_NEAR(std::min(parts[0].plan.cap, parts[1].plan.cap), 12, 0.03);
  EXPECT_NEAR(std::max(parts[0].plan.cap, parts[1].plan.cap), 12.4, 0.03);
}

TEST(RefinePoints, has_a_roof_whose_sides_are_unlike) {
  // A steep foot on one side, a flat pitch on the other, walls at the ends.
  const Profile foot{{0, 0}, {0, 5}, {1.2, 8}, {2.2, 8.4}};
  const Plan unlike = plan(house(), {foot, wall(5), roof(7, 0.35), wall(5)}, 14);
  for (const double density : {5.0, 20.0}) {
    const auto parts = refined({flat_draft(house(), 6)}, pointed({unlike}, density), options_of(density));
    ASSERT_EQ(parts.size(), 1U) << density;
    EXPECT_THAT(pitched_sides(parts[0].plan), ElementsAre(0, 2)) << density;
    EXPECT_LT(difference(parts, {unlike}, 0.3), 0.02) << density;
  }
}

TEST(RefinePoints, has_no_part_where_many_points_are_of_the_ground_and_many_of_the_roof) {
  // A light well under a net, a roof that is seen through: no height suits most of the points over it.
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    auto mesh = scanned({plan(house(), std::vector<Profile>(4, wall(9)), 9)});
    base::Random random(seed);
    for (int i = 0; i < 600; ++i) {
      const Point2 at{random.uniform(8, 24), random.uniform(18, 30)};
      const bool over = at.x > 10 && at.x < 22 && at.y > 20 && at.y < 28;
      const bool through = at.x > 14 && at.x < 17.5 && at.y > 22 && at.y < 25.5 && random.uniform(0, 1) < 0.6;
      mesh.points.push_back({at.x, at.y, ground + (over && !through ? 9 : 0) + random.uniform(-0.05, 0.05)});
    }
    const auto parts = refined({flat_draft(house(), 9)}, rays::Scene(std::move(mesh)), options_of(3));
    ASSERT_EQ(parts.size(), 1U) << seed;
    EXPECT_NEAR(parts[0].plan.cap, 9, 0.03) << seed;
  }
}

TEST(RefinePoints, are_the_law_s_with_no_blur_and_a_margin_of_half_a_spacing) {
  const auto options = options_of(4);
  EXPECT_EQ(options.samples.point_area, 0.25);
  EXPECT_EQ(options.samples.blur, 0);
  EXPECT_NEAR(options.margin, std::hypot(2.5 * 0.03, 0.25), 1e-12);
  EXPECT_NEAR(options.samples.stray, 10 * options.detail, 1e-12);
  EXPECT_EQ(options_of(1).margin, 0.4) << "at most";
}

}  // namespace
