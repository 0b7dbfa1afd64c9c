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

/// A dormer 2 m wide on the slope of gabled() in the south, which is at 3 m + y: from `front` to y = 2, where its flat
/// roof at 5 m meets the slope behind it.
struct Dormer {
  double left = 0, front = 0;
};

/// gabled() with dormers. One whose front is 0 m is in the wall of the house.
auto with_dormers(const std::vector<Dormer>& dormers, std::vector<LabelledSolid> more = {}) -> LabelledSolid {
  const Profile slope{{0, 0}, {0, 3}, {1, 4}}, upright{{0, 0}, {0, 30}}, behind{{0, 0}, {0, 5}, {1, 6}};
  Ring outer{{0, 0}};
  std::vector<std::uint32_t> profiles{0};
  Plan house = plan(box(12, 8), {slope, upright, behind});
  house.holes.clear();
  std::vector<LabelledSolid> parts;
  for (const auto& d : dormers) {
    const double right = d.left + 2;
    parts.push_back(tower(rectangle(d.left, d.front, right, 2), 5));
    if (d.front > 0) {
      house.holes.push_back({{{d.left, d.front}, {d.left, 2}, {right, 2}, {right, d.front}}, {1, 2, 1, 1}});
      continue;
    }
    outer.insert(outer.end(), {{d.left, 0}, {d.left, 2}, {right, 2}, {right, 0}});
    profiles.insert(profiles.end(), {1, 2, 1, 0});
  }
  outer.insert(outer.end(), {{12, 0}, {12, 8}, {0, 8}});
  profiles.insert(profiles.end(), {1, 0, 1});
  house.outer = {std::move(outer), std::move(profiles)};
  parts.insert(parts.begin(), raised(house));
  parts.insert(parts.end(), more.begin(), more.end());
  return united(parts);
}

void expect_house_without_dormers(const LabelledSolid& fine, std::size_t roofs = 2) {
  ASSERT_GT(faces_of(fine, FaceClass::roof), 3U);
  const auto coarse = solid::main_roofs(fine);
  expect_simplified(coarse, fine);
  EXPECT_EQ(faces_of(coarse, FaceClass::roof), roofs);
  EXPECT_THAT(solid::volume(coarse.solid), DoubleNear(12 * 8 * 3 + 12 * 8 * 4 / 2.0, 1e-2));
}

TEST(MainRoofs, leave_out_dormers_that_meet_the_slope_without_a_step) {
  expect_house_without_dormers(with_dormers({{3, 1}, {7, 0.5}}));
}

TEST(MainRoofs, leave_out_dormers_in_the_wall_of_the_house) {
  expect_house_without_dormers(with_dormers({{3, 0}, {7, 0}}));
}

TEST(MainRoofs, leave_out_dormers_in_a_row_and_a_chimney_on_one) {
  expect_house_without_dormers(with_dormers({{2, 1}, {7, 1}}, {tower(rectangle(2.5, 1.25, 3, 1.75), 7)}));
}

TEST(MainRoofs, leave_out_dormers_where_rounding_cut_the_slope_into_triangles) {
  auto fine = with_dormers({{3, 1}, {7, 1}});
  const auto cut = *solid::triangulate(fine.solid);
  LabelledSolid triangles{{fine.solid.vertices, {}}, {}};
  for (std::size_t t = 0; t < cut.triangles.size(); ++t) {
    const auto f = cut.face_of[t];
    if (fine.classes[f] != FaceClass::roof) continue;
    auto& face = triangles.solid.faces.emplace_back(fine.solid.faces[f]);
    face.loops = {{cut.triangles[t][0], cut.triangles[t][1], cut.triangles[t][2]}};
    triangles.classes.push_back(FaceClass::roof);
  }
  for (std::size_t f = 0; f < fine.classes.size(); ++f) {
    if (fine.classes[f] == FaceClass::roof) continue;
    triangles.solid.faces.push_back(fine.solid.faces[f]);
    triangles.classes.push_back(fine.classes[f]);
  }
  fine = triangles;
  ASSERT_THAT(solid::check(fine.solid, solid::written_rules()), IsEmpty());
  expect_house_without_dormers(fine, 3);  // the slope in the north stays two triangles
}

TEST(MainRoofs, keep_light_wells) {
  for (const double floor : {0.5, 4.5}) {
    const Ring well = rectangle(5, 3, 7, 5);
    const auto fine =
        united({raised(plan(box(12, 8), {Profile{{0, 0}, {0, 6}}}, {}, 6, {turned_in(well)})), tower(well, floor)});
    const auto coarse = solid::main_roofs(fine);
    const bool deep = floor < 3;
    EXPECT_THAT(solid::volume(coarse.solid), DoubleNear(deep ? solid::volume(fine.solid) : 12 * 8 * 6, 1e-3));
  }
}

TEST(MainRoofs, keep_a_wing_whose_roof_meets_that_of_the_house) {
  // 4 m wide and 0.3 m in front of the wall, with eaves and slopes like those of the house: it meets it along two
  // valleys.
  const Profile slope{{0, 0}, {0, 3}, {1, 4}}, upright{{0, 0}, {0, 30}};
  const auto wing = raised(plan({{4, -0.3}, {8, -0.3}, {8, 0}, {6, 2}, {4, 0}}, {slope, upright}, {1, 0, 1, 1, 0}));
  const auto fine = united({gabled(), wing});
  EXPECT_EQ(solid::volume(solid::main_roofs(fine).solid), solid::volume(fine.solid));
}

TEST(MainRoofs, keep_hips) {
  const auto fine = raised(plan(box(12, 4), {Profile{{0, 0}, {0, 3}, {1, 4}}}));
  EXPECT_EQ(solid::volume(solid::main_roofs(fine).solid), solid::volume(fine.solid));
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
