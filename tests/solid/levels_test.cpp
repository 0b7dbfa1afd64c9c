#include "mansard/solid/levels.hpp"

#include <gmock/gmock.h>

#include "extrude/plans.hpp"
#include "mansard/extrude/extrude.hpp"
#include "mansard/solid/flat_roof.hpp"
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
using testing::DoubleNear;
using testing::IsEmpty;

auto labelled(const model::Solid& made) -> LabelledSolid {
  LabelledSolid out{made, {}};
  for (const auto& face : made.faces)
    out.classes.push_back(face.kind == model::FaceKind::base ? FaceClass::ground
                          : face.normal.z > 0.2              ? FaceClass::roof
                                                             : FaceClass::wall);
  return out;
}

auto raised(Plan p, double base = 0) -> LabelledSolid {
  p.base = base;
  extrude::Options options;
  options.grid = 1e-4;
  return labelled(extrude::raise(p, options)->solid);
}

auto united(const std::vector<LabelledSolid>& parts) -> LabelledSolid {
  std::vector<const LabelledSolid*> all;
  for (const auto& part : parts) all.push_back(&part);
  auto made = solid::unite(all);
  EXPECT_EQ(made.solids.size(), 1U);
  // Where parts overlap the higher one keeps the ground, as a chimney on a roof does.
  for (const auto& warning : made.warnings) EXPECT_EQ(warning.code, "solid-parted");
  return std::move(made.solids.front().model);
}

auto rectangle(double x0, double y0, double x1, double y1) -> Ring { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }

/// Eaves at 3 m in the south and north, gables in the west and east: 12 by 8 m, the ridge at 7 m along y = 4.
auto gabled() -> LabelledSolid {
  const Profile slope{{0, 0}, {0, 3}, {1, 4}}, upright{{0, 0}, {0, 30}};
  return raised(plan(box(12, 8), {slope, upright}, {0, 1, 0, 1}));
}

auto tower(const Ring& ring, double top) -> LabelledSolid {
  return raised(plan(ring, {Profile{{0, 0}, {0, top}}}, {}, top));
}

auto area_of(const LabelledSolid& model, FaceClass kind) -> double {
  double sum = 0;
  for (std::size_t f = 0; f < model.classes.size(); ++f)
    if (model.classes[f] == kind) sum += solid::area(model.solid, model.solid.faces[f]);
  return sum;
}

auto faces_of(const LabelledSolid& model, FaceClass kind) -> std::size_t {
  return static_cast<std::size_t>(std::ranges::count(model.classes, kind));
}

/// What every level promises of the finer one.
void expect_simplified(const LabelledSolid& coarse, const LabelledSolid& fine) {
  EXPECT_THAT(solid::check(coarse.solid, solid::written_rules()), IsEmpty());
  EXPECT_LE(coarse.solid.faces.size(), fine.solid.faces.size());
  EXPECT_THAT(area_of(coarse, FaceClass::ground), DoubleNear(area_of(fine, FaceClass::ground), 1e-6));
}

TEST(MainRoofs, leave_out_a_chimney_on_one_slope) {
  const Ring chimney = rectangle(3, 1, 4, 2);
  const auto fine = united({gabled(), tower(chimney, 9)});
  const auto coarse = solid::main_roofs(fine);
  expect_simplified(coarse, fine);
  EXPECT_EQ(coarse.solid.faces.size(), 7U);
  EXPECT_THAT(solid::volume(coarse.solid), DoubleNear(12 * 8 * 3 + 12 * 8 * 4 / 2.0, 1e-2));
}

TEST(MainRoofs, continue_both_slopes_below_a_chimney_on_the_ridge) {
  const Ring chimney = rectangle(5, 3.2, 6, 4.5);
  const auto fine = united({gabled(), tower(chimney, 10)});
  const auto coarse = solid::main_roofs(fine);
  expect_simplified(coarse, fine);
  EXPECT_EQ(faces_of(coarse, FaceClass::roof), 2U);
  EXPECT_THAT(solid::volume(coarse.solid), DoubleNear(12 * 8 * 3 + 12 * 8 * 4 / 2.0, 1e-2));
}

TEST(MainRoofs, leave_out_what_stands_on_a_small_structure_too) {
  const Ring cabin = rectangle(2, 2, 5, 5), mast = rectangle(3, 3, 3.5, 3.5);
  const auto base = raised(plan(box(12, 8), {Profile{{0, 0}, {0, 6}}}, {}, 6, {turned_in(cabin)}));
  const auto middle = raised(plan(cabin, {Profile{{0, 0}, {0, 8}}}, {}, 8, {turned_in(mast)}));
  const auto fine = united({base, middle, tower(mast, 12)});
  const auto coarse = solid::main_roofs(fine);
  expect_simplified(coarse, fine);
  EXPECT_THAT(solid::volume(coarse.solid), DoubleNear(12 * 8 * 6, 1e-3));
}

TEST(MainRoofs, keep_an_annex_beside_a_house) {
  const auto fine = united({tower(box(12, 8), 9), tower(rectangle(12, 0, 14, 3), 3)});
  const auto coarse = solid::main_roofs(fine);
  EXPECT_EQ(solid::volume(coarse.solid), solid::volume(fine.solid));
}

