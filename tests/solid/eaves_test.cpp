// Overhanging eaves on solids: drawn houses whose soffits, volumes and corners were calculated by hand.
#include "mansard/solid/eaves.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "extrude/plans.hpp"
#include "mansard/extrude/extrude.hpp"
#include "mansard/solid/flat_roof.hpp"
#include "mansard/solid/levels.hpp"
#include "mansard/solid/solid.hpp"
#include "mansard/solid/unite.hpp"

namespace {

namespace extrude = mansard::extrude;
namespace geometry = mansard::geometry;
namespace model = mansard::model;
namespace solid = mansard::solid;

using namespace plans;
using model::FaceClass;
using model::LabelledSolid;
using solid::Eaves;
using testing::Each;
using testing::IsEmpty;

auto rectangle(double x0, double y0, double x1, double y1) -> Ring { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }

auto raised(const Plan& p) -> LabelledSolid {
  extrude::Options options;
  options.grid = 1e-4;
  LabelledSolid out{extrude::raise(p, options)->solid, {}};
  for (const auto& face : out.solid.faces)
    out.classes.push_back(face.kind == model::FaceKind::base ? FaceClass::ground
                          : face.normal.z > 0.2              ? FaceClass::roof
                                                             : FaceClass::wall);
  return out;
}

auto united(const std::vector<LabelledSolid>& parts) -> LabelledSolid {
  std::vector<const LabelledSolid*> all;
  for (const auto& part : parts) all.push_back(&part);
  auto made = solid::unite(all);
  EXPECT_EQ(made.solids.size(), 1U);
  return std::move(made.solids.front().model);
}

const Profile slope{{0, 0}, {0, 3}, {1, 4}}, gentle{{0, 0}, {0, 3}, {2, 4}}, upright{{0, 0}, {0, 30}};

/// 12 by 8 m; eaves at 3 m.
auto hipped() -> LabelledSolid { return raised(plan(box(12, 8), {slope})); }
/// Eaves in the south and north, gables in the west and east.
auto gabled() -> LabelledSolid { return raised(plan(box(12, 8), {slope, upright}, {0, 1, 0, 1})); }

auto around(const Ring& ring, double overhang) -> std::vector<Eaves> {
  std::vector<Eaves> out;
  for (std::size_t i = 0; i < ring.size(); ++i) out.push_back({ring[i], ring[(i + 1) % ring.size()], overhang});
  return out;
}

void expect_valid(const LabelledSolid& made) {
  const auto faults = solid::check(made.solid, solid::written_rules());
  EXPECT_THAT(faults, IsEmpty()) << faults.front().code << ": " << faults.front().message;
  EXPECT_EQ(made.classes.size(), made.solid.faces.size());
}

auto area_of(const LabelledSolid& made, FaceClass kind) -> double {
  double sum = 0;
  for (std::size_t f = 0; f < made.classes.size(); ++f)
    if (made.classes[f] == kind) sum += solid::area(made.solid, made.solid.faces[f]);
  return sum;
}
auto count_of(const LabelledSolid& made, FaceClass kind) -> std::ptrdiff_t {
  return std::ranges::count(made.classes, kind);
}
auto soffit_height(const LabelledSolid& made) -> double {
  for (std::size_t f = 0; f < made.classes.size(); ++f)
    if (made.classes[f] == FaceClass::soffit) return made.solid.vertices[made.solid.faces[f].loops[0][0]].z;
  return std::nan("");
}

TEST(WithEaves, go_around_a_hipped_house_with_one_soffit) {
  const auto before = hipped();
  const auto made = solid::with_eaves(before, around(box(12, 8), 0.4));
  expect_valid(made.model);
  EXPECT_THAT(made.made, Each(true));
  EXPECT_THAT(made.left, IsEmpty());
  EXPECT_EQ(count_of(made.model, FaceClass::soffit), 1);
  EXPECT_NEAR(area_of(made.model, FaceClass::soffit), 12.8 * 8.8 - 12 * 8, 1e-3);
  EXPECT_NEAR(soffit_height(made.model), 2.6, 1e-9);
  // A ring with a triangle of 0.4 by 0.4 m as its section: four prisms, and a quarter of a pyramid four times over.
  EXPECT_NEAR(solid::volume(made.model.solid) - solid::volume(before.solid), 0.08 * 40 + 4 * 0.4 * 0.4 * 0.4 / 3, 1e-3);
  EXPECT_EQ(made.model.solid.faces.size(), before.solid.faces.size() + 1);
  EXPECT_EQ(area_of(made.model, FaceClass::ground), area_of(before, FaceClass::ground));
}

TEST(WithEaves, end_in_the_planes_of_gables) {
  const auto before = gabled();
  auto wanted = around(box(12, 8), 0.5);
  const auto made = solid::with_eaves(before, wanted);
  expect_valid(made.model);
  EXPECT_EQ(made.made, (std::vector{true, false, true, false}));
  EXPECT_EQ(count_of(made.model, FaceClass::soffit), 2);
  EXPECT_NEAR(area_of(made.model, FaceClass::soffit), 2 * 12 * 0.5, 1e-3);
  EXPECT_NEAR(solid::volume(made.model.solid) - solid::volume(before.solid), 2 * 12 * 0.125, 1e-3);
  EXPECT_EQ(made.model.solid.faces.size(), before.solid.faces.size() + 2);

  // One side alone, and the two sides by unequal overhangs.
  wanted = {{{0, 0}, {12, 0}, 0.3}};
  const auto one = solid::with_eaves(before, wanted);
  expect_valid(one.model);
  EXPECT_NEAR(area_of(one.model, FaceClass::soffit), 12 * 0.3, 1e-3);
  wanted.push_back({{12, 8}, {0, 8}, 0.6});
  const auto unequal = solid::with_eaves(before, wanted);
  expect_valid(unequal.model);
  EXPECT_NEAR(area_of(unequal.model, FaceClass::soffit), 12 * 0.9, 1e-3);
}

TEST(WithEaves, have_one_soffit_where_pitches_differ) {
  // 45° in the south and north, half as steep in the west and east: the mean drop of 0.4 · 1 and 0.7 · ½ m.
  const auto before = raised(plan(box(12, 8), {slope, gentle}, {0, 1, 0, 1}));
  const auto made = solid::with_eaves(
      before, std::vector<Eaves>{
                  {{0, 0}, {12, 0}, 0.4}, {{12, 0}, {12, 8}, 0.72}, {{12, 8}, {0, 8}, 0.4}, {{0, 8}, {0, 0}, 0.72}});
  expect_valid(made.model);
  EXPECT_EQ(count_of(made.model, FaceClass::soffit), 1);
  const double drop = (24 * 0.4 + 16 * 0.36) / 40;
  EXPECT_NEAR(soffit_height(made.model), 3 - drop, 1e-4);
  EXPECT_NEAR(area_of(made.model, FaceClass::soffit), (12 + 4 * drop) * (8 + 2 * drop) - 96, 5e-3);
}

TEST(WithEaves, stop_upright_where_the_next_eaves_do_not_overhang) {
  const auto before = hipped();
  const auto made = solid::with_eaves(before, std::vector<Eaves>{{{0, 0}, {12, 0}, 0.4}});
  expect_valid(made.model);
  EXPECT_NEAR(area_of(made.model, FaceClass::soffit), 12 * 0.4, 1e-3);
  // An end at either side, and nothing else.
  EXPECT_EQ(made.model.solid.faces.size(), before.solid.faces.size() + 3);
  EXPECT_NEAR(solid::volume(made.model.solid) - solid::volume(before.solid), 12 * 0.08, 1e-3);
  // Beside eaves that hang far lower: each has its own soffit, or none.
  const auto stepped = solid::with_eaves(before, std::vector<Eaves>{{{0, 0}, {12, 0}, 0.4}, {{12, 0}, {12, 8}, 0.8}});
  expect_valid(stepped.model);
  EXPECT_TRUE(stepped.made[0] || stepped.made[1]);
}

TEST(WithEaves, turn_inward_at_a_courtyard_and_at_a_reflex_corner) {
  const Ring l{{0, 0}, {12, 0}, {12, 6}, {6, 6}, {6, 12}, {0, 12}};
  const auto before = raised(plan(l, {slope}));
  const auto made = solid::with_eaves(before, around(l, 0.4));
  expect_valid(made.model);
  EXPECT_THAT(made.made, Each(true));
  EXPECT_NEAR(area_of(made.model, FaceClass::soffit), 48 * 0.4 + 4 * 0.16, 1e-3);

  Plan court = plan(box(20, 20), {slope});
  Ring hole = rectangle(7, 7, 13, 13);
  std::ranges::reverse(hole);
  court.holes.push_back({hole, {0, 0, 0, 0}});
  const auto yard = raised(court);
  const auto inward = solid::with_eaves(yard, around(hole, 0.5));
  expect_valid(inward.model);
  EXPECT_THAT(inward.made, Each(true));
  EXPECT_NEAR(area_of(inward.model, FaceClass::soffit), 36 - 25, 1e-3);
}

TEST(WithEaves, run_against_a_wing_that_comes_forward) {
  // The house's south eaves end at the tower's west wall.
  const auto made_of = united({gabled(), raised(plan(rectangle(12, -4, 16, 8), {upright}, {}, 9))});
  const auto made = solid::with_eaves(made_of, std::vector<Eaves>{{{0, 0}, {12, 0}, 0.4}});
  expect_valid(made.model);
  EXPECT_NEAR(area_of(made.model, FaceClass::soffit), 12 * 0.4, 1e-3);
  // A wing that is 0.2 m deep leaves no room for them.
  const auto shallow = united({gabled(), raised(plan(rectangle(12, -0.2, 16, 8), {upright}, {}, 9))});
  const auto none = solid::with_eaves(shallow, std::vector<Eaves>{{{0, 0}, {12, 0}, 0.4}});
  expect_valid(none.model);
  EXPECT_EQ(none.made, std::vector{false});
  EXPECT_FALSE(none.left.empty());
  EXPECT_EQ(count_of(none.model, FaceClass::soffit), 0);
}

TEST(WithEaves, are_on_the_union_of_parts) {
  // A lower annex along the south wall: eaves above it, and none of the annex's own.
  const auto both = united({gabled(), raised(plan(rectangle(3, -2, 9, 0), {upright}, {}, 2))});
  const auto made = solid::with_eaves(both, std::vector<Eaves>{{{0, 0}, {12, 0}, 0.4}, {{12, 8}, {0, 8}, 0.4}});
  expect_valid(made.model);
  EXPECT_EQ(made.made, (std::vector{true, true}));
  EXPECT_NEAR(area_of(made.model, FaceClass::soffit), 2 * 12 * 0.4, 1e-3);
  // An annex up to 2.8 m is higher than the soffit, at 2.6 m: the eaves would run into its roof.
  const auto high = united({gabled(), raised(plan(rectangle(3, -2, 9, 0), {upright}, {}, 2.8))});
  const auto half = solid::with_eaves(high, std::vector<Eaves>{{{0, 0}, {12, 0}, 0.4}, {{12, 8}, {0, 8}, 0.4}});
  expect_valid(half.model);
  EXPECT_EQ(half.made, (std::vector{false, true}));
}

TEST(WithEaves, leave_party_walls_and_what_is_not_wanted_alone) {
  auto row = gabled();
  for (std::size_t f = 0; f < row.classes.size(); ++f)
    if (row.solid.faces[f].normal.y < -0.9) row.classes[f] = FaceClass::party_wall;
  const auto made = solid::with_eaves(row, around(box(12, 8), 0.4));
  expect_valid(made.model);
  EXPECT_EQ(made.made, (std::vector{false, false, true, false}));
  const auto none = solid::with_eaves(row, std::vector<Eaves>{{{0, 1}, {12, 1}, 0.4}, {{0, 8}, {12, 8}, 0.4}});
  EXPECT_EQ(count_of(none.model, FaceClass::soffit), 0);  // beside the wall; and with the building on the right
  EXPECT_EQ(none.model.solid.faces.size(), row.solid.faces.size());
}

TEST(WithEaves, can_be_taken_off_again) {
  const Ring l{{0, 0}, {12, 0}, {12, 6}, {6, 6}, {6, 12}, {0, 12}};
  const auto wing = united({gabled(), raised(plan(rectangle(12, -4, 16, 8), {upright}, {}, 9))});
  struct Case {
    LabelledSolid solid;
    std::vector<Eaves> wanted;
  };
  for (const auto& [before, wanted] :
       {Case{hipped(), around(box(12, 8), 0.4)}, Case{gabled(), around(box(12, 8), 0.5)},
        Case{hipped(), {{{0, 0}, {12, 0}, 0.4}}}, Case{raised(plan(l, {slope})), around(l, 0.4)},
        Case{wing, {{{0, 0}, {12, 0}, 0.4}}}}) {
    const auto made = solid::with_eaves(before, wanted);
    ASSERT_GT(count_of(made.model, FaceClass::soffit), 0);
    const auto bare = solid::without_eaves(made.model);
    expect_valid(bare);
    EXPECT_EQ(count_of(bare, FaceClass::soffit), 0);
    EXPECT_EQ(bare.solid.faces.size(), before.solid.faces.size());
    EXPECT_EQ(bare.solid.vertices.size(), before.solid.vertices.size());
    EXPECT_NEAR(solid::volume(bare.solid), solid::volume(before.solid), 0.01);
  }
  EXPECT_EQ(solid::without_eaves(hipped()).solid.vertices, hipped().solid.vertices);
}

TEST(WithEaves, give_way_at_coarser_levels) {
  const auto both = united({gabled(), raised(plan(rectangle(12, -4, 16, 8), {upright}, {}, 12))});
  const auto made = solid::with_eaves(both, std::vector<Eaves>{{{0, 0}, {12, 0}, 0.4}});
  ASSERT_EQ(made.made, std::vector{true});
  const auto pieces = solid::flat_pieces(made.model), plain = solid::flat_pieces(both);
  expect_valid(pieces);
  ASSERT_FALSE(plain.solid.faces.empty());
  EXPECT_EQ(pieces.solid.faces.size(), plain.solid.faces.size());
  EXPECT_NEAR(solid::volume(pieces.solid), solid::volume(plain.solid), 0.01);
  EXPECT_EQ(count_of(solid::main_roofs(made.model), FaceClass::soffit), 0);
  EXPECT_FALSE(solid::flat_roof(made.model, 5).solid.faces.empty());
}

TEST(WithEaves, are_the_same_after_a_shift_by_whole_metres) {
  const auto here = hipped();
  auto there = here;
  const geometry::Point3 by{84801, 447402, -3};
  for (auto& v : there.solid.vertices)
    v = {std::round((v.x + by.x) * 1e4) / 1e4, std::round((v.y + by.y) * 1e4) / 1e4,
         std::round((v.z + by.z) * 1e4) / 1e4};
  auto wanted = around(box(12, 8), 0.37);
  const auto made = solid::with_eaves(here, wanted);
  for (auto& one : wanted) one.from = one.from + xy(by), one.to = one.to + xy(by);
  const auto moved = solid::with_eaves(there, wanted);
  ASSERT_EQ(made.model.solid.vertices.size(), moved.model.solid.vertices.size());
  for (std::size_t v = 0; v < made.model.solid.vertices.size(); ++v) {
    const auto a = made.model.solid.vertices[v] + by, b = moved.model.solid.vertices[v];
    EXPECT_EQ(std::llround(a.x * 1e4), std::llround(b.x * 1e4));
    EXPECT_EQ(std::llround(a.y * 1e4), std::llround(b.y * 1e4));
    EXPECT_EQ(std::llround(a.z * 1e4), std::llround(b.z * 1e4));
  }
}

}  // namespace
