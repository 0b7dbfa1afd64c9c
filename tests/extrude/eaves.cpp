// Overhanging eaves: the one outward step.
#include <gmock/gmock.h>

#include "mansard/solid/half_edges.hpp"
#include "plans.hpp"

namespace {

namespace extrude = mansard::extrude;
namespace solid = mansard::solid;

namespace model = mansard::model;

using namespace plans;
using model::FaceKind;
using solid::LineKind;

auto raised(const Plan& p, double overhang) -> extrude::Raised {
  extrude::Options options;
  options.overhang = overhang;
  auto result = extrude::raise(p, options);
  EXPECT_TRUE(result);
  EXPECT_EQ(faults(result->solid), "");
  return std::move(*result);
}
auto lines_of(const model::Solid& solid, LineKind kind) -> std::size_t {
  const auto lines = solid::lines(solid);
  EXPECT_TRUE(lines);
  return static_cast<std::size_t>(std::ranges::count(*lines, kind, &solid::Line::kind));
}
auto soffit_area(const model::Solid& solid) -> double {
  double sum = 0;
  for (const auto& face : solid.faces)
    if (face.kind == FaceKind::soffit) sum += solid::area(solid, face);
  return sum;
}

//        /\            /\          roof at 45°, eaves at 3 m: half a metre out
//       /  \    -->   /  \         is half a metre down
//      |    |       _/    \_
//      |    |        |    |
TEST(Eaves, of_a_hip_go_out_and_down_along_the_roof) {
  const Plan p = plan(box(8, 10), {hip});
  const auto plain = raised(p, 0).solid, wide = raised(p, 0.5).solid;
  EXPECT_EQ(count(plain, FaceKind::soffit), 0U);
  EXPECT_EQ(count(wide, FaceKind::soffit), 1U);
  EXPECT_NEAR(soffit_area(wide), 9 * 11 - 8 * 10, 1e-9);
  // A triangle of 0.5 m by 0.5 m around, and a pyramid's third of a cube of it at each corner.
  EXPECT_NEAR(solid::volume(wide) - solid::volume(plain), 36 * 0.125 + 4 * 0.125 / 3, 1e-6);
  for (const auto& face : wide.faces) {
    if (face.kind != FaceKind::soffit) continue;
    for (const auto& loop : face.loops)
      for (const auto v : loop) EXPECT_DOUBLE_EQ(wide.vertices[v].z, 2.5);
  }
  EXPECT_EQ(lines_of(wide, LineKind::eave), 4U);
  EXPECT_EQ(lines_of(wide, LineKind::soffit_line), 4U);
}

TEST(Eaves, beside_a_gable_end_flush_with_its_wall) {
  const auto solid = raised(plan(box(8, 10), {hip, wall}, {1, 0, 1, 0}), 0.5).solid;
  EXPECT_EQ(count(solid, FaceKind::soffit), 2U);
  EXPECT_NEAR(soffit_area(solid), 2 * 0.5 * 10, 1e-9);
  double least = 1e9, most = -1e9;
  for (const Point3 v : solid.vertices) {
    least = std::min(least, v.y);
    most = std::max(most, v.y);
  }
  EXPECT_DOUBLE_EQ(least, 0);  // gable ends stand where they stood
  EXPECT_DOUBLE_EQ(most, 10);
  EXPECT_EQ(lines_of(solid, LineKind::verge), 4U);
}

TEST(Eaves, of_two_pitches_share_one_soffit) {
  const Profile steep{{0, 0}, {0, 3}, {1, 6}};
  const auto solid = raised(plan(box(8, 10), {hip, steep}, {0, 1, 0, 1}), 0.6).solid;
  EXPECT_EQ(count(solid, FaceKind::soffit), 1U);
  EXPECT_NEAR(soffit_area(solid), (10 + 2 * 0.6) * (8 + 2 * 0.2) - 80, 1e-3);
}

TEST(Eaves, stand_over_a_courtyard_and_round_a_reflex_corner) {
  const Ring l{{0, 0}, {10, 0}, {10, 4}, {4, 4}, {4, 10}, {0, 10}};
  EXPECT_EQ(lines_of(raised(plan(l, {hip}), 0.5).solid, LineKind::valley), 1U);
  const Plan court = plan(box(20, 20), {hip}, {}, 100, {turned_in({{7, 7}, {13, 7}, {13, 13}, {7, 13}})});
  EXPECT_NEAR(soffit_area(raised(court, 0.6).solid), (21.2 * 21.2 - 400) + (36 - 4.8 * 4.8), 1e-3);
}

TEST(Eaves, that_would_close_a_courtyard_are_left_off_and_it_is_said) {
  const auto house = raised(plan(box(20, 20), {hip}, {}, 100, {turned_in({{9, 9}, {10, 9}, {10, 10}, {9, 10}})}), 0.6);
  EXPECT_EQ(count(house.solid, FaceKind::soffit), 0U);
  EXPECT_EQ(house.outcome, extrude::Outcome::full);
  ASSERT_EQ(house.warnings.size(), 1U);
  EXPECT_EQ(house.warnings[0].code, "extrude-overhang");
}

TEST(Eaves, of_a_sharp_corner_do_not_meet_far_outside) {
  const auto house = raised(plan({{0, 0}, {30, 0}, {0, 4}}, {hip}), 0.5);
  EXPECT_EQ(count(house.solid, FaceKind::soffit), 0U);
  ASSERT_FALSE(house.warnings.empty());
  EXPECT_EQ(house.warnings[0].code, "extrude-overhang");
}

TEST(Eaves, are_none_under_a_flat_roof_without_a_warning) {
  const auto flat = raised(plan(box(8, 10), {wall}, {}, 6), 0.5), cut = raised(plan(box(8, 10), {hip}, {}, 3), 0.5);
  for (const auto* house : {&flat, &cut}) {
    EXPECT_EQ(count(house->solid, FaceKind::soffit), 0U);
    EXPECT_TRUE(house->warnings.empty());
  }
}

TEST(Eaves, never_cost_a_building_its_roof) {
  std::size_t with = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    const Plan p = random_plan(seed);
    const auto plain = raised(p, 0), wide = raised(p, 0.3);
    EXPECT_EQ(wide.outcome, plain.outcome);
    const bool out = count(wide.solid, FaceKind::soffit) > 0;
    with += out;
    if (out) {
      EXPECT_GT(solid::volume(wide.solid), solid::volume(plain.solid));
    } else {
      EXPECT_EQ(wide.solid.vertices, plain.solid.vertices);
    }
  }
  EXPECT_GT(with, 30U);
}

}  // namespace
