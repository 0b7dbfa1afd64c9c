#include "lab/simulate/detail/lots.hpp"
#include "mansard/solid/solid.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mansard/extrude/extrude.hpp"

namespace mansard::simulate::detail {
namespace {

/// 8 m along the street and 10 m deep, 6 m to the eaves; front, right, back, left.
auto lot(Roof roof, double pitch, std::vector<bool> upright) -> Lot {
  Lot out;
  out.polygon.outer = {{0, 0}, {8, 0}, {8, 10}, {0, 10}};
  out.roof = roof;
  out.pitch = pitch;
  out.upright = std::move(upright);
  return out;
}

/// The highest point and the volume over ground at z = 2.
struct Size {
  double top = 0, volume = 0;
};
auto raised(const Lot& of) -> Size {
  const auto plan = plan_of(of, 2);
  EXPECT_TRUE(plan);
  const auto solid = extrude::raise(*plan);
  EXPECT_TRUE(solid);
  EXPECT_EQ(solid->outcome, extrude::Outcome::full);
  Size size{0, solid::volume(solid->solid)};
  for (const auto v : solid->solid.vertices) size.top = std::max(size.top, v.z);
  return size;
}

TEST(PlanOf, ends_a_flat_roof_at_the_eaves) {
  const auto size = raised(lot(Roof::flat, 0.5, {}));
  EXPECT_NEAR(size.top, 8, 1e-4);
  EXPECT_NEAR(size.volume, 480, 1e-2);
}

TEST(PlanOf, raises_a_gable_between_two_upright_sides) {
  const auto size = raised(lot(Roof::pitched, std::atan(0.8), {false, true, false, true}));
  EXPECT_NEAR(size.top, 8 + 4, 1e-3);
  EXPECT_NEAR(size.volume, 480 + 8 * 10 * 4 / 2, 1e-1);
}

TEST(PlanOf, raises_one_plane_over_a_mono_roof) {
  const auto size = raised(lot(Roof::mono, std::atan(0.3), {true, true, false, true}));
  EXPECT_NEAR(size.top, 8 + 3, 1e-3);
  EXPECT_NEAR(size.volume, 480 + 8 * 10 * 3 / 2, 1e-1);
}

TEST(PlanOf, ends_a_steep_roof_at_the_greatest_rise) {
  EXPECT_NEAR(raised(lot(Roof::pitched, std::atan(2.0), {false, true, false, true})).top, 8 + most_rise, 1e-3);
}

TEST(PlanOf, breaks_the_pitch_of_a_mansard_roof) {
  // 2.5 m over 0.91 m, and 0.4 over each metre that is left of half the depth.
  const auto size = raised(lot(Roof::mansard, std::atan(0.4), {false, true, false, true}));
  EXPECT_NEAR(size.top, 8 + 2.5 + 0.4 * (5 - 0.91), 1e-3);
}

TEST(PlanOf, sets_the_roof_back_behind_a_gutter) {
  auto with = lot(Roof::pitched, std::atan(0.8), {false, true, false, true});
  with.gutter = true;
  EXPECT_NEAR(raised(with).top, 8 + 0.8 * 4.7, 1e-3);
}

TEST(PlanOf, stands_a_part_on_another_one) {
  auto upper = lot(Roof::flat, 0, {});
  upper.base = 4;
  EXPECT_NEAR(plan_of(upper, 2)->base, 6, 1e-12);
  EXPECT_NEAR(raised(upper).volume, 160, 1e-2);
}

TEST(WithParapet, puts_a_ring_on_a_flat_roof) {
  auto flat = lot(Roof::flat, 0, {});
  flat.parapet = true;
  const auto lots = with_parapet(flat).value();
  ASSERT_EQ(lots.size(), 2U);
  EXPECT_EQ(lots[1].role, "parapet");
  EXPECT_EQ(lots[1].base, flat.eaves);
  EXPECT_NEAR(geometry::area(lots[1].polygon), 80 - 7.4 * 9.4, 1e-9);
}

TEST(WithParapet, puts_rings_around_courtyards_too) {
  auto flat = lot(Roof::flat, 0, {});
  flat.parapet = true;
  flat.polygon.holes = {{{3, 3}, {3, 6}, {5, 6}, {5, 3}}};
  EXPECT_EQ(with_parapet(flat).value().size(), 3U);
}

TEST(WithParapet, leaves_other_roofs_and_narrow_lots_as_they_are) {
  auto pitched = lot(Roof::pitched, 0.5, {false, true, false, true});
  pitched.parapet = true;
  EXPECT_EQ(with_parapet(pitched).value().size(), 1U);
  auto narrow = lot(Roof::flat, 0, {});
  narrow.parapet = true;
  narrow.polygon.outer = {{0, 0}, {8, 0}, {8, 0.5}, {0, 0.5}};
  EXPECT_EQ(with_parapet(narrow).value().size(), 1U);
}

TEST(WithParapet, fails_where_there_can_be_no_ring) {
  auto broken = lot(Roof::flat, 0, {});
  broken.parapet = true;
  broken.polygon.outer[1].x = std::numeric_limits<double>::quiet_NaN();
  const auto lots = with_parapet(broken);
  ASSERT_FALSE(lots);
  EXPECT_EQ(lots.error().code, "geometry-boolean");
}

}  // namespace
}  // namespace mansard::simulate::detail
