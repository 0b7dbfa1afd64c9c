// The union of parts that stand wall to wall: drawn examples, each with what is left of the walls between them.
#include <gmock/gmock.h>

#include <random>
#include <set>

#include "cities.hpp"
#include "mansard/solid/unite.hpp"

namespace {

using namespace cities;
using mansard::solid::unite;
using mansard::solid::United;
using testing::ElementsAre;
using testing::IsEmpty;

auto box(double x, double y, double width, double depth, double base, double top) -> LabelledSolid {
  return prism(rectangle(x, y, width, depth), base, top);
}

auto united(const std::vector<LabelledSolid>& parts) -> United {
  std::vector<const LabelledSolid*> all;
  for (const auto& part : parts) all.push_back(&part);
  United made = unite(all);
  for (const auto& one : made.solids)
    for (const auto& fault : mansard::solid::check(one.model.solid, mansard::solid::written_rules()))
      ADD_FAILURE() << fault.code << ": " << fault.message;
  return made;
}

/// m² of the faces that look along an axis.
auto area_towards(const Solid& solid, Point3 axis) -> double {
  double sum = 0;
  for (const auto& face : solid.faces)
    if (dot(face.normal, axis) > 0.999) sum += mansard::solid::area(solid, face);
  return sum;
}
const Point3 east{1, 0, 0}, west{-1, 0, 0}, south{0, -1, 0}, up{0, 0, 1}, down{0, 0, -1};

/// One valid solid with the volume of all.
auto one_solid(const std::vector<LabelledSolid>& parts, double within = 1e-6) -> Solid {
  const auto made = united(parts);
  EXPECT_THAT(made.warnings, IsEmpty());
  EXPECT_EQ(made.solids.size(), 1U);
  const Solid& solid = made.solids.front().model.solid;
  double volume = 0;
  for (const auto& part : parts) volume += mansard::solid::volume(part.solid);
  EXPECT_NEAR(mansard::solid::volume(solid), volume, within);
  return solid;
}

TEST(Union, of_two_boxes_keeps_only_what_stands_higher_of_the_wall_between) {
  const Solid solid = one_solid({box(0, 0, 10, 8, 0, 6), box(10, 0, 5, 8, 0, 4)});
  EXPECT_NEAR(area_towards(solid, east), 5 * 0 + 8 * 2 + 8 * 4, 1e-9) << "the step, and the end";
  EXPECT_NEAR(area_towards(solid, west), 8 * 6, 1e-9);
  EXPECT_NEAR(area_towards(solid, up), 15 * 8, 1e-9);
}

TEST(Union, of_boxes_of_one_height_has_nothing_between) {
  const Solid solid = one_solid({box(0, 0, 10, 8, 0, 6), box(10, 0, 5, 8, 0, 6)});
  EXPECT_NEAR(area_towards(solid, east), 8 * 6, 1e-9);
  EXPECT_NEAR(area_towards(solid, west), 8 * 6, 1e-9);
}

TEST(Union, of_an_l_has_the_corners_of_both_on_the_longer_wall) {
  const Solid solid = one_solid({box(0, 0, 10, 20, 0, 6), box(10, 5, 5, 8, -1, 4)});
  EXPECT_NEAR(area_towards(solid, east), 20 * 6 - 8 * 4 + 8 * 5, 1e-9);
  EXPECT_NEAR(area_towards(solid, west), 20 * 6 + 8 * 1, 1e-9) << "the annex reaches a metre deeper";
}

TEST(Union, of_three_around_a_corner) {
  const Solid solid = one_solid({box(0, 0, 10, 10, 0, 9), box(10, 0, 10, 10, 0, 6), box(0, 10, 10, 10, 0, 3)});
  EXPECT_NEAR(area_towards(solid, east), 10 * 9 + 10 * 3, 1e-9) << "of the first its step, of the others their ends";
  EXPECT_NEAR(area_towards(solid, down), 300, 1e-9);
}

TEST(Union, around_a_courtyard_is_one_with_a_hole) {
  const Solid solid = one_solid(
      {box(0, 0, 30, 10, 0, 9), box(0, 20, 30, 10, 0, 9), box(0, 10, 10, 10, 0, 6), box(20, 10, 10, 10, 0, 12)});
  EXPECT_NEAR(area_towards(solid, down), 800, 1e-9);
  EXPECT_NEAR(area_towards(solid, east), 10 * 9 * 2 + 10 * 12 + 10 * 6, 1e-9) << "the east end, and into the court";
}

TEST(Union, breaks_roofs_where_a_gable_rises_above_a_flat_roof) {
  // The gable's end is a pentagon of eaves 3 and ridge 7; the flat roof at 5 hides what is lower.
  const Solid solid = one_solid({gable(0, 0, 10, 8, 0, 3, 7), box(10, 0, 6, 8, 0, 5)});
  EXPECT_NEAR(area_towards(solid, west), 8 * 3 + 8 * 4 / 2.0 + 2 * (2 * 2 / 2.0), 1e-9)
      << "of the box two corners show";
  EXPECT_NEAR(area_towards(solid, east), 8 * 5 + 4 * 2 / 2.0, 1e-9) << "of the gable its tip";
}

TEST(Union, breaks_both_roofs_where_two_gables_cross) {
  const Solid solid = one_solid({gable(0, 0, 10, 8, 0, 3, 7), gable(10, 0, 10, 8, 0, 4, 6)});
  EXPECT_EQ(solid.vertices.size(), 4U + 4 + 2 + 4 + 4 + 2 - 2 + 2)
      << "two corners fall together, two crossings are new";
}

/// The least distance of a vertex of one from the vertices of another, m.
auto gap(const Solid& a, const Solid& b) -> double {
  double least = 1e9;
  for (const auto p : a.vertices)
    for (const auto q : b.vertices) least = std::min(least, length(p - q));
  return least;
}

TEST(Union, leaves_parts_that_touch_in_a_line_only_two_solids_with_a_gap) {
  const auto made = united({box(0, 0, 10, 10, 0, 9), box(10, 10, 10, 10, 0, 6)});
  ASSERT_EQ(made.solids.size(), 2U);
  EXPECT_THAT(made.warnings, IsEmpty());
  const double apart = gap(made.solids[0].model.solid, made.solids[1].model.solid);
  EXPECT_GT(apart, 1e-3);
  EXPECT_LT(apart, 4e-3);
}

TEST(Union, joins_what_is_low_between_towers_across_a_corner) {
  // Above the low ones four walls would meet in one line: no 2-manifold can have that. All ways that it can be turned.
  for (int i = 0; i < 4; ++i) {
    const auto top = [&](int k) { return (i + k) % 2 == 0 ? 9.0 : 3.0 + i / 2; };
    const double base = i > 1 ? 1 : 0;
    const Solid solid = one_solid({box(0, 0, 10, 10, 0, top(0)), box(10, 0, 10, 10, base, top(1)),
                                   box(10, 10, 10, 10, 0, top(2)), box(0, 10, 10, 10, base, top(3))},
                                  1e-3);
    EXPECT_NEAR(area_towards(solid, up), 400, 1e-6);
    EXPECT_NEAR(area_towards(solid, down), 400, 1e-6);
  }
}

TEST(Union, of_parts_around_a_court_that_touch_in_a_line_has_a_gap_there) {
  // Three parts around a court; the last one meets the first one in the line above (10, 10) only.
  const Solid solid = one_solid({box(0, 0, 10, 10, 0, 9), box(0, 10, 5, 20, 0, 9), box(5, 20, 15, 10, 0, 9),
                                 prism({{{10, 10}, {20, 10}, {20, 20}, {15, 20}}, {}}, 0, 6)},
                                1e-3);
  EXPECT_NEAR(area_towards(solid, down), 100 + 100 + 150 + 75, 1e-4);
}

auto codes_of(const United& made) -> std::vector<std::string> {
  std::vector<std::string> out;
  for (const auto& warning : made.warnings) out.push_back(warning.code);
  return out;
}

TEST(Union, of_parts_that_share_ground_leaves_it_to_the_higher_one_and_says_so) {
  for (const bool higher_first : {true, false}) {
    std::vector<LabelledSolid> parts{box(0, 0, 10, 8, 0, 6), box(9, 0, 5, 8, 0, 4)};
    if (!higher_first) std::swap(parts[0], parts[1]);
    const auto made = united(parts);
    EXPECT_THAT(codes_of(made), ElementsAre("solid-parted"));
    ASSERT_EQ(made.solids.size(), 1U);
    EXPECT_THAT(made.solids[0].of, ElementsAre(0, 1));
    EXPECT_NEAR(mansard::solid::volume(made.solids[0].model.solid), 80 * 6 + 32 * 4, 1e-6);
  }
}

/// A house of which two sides are a hair inside its neighbour, over a wedge of 8 mm: no walls cross, and both have the
/// corners at the ends of the wedge (building 110464280 of the simulated Regent Street, seed 3).
TEST(Union, of_parts_that_overlap_in_a_wedge_between_shared_corners) {
  const auto made = united({prism({{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {}}, 0, 9),
                            prism({{{10, 0}, {20, 0}, {20, 10}, {10, 10}, {9.992, 5}}, {}}, 0, 6)});
  EXPECT_THAT(codes_of(made), ElementsAre("solid-parted"));
  ASSERT_EQ(made.solids.size(), 1U);
  EXPECT_NEAR(mansard::solid::volume(made.solids[0].model.solid), 1500, 0.3);
}

TEST(Union, of_roofs_that_share_ground_keeps_both_roofs) {
  const auto made = united({gable(0, 0, 10, 8, 0, 5, 9), gable(8, 1, 12, 6, 0, 4, 7)});
  EXPECT_THAT(codes_of(made), ElementsAre("solid-parted"));
  ASSERT_EQ(made.solids.size(), 1U);
  EXPECT_NEAR(mansard::solid::volume(made.solids[0].model.solid), 80 * 7 + 60 * 5.5, 1e-3);
}

TEST(Union, of_a_part_within_another_is_the_other_one) {
  const auto made = united({box(0, 0, 10, 8, 0, 6), box(2, 2, 5, 4, 0, 4)});
  EXPECT_THAT(codes_of(made), ElementsAre("solid-parted"));
  ASSERT_EQ(made.solids.size(), 1U);
  EXPECT_NEAR(mansard::solid::volume(made.solids[0].model.solid), 480, 1e-6);
}

TEST(Union, leaves_parts_alone_that_are_above_each_other) {
  const auto made = united({box(0, 0, 10, 8, 0, 6), box(2, 2, 5, 4, 8, 12)});
  EXPECT_EQ(made.solids.size(), 2U);
}

TEST(Union, of_each_part_shares_no_ground_either) {
  const std::vector<LabelledSolid> parts{box(0, 0, 10, 8, 0, 6), box(9, 0, 5, 8, 0, 4)};
  const auto made = mansard::solid::unite_each(std::vector<const LabelledSolid*>{&parts[0], &parts[1]});
  ASSERT_EQ(made.size(), 2U);
  double volume = 0;
  for (const auto& one : made) {
    ASSERT_EQ(one.solids.size(), 1U);
    volume += mansard::solid::volume(one.solids[0].model.solid);
  }
  EXPECT_NEAR(volume, 80 * 6 + 32 * 4, 1e-6);
}

TEST(Union, merges_vertices_nearer_than_a_millimetre) {
  const auto solid = one_solid({prism({{{0, 0}, {10, 0}, {10, 8}, {9.9995, 8}, {0, 8}}, {}}, 0, 6)}, 0.1);
  EXPECT_EQ(solid.vertices.size(), 8U);
}

TEST(Union, joins_parts_whose_walls_are_a_tenth_of_a_millimetre_apart_or_in_each_other) {
  for (const double off : {-0.0002, -0.0001, 0.0001, 0.0002})
    one_solid({box(0, 0, 10, 8, 0, 6), box(10 + off, 1, 5, 4, 0, 4)}, 0.1);
}

TEST(Union, puts_the_corners_of_a_neighbour_on_both_walls) {
  const std::vector<LabelledSolid> parts{gable(0, 0, 10, 8, 0, 3, 7), box(10, 1, 5, 4, 0, 4)};
  const auto made = mansard::solid::unite_all(std::vector<std::vector<const LabelledSolid*>>{{&parts[0]}, {&parts[1]}});
  ASSERT_EQ(made.size(), 2U);
  std::set<std::pair<double, double>> first;
  for (const auto& v : made[0].solids.at(0).model.solid.vertices) first.emplace(v.x, v.y);
  EXPECT_TRUE(first.contains({10, 1}));
  EXPECT_TRUE(first.contains({10, 5}));
  EXPECT_THAT(mansard::solid::check(made[0].solids[0].model.solid, mansard::solid::written_rules()), IsEmpty());
}

TEST(Union, of_several_solids_keeps_each_others_corners_on_walls_that_do_not_touch) {
  // The eastern part begins above the western one's roof: two solids, and a corner of one beside a slanted wall.
  const auto made = united({prism({{{0, 0}, {10, 0}, {11, 7}, {0, 9}}, {}}, 0, 3),
                            prism({{{10, 0}, {18, 0}, {18, 9}, {10.4286, 3}}, {}}, 4, 9)});
  ASSERT_EQ(made.solids.size(), 2U);
  const auto& vertices = made.solids[0].model.solid.vertices;
  EXPECT_TRUE(std::ranges::any_of(vertices, [](const auto v) { return xy(v) == Point2{10.4286, 3}; }));
}

TEST(Union, puts_the_corners_of_a_neighbour_on_a_roof_that_begins_at_the_ground) {
  // The western edge of a roof without walls runs from (0, 0) to (7, 10); a house has a corner 0.05 mm beside it.
  LabelledSolid roof;
  roof.solid.vertices = {{0, 0, 0}, {12, 0, 0}, {12, 10, 0}, {7, 10, 0}, {9, 4, 5}};
  add_face(roof, {{3, 2, 1, 0}}, FaceClass::ground);
  for (const std::uint32_t v : {0U, 1U, 2U, 3U}) add_face(roof, {{v, (v + 1) % 4, 4}}, FaceClass::roof);
  const LabelledSolid house = prism({{{-5, 0}, {0, 0}, {3.5, 5}, {-5, 5}}, {}}, 0, 6);
  const auto made = mansard::solid::unite_all(std::vector<std::vector<const LabelledSolid*>>{{&roof}, {&house}});
  bool found = false;
  for (const auto& face : made[0].solids.at(0).model.solid.faces)
    for (const auto v : face.loops[0]) found = found || xy(made[0].solids[0].model.solid.vertices[v]) == Point2{3.5, 5};
  EXPECT_TRUE(found);
}

TEST(Union, says_so_where_nothing_is_left_of_a_needle) {
  const auto made = united({prism({{{0, 0}, {10, 0}, {10, 0.0005}}, {}}, 0, 6)});
  EXPECT_THAT(made.solids, IsEmpty());
  ASSERT_EQ(made.warnings.size(), 1U);
  EXPECT_EQ(made.warnings[0].code, "solid-left-out");
  EXPECT_EQ(made.lost, std::vector<std::size_t>{0});
}

TEST(Union, opens_or_closes_a_neck_that_no_solid_can_have) {
  for (const double neck : {1e-4, 5e-4, 9e-4}) {
    SCOPED_TRACE(neck);
    const double near = 6 - neck;
    const auto made =
        united({prism({{{0, 0}, {6, 0}, {6, near}, {12, near}, {12, 12}, {near, 12}, {near, 6}, {0, 6}}, {}}, 0, 6)});
    double volume = 0;
    for (const auto& one : made.solids) volume += mansard::solid::volume(one.model.solid);
    EXPECT_NEAR(volume, 432, 1);
    EXPECT_THAT(made.lost, IsEmpty());
    EXPECT_EQ(made.warnings.size(), made.simplified.size());
    for (const auto& warning : made.warnings) EXPECT_EQ(warning.code, "solid-simplified");
  }
}

TEST(Union, makes_valid_solids_of_random_grids_turned_any_way) {
  const unsigned seed = 20261122;
  std::mt19937 random(seed);
  const auto any = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", round " + std::to_string(round));
    const double angle = any(0, 6.28), c = std::cos(angle), s = std::sin(angle);
    const auto turn = [&](LabelledSolid model) {
      for (auto& v : model.solid.vertices)
        v = {std::round((c * v.x - s * v.y) * 1e4) / 1e4, std::round((s * v.x + c * v.y) * 1e4) / 1e4,
             std::round(v.z * 1e4) / 1e4};
      for (auto& face : model.solid.faces)
        face.normal = {c * face.normal.x - s * face.normal.y, s * face.normal.x + c * face.normal.y, face.normal.z};
      return model;
    };
    std::vector<LabelledSolid> parts;
    double volume = 0;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 2; ++k) {
        const double x = 10 * i, y = k == 0 ? 0 : 7.3, depth = k == 0 ? 7.3 : 5.1,
                     eaves = std::round(any(2, 6) * 2) / 2;
        parts.push_back(turn(any(0, 1) < 0.5 ? box(x, y, 10, depth, 0, eaves)
                                             : gable(x, y, 10, depth, 0, eaves, eaves + any(0.5, 6))));
        volume += mansard::solid::volume(parts.back().solid);
      }
    double sum = 0;
    for (const auto& one : united(parts).solids) sum += mansard::solid::volume(one.model.solid);
    EXPECT_NEAR(sum, volume, 1.0);
  }
}