TEST(MainRoofs, keep_structures_of_at_least_the_area_asked_for) {
  const Ring cabin = rectangle(2, 2, 6, 5);
  const auto base = raised(plan(box(12, 8), {Profile{{0, 0}, {0, 6}}}, {}, 6, {turned_in(cabin)}));
  const auto fine = united({base, tower(cabin, 9)});
  EXPECT_EQ(solid::volume(solid::main_roofs(fine).solid), solid::volume(fine.solid));
  EXPECT_LT(solid::volume(solid::main_roofs(fine, {.lod20_structure = 12.5}).solid), solid::volume(fine.solid));
}

TEST(FlatPieces, keep_a_step_between_two_flat_roofs) {
  const auto fine = united({gabled(), tower(rectangle(12, 0, 16, 8), 14)});
  const auto coarse = solid::flat_pieces(fine);
  expect_simplified(coarse, fine);
  EXPECT_EQ(faces_of(coarse, FaceClass::roof), 2U);
  // 70 % of the gabled roof is below 3 + 0.7 × 4 m.
  EXPECT_THAT(solid::volume(coarse.solid), DoubleNear(12 * 8 * 5.8 + 4 * 8 * 14, 1e-2));
}

TEST(FlatPieces, join_roofs_below_the_step_that_is_kept) {
  const auto fine =
      united({tower(box(12, 8), 6), tower(rectangle(12, 0, 16, 8), 8), tower(rectangle(16, 0, 20, 8), 20)});
  EXPECT_EQ(faces_of(solid::flat_pieces(fine), FaceClass::roof), 2U);
  EXPECT_EQ(faces_of(solid::flat_pieces(fine, {.lod13_step = 1}), FaceClass::roof), 3U);
  EXPECT_THAT(solid::flat_pieces(fine, {.lod13_step = 100}).solid.faces, IsEmpty());
}

TEST(FlatPieces, of_roofs_that_slope_into_each_other_are_one) {
  EXPECT_THAT(solid::flat_pieces(gabled()).solid.faces, IsEmpty());
}

TEST(FlatPieces, keep_party_walls) {
  auto fine = united({gabled(), tower(rectangle(12, 0, 16, 8), 14)});
  for (std::size_t f = 0; f < fine.solid.faces.size(); ++f) {
    const auto& face = fine.solid.faces[f];
    if (face.normal.x < -0.9) fine.classes[f] = FaceClass::party_wall;
  }
  const auto coarse = solid::flat_pieces(fine);
  EXPECT_THAT(area_of(coarse, FaceClass::party_wall), DoubleNear(8 * 5.8, 1e-2));
}

TEST(Levels, of_random_roofs_with_structures_are_each_a_simplification_of_the_next) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    mansard::base::Random random(seed);
    const double x = random.uniform(0.5, 9), y = random.uniform(0.5, 5.5);
    const double w = random.uniform(0.5, 2), d = random.uniform(0.5, 2), top = random.uniform(1, 14);
    const Ring hole = rectangle(x, y, x + w, y + d);
    std::vector<LabelledSolid> parts{gabled(), tower(hole, top),
                                     tower(rectangle(12, random.uniform(0, 3), 15, 8), random.uniform(2, 15))};
    std::vector<const LabelledSolid*> all;
    for (const auto& part : parts) all.push_back(&part);
    const auto made = solid::unite(all);
    if (made.solids.size() != 1) continue;
    const auto& fine = made.solids.front().model;
    const auto main = solid::main_roofs(fine);
    expect_simplified(main, fine);
    // Nothing but the structure, which is within 14 m of its roof, is different.
    EXPECT_LE(std::abs(solid::volume(main.solid) - solid::volume(fine.solid)), w * d * 14);
    const auto flat = solid::flat_pieces(main);
    if (flat.solid.faces.empty()) continue;
    expect_simplified(flat, main);
    // Every piece stays between its lowest and its highest point, which are 4 m apart here, but for joined ones.
    EXPECT_LE(std::abs(solid::volume(flat.solid) - solid::volume(main.solid)), (12 * 8 + 3 * 8) * (4 + 3));
  }
}

TEST(FlatRoof, has_one_wall_where_the_solid_has_one) {
  const auto fine = united({gabled(), tower(rectangle(12, 0, 16, 8), 14)});
  const auto coarse = solid::flat_roof(fine, 6);
  expect_simplified(coarse, fine);
  EXPECT_EQ(faces_of(coarse, FaceClass::roof), 1U);
  EXPECT_THAT(solid::volume(coarse.solid), DoubleNear(16 * 8 * 6, 1e-6));
  EXPECT_THAT(solid::flat_roof(fine, 0).solid.faces, IsEmpty());
}

TEST(RoofPercentile, of_a_gabled_roof_is_that_of_its_height) {
  EXPECT_THAT(solid::roof_percentile(gabled(), 0.7), DoubleNear(5.8, 1e-4));
  EXPECT_THAT(solid::roof_percentile(gabled(), 0.5), DoubleNear(5, 1e-4));
}

TEST(RoofPercentile, does_not_count_holes) {
  const Ring hole = rectangle(1, 1, 11, 7);
  const auto ring = raised(plan(box(12, 8), {Profile{{0, 0}, {0, 6}}}, {}, 6, {turned_in(hole)}));
  EXPECT_THAT(solid::roof_percentile(ring, 0.9), DoubleNear(6, 1e-6));
}

TEST(Val3dityCodes, stand_for_the_findings_of_the_check) {
  auto broken = gabled();
  broken.solid.faces.pop_back();
  EXPECT_THAT(solid::val3dity_codes(solid::check(broken.solid)), testing::Contains(302));
  EXPECT_THAT(solid::val3dity_codes(solid::check(gabled().solid)), IsEmpty());
}

}  // namespace