TEST(Union, has_a_gap_where_walls_stand_apart) {
  const auto made = united({box(0, 0, 10, 8, 0, 6), box(10.1, 0, 5, 8, 0, 4)});
  EXPECT_EQ(made.solids.size(), 2U);
  EXPECT_THAT(made.warnings, IsEmpty());
}

TEST(Union, joins_walls_turned_any_way_and_of_uneven_coordinates) {
  for (int i = 0; i < 40; ++i) {
    const double c = std::cos(0.37 * i), s = std::sin(0.37 * i);
    const auto turn = [&](LabelledSolid model) {
      for (auto& v : model.solid.vertices)
        v = {std::round((c * v.x - s * v.y) * 1e4) / 1e4, std::round((s * v.x + c * v.y) * 1e4) / 1e4, v.z};
      for (auto& face : model.solid.faces)
        face.normal = {c * face.normal.x - s * face.normal.y, s * face.normal.x + c * face.normal.y, face.normal.z};
      return model;
    };
    SCOPED_TRACE(i);
    one_solid(
        {turn(gable(0, 0, 10, 8, 0, 3, 7)), turn(gable(10, 1, 10, 5, 0.5, 4.2, 6.3)), turn(box(3, 8, 12, 4, 0, 2.5))},
        0.3);
  }
}

/// A lean-to over (0, 0) to (10, 8): 5 m high in the west, and down to the ground in the east.
auto lean_to() -> LabelledSolid {
  LabelledSolid model;
  model.solid.vertices = {{0, 0, 0}, {10, 0, 0}, {10, 8, 0}, {0, 8, 0}, {0, 0, 5}, {0, 8, 5}};
  add_face(model, {{3, 2, 1, 0}}, FaceClass::ground);
  add_face(model, {{0, 1, 4}}, FaceClass::wall);
  add_face(model, {{2, 3, 5}}, FaceClass::wall);
  add_face(model, {{3, 0, 4, 5}}, FaceClass::wall);
  add_face(model, {{1, 2, 5, 4}}, FaceClass::roof);
  return model;
}

TEST(Union, of_a_roof_that_comes_down_to_the_ground_and_a_house_there_is_one_solid) {
  const Solid solid = one_solid({lean_to(), box(10, 0, 5, 8, 0, 6)}, 0.15);
  EXPECT_NEAR(area_towards(solid, down), 15 * 8, 1e-6);
}

TEST(Union, of_parts_that_overlap_by_three_millimetres_is_one_solid) {
  const auto made = united({box(0, 0, 10, 8, 0, 6), box(9.997, 0, 5, 8, 0, 4)});
  EXPECT_THAT(codes_of(made), ElementsAre("solid-parted"));
  ASSERT_EQ(made.solids.size(), 1U);
  EXPECT_NEAR(mansard::solid::volume(made.solids[0].model.solid), 80 * 6 + 40 * 4, 0.3);
}

TEST(Union, depends_neither_on_the_order_of_the_buildings_nor_on_their_place) {
  const auto made = [](const std::vector<LabelledSolid>& parts, const std::vector<std::size_t>& order, double shift) {
    std::vector<LabelledSolid> moved = parts;
    for (auto& part : moved)
      for (auto& v : part.solid.vertices) v = v + Point3{shift, -shift, 0};
    std::vector<std::vector<const LabelledSolid*>> buildings;
    for (const std::size_t p : order) buildings.push_back({&moved[p]});
    const auto all = mansard::solid::unite_all(buildings);
    std::vector<std::vector<Point3>> corners(parts.size());
    for (std::size_t i = 0; i < order.size(); ++i)
      for (const auto v : all[i].solids.at(0).model.solid.vertices)
        corners[order[i]].push_back({std::round((v.x - shift) * 1e4), std::round((v.y + shift) * 1e4), v.z});
    return corners;
  };
  // Walls that miss each other by 0.3 to 0.9 mm, and a house that stands apart.
  const std::vector<LabelledSolid> parts{box(0, 0, 10, 8, 0, 6), box(10.0003, 2, 5, 8, 0, 4),
                                         box(3, 8.0009, 7, 5, 0, 5), box(30, 0, 10, 8, 0, 6)};
  const auto first = made(parts, {0, 1, 2, 3}, 0);
  EXPECT_EQ(made(parts, {3, 2, 1, 0}, 0), first);
  EXPECT_EQ(made(parts, {1, 3, 0, 2}, 512), first);
  EXPECT_EQ(made({parts[0], parts[1], parts[2]}, {0, 1, 2}, 0).at(1), first.at(1)) << "without the one apart";
}

TEST(Union, knows_parts_that_share_their_walls_already) {
  const auto shared = [](const std::vector<LabelledSolid>& parts) {
    std::vector<const LabelledSolid*> all;
    for (const auto& part : parts) all.push_back(&part);
    return mansard::solid::share_walls(all);
  };
  EXPECT_TRUE(shared({box(0, 0, 10, 8, 0, 6), box(10, 0, 5, 8, 0, 4)}));
  EXPECT_TRUE(shared({gable(0, 0, 10, 8, 0, 6, 9)})) << "the ridge breaks the wall below it";
  EXPECT_FALSE(shared({box(0, 0, 10, 8, 0, 6), box(10.0003, 0, 5, 8, 0, 4)}));
  std::vector<LabelledSolid> made;
  const auto parts = std::vector{box(0, 0, 10, 8, 0, 6), box(10.0003, 0, 5, 8, 0, 4)};
  for (auto& one : mansard::solid::unite_all(std::vector<std::vector<const LabelledSolid*>>{{&parts[0]}, {&parts[1]}}))
    made.push_back(std::move(one.solids.at(0).model));
  EXPECT_TRUE(shared(made));
}

TEST(Union, has_no_edge_inside_of_its_ground) {
  // The lean-to and the house as one shell over one ground: an edge runs through the middle of it.
  LabelledSolid model;
  model.solid.vertices = {{0, 0, 0}, {10, 0, 0}, {15, 0, 0}, {15, 8, 0}, {10, 8, 0}, {0, 8, 0},
                          {0, 0, 5}, {0, 8, 5},  {10, 0, 6}, {15, 0, 6}, {15, 8, 6}, {10, 8, 6}};
  add_face(model, {{5, 4, 3, 2, 1, 0}}, FaceClass::ground);
  add_face(model, {{0, 1, 6}}, FaceClass::wall);
  add_face(model, {{4, 5, 7}}, FaceClass::wall);
  add_face(model, {{5, 0, 6, 7}}, FaceClass::wall);
  add_face(model, {{1, 4, 7, 6}}, FaceClass::roof);
  add_face(model, {{1, 2, 9, 8}}, FaceClass::wall);
  add_face(model, {{2, 3, 10, 9}}, FaceClass::wall);
  add_face(model, {{3, 4, 11, 10}}, FaceClass::wall);
  add_face(model, {{4, 1, 8, 11}}, FaceClass::wall);
  add_face(model, {{8, 9, 10, 11}}, FaceClass::roof);
  const auto faults = mansard::solid::check(model.solid, mansard::solid::written_rules());
  ASSERT_FALSE(faults.empty());
  EXPECT_EQ(faults.front().code, "solid-self-intersection");
}

TEST(Union, of_footprints_that_are_piled_up_are_made_by_themselves) {
  // Each crosses all others: corners of one plan of them are as many as their pairs. Two neighbours beside them that
  // share a wall still do.
  std::vector<LabelledSolid> parts{box(30, 0, 10, 8, 0, 6), box(40, 2, 10, 8, 0, 5)};
  for (int i = 0; i < 100; ++i) parts.push_back(box(0.03 * (i * 37 % 100), 0.03 * (i * 61 % 100), 10, 8, 0, 6));
  std::vector<std::vector<const LabelledSolid*>> buildings;
  for (const auto& part : parts) buildings.push_back({&part});
  const auto made = mansard::solid::unite_all(buildings);
  const auto corners = [&](std::size_t b) { return made[b].solids.at(0).model.solid.vertices.size(); };
  EXPECT_EQ(corners(0), 10U) << "two are on its neighbour's wall";
  EXPECT_EQ(corners(1), 10U);
  for (std::size_t b = 2; b < parts.size(); ++b) EXPECT_EQ(corners(b), 8U) << b;
}

}  // namespace
