#include "mansard/evaluate/form.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "evaluate/models.hpp"

namespace {

using namespace mansard::evaluate;
using mansard::geometry::Mesh;
using models::in_triangles;
using models::Model;
using models::model_of;
using models::SurfaceClass;
using solids::box;
using solids::gable;
using solids::Solid;

/// A house from x0 to x1 with this section, counter-clockwise seen from the east (y to the right, z up).
auto along_x(const std::vector<models::Point2>& section, double x0, double x1) -> Solid {
  Solid solid;
  const auto n = static_cast<std::uint32_t>(section.size());
  for (const double x : {x0, x1})
    for (const auto p : section) solid.vertices.push_back({x, p.x, p.y});
  std::vector<std::uint32_t> west, east;
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    solids::add_face(solid, {i, next, n + next, n + i}, solids::FaceKind::side);
    west.insert(west.begin(), i);
    east.push_back(n + i);
  }
  solids::add_face(solid, west, solids::FaceKind::side);
  solids::add_face(solid, east, solids::FaceKind::side);
  return solid;
}

struct Measured {
  RoofPlanes planes;
  std::vector<RoofLine> lines;
  std::vector<RoofStructure> structures;
  Form form;
};

constexpr double grid = 0.25;

auto measured(const Model& model, const Mesh& scan = {}) -> Measured {
  Measured out{roof_planes_of(model), {}, {}, {}};
  out.lines = roof_lines_of(model, out.planes);
  out.structures = roof_structures_of(model, out.planes, grid);
  out.form = form_of({model, out.planes, out.lines, out.structures}, scan);
  return out;
}

auto compared(const Model& truth, const Model& model) -> FormTruth {
  const auto t = measured(truth), m = measured(model);
  return compare_form({truth, t.planes, t.lines, t.structures}, {model, m.planes, m.lines, m.structures}, grid);
}

auto count(const std::vector<RoofLine>& lines, RoofLineKind kind) {
  return std::ranges::count(lines, kind, &RoofLine::kind);
}

TEST(Form, of_a_plain_gable_has_nothing_to_object_to) {
  const auto model = model_of({{gable({0, 0}, {10, 8}, 0, 6, 9)}});
  const auto whole = measured(model), cut = measured(in_triangles(model));
  for (const auto& one : {whole, cut}) {
    EXPECT_EQ(one.form.planes, 2U);
    EXPECT_EQ(one.form.narrow, 0U);
    EXPECT_EQ(one.form.twins, 1U);
    EXPECT_EQ(one.form.unequal, 0U);
    EXPECT_EQ(one.form.steep, 0U);
    EXPECT_EQ(one.form.tall, 0U);
    EXPECT_EQ(one.form.edges, 15U);
    EXPECT_EQ(one.form.short_edges, 0U);
    EXPECT_EQ(one.form.vertices, 10U);
    EXPECT_EQ(one.form.unchecked, 0U);
    EXPECT_EQ(count(one.lines, RoofLineKind::ridge), 1);
    EXPECT_EQ(count(one.lines, RoofLineKind::eave), 2);
    EXPECT_EQ(one.lines.size(), 3U);
  }
}

TEST(Form, counts_a_bevel_along_an_eave_as_narrow_and_its_edges_as_short) {
  //      .          z 9
  //    /   \        z 6 at y 0.4
  //   '     |
  const auto model = model_of({{along_x({{0, 0}, {8, 0}, {8, 6}, {4, 9}, {0.4, 6.3}, {0, 5.9}}, 0, 10)}});
  const auto one = measured(model);
  EXPECT_EQ(one.form.planes, 3U);
  EXPECT_EQ(one.form.narrow, 1U);
  EXPECT_EQ(one.form.short_edges, 0U);  // 0.57 m up the slope
  const auto flatter = measured(model_of({{along_x({{0, 0}, {8, 0}, {8, 6}, {4, 9}, {0.3, 6.2}, {0, 5.9}}, 0, 10)}}));
  EXPECT_EQ(flatter.form.short_edges, 2U);
}

TEST(Form, counts_opposite_pitches_two_degrees_apart_as_unequal_twins) {
  const double rise = 4 * std::tan(0.6435 + 0.0349);  // 36.9° and 38.9°
  const auto one = measured(model_of({{along_x({{0, 0}, {8, 0}, {8, 6}, {4, 9}, {0, 9 - rise}}, 0, 10)}}));
  EXPECT_EQ(one.form.twins, 1U);
  EXPECT_EQ(one.form.unequal, 1U);
}

TEST(Form, does_not_pair_pitches_more_than_three_degrees_apart) {
  const double rise = 4 * std::tan(0.6435 + 0.0698);
  EXPECT_EQ(measured(model_of({{along_x({{0, 0}, {8, 0}, {8, 6}, {4, 9}, {0, 9 - rise}}, 0, 10)}})).form.twins, 0U);
}

TEST(Form, counts_a_needle_as_a_tall_part) {
  const auto one = measured(model_of({{box({0, 0}, {10, 8}, 0, 6), box({10, 0}, {11, 1.2}, 0, 6)}}));
  EXPECT_EQ(one.form.parts, 2U);
  EXPECT_EQ(one.form.tall, 1U);  // 6 m over 3 · 1.1 m
}

TEST(Form, counts_a_steep_roof_without_scan_on_it_and_not_one_that_was_scanned) {
  const std::vector<models::Point2> section{{0, 0}, {8, 0}, {8, 6}, {7, 9}, {0, 9}};
  const auto roof = model_of({{along_x(section, 0, 10)}});
  EXPECT_EQ(measured(roof).form.steep, 1U);
  EXPECT_EQ(measured(roof).form.steep_bare, 1U);
  Mesh scan;  // a strip up the slope, 5 m long
  for (int k = 0; k <= 4; ++k)
    for (const double x : {2.0, 7.0}) scan.vertices.push_back({x, 7.8 - 0.15 * k, 6.6 + 0.45 * k});
  for (std::uint32_t k = 0; k < 4; ++k) {
    scan.triangles.push_back({2 * k, 2 * k + 1, 2 * k + 3});
    scan.triangles.push_back({2 * k, 2 * k + 3, 2 * k + 2});
  }
  EXPECT_EQ(measured(roof, scan).form.steep_bare, 0U);
}

TEST(Form, counts_neighbours_with_ridges_a_few_centimetres_apart) {
  const auto row = [](double second) {
    return measured(model_of({{gable({0, 0}, {10, 8}, 0, 6, 9)}, {gable({10, 0}, {20, 8}, 0, 6, second)}})).form;
  };
  EXPECT_EQ(row(9.1).ridges, 1U);
  EXPECT_EQ(row(9.1).ridges_unequal, 1U);
  EXPECT_EQ(row(9).ridges, 1U);
  EXPECT_EQ(row(9).ridges_unequal, 0U);
  EXPECT_EQ(row(9.4).ridges, 0U);
}

TEST(Form, finds_a_box_on_a_slope_as_a_dormer_and_on_a_flat_roof_as_another_structure) {
  const auto house = gable({0, 0}, {12, 8}, 0, 6, 10);
  const auto dormer = measured(model_of({{house, box({4, 1}, {6, 3.5}, 5, 8.8)}}));
  EXPECT_EQ(dormer.form.dormers, 1U);
  EXPECT_EQ(dormer.form.structures, 0U);
  EXPECT_NEAR(static_cast<double>(dormer.structures[0].places.size()) * grid * grid, 2 * 1.5, 0.3);
  const auto plant = measured(model_of({{box({0, 0}, {12, 8}, 0, 6), box({4, 1}, {6, 3.5}, 5, 8)}}));
  EXPECT_EQ(plant.form.dormers, 0U);
  EXPECT_EQ(plant.form.structures, 1U);
}

TEST(Form, takes_a_part_with_the_role_of_a_dormer_for_one_wherever_it_is) {
  auto model = model_of({{gable({0, 0}, {12, 8}, 0, 6, 10), box({4, -0.75}, {6, 0.25}, 0, 7.5)}});
  EXPECT_EQ(measured(model).form.dormers, 0U);
  model.buildings[0].parts[1].role = "dormer";
  EXPECT_EQ(measured(model).form.dormers, 1U);
}

TEST(Form, of_a_wing_against_a_house_has_a_valley) {
  // Two gables at right angles with one ridge height, cut by hand at the valleys.
  Model model;
  const auto roof = [](std::vector<models::Point3> loop) {
    return models::ModelFace{{std::move(loop)}, SurfaceClass::roof, false};
  };
  model.buildings.push_back(
      {"a",
       {{"a",
         {roof({{0, 0, 6}, {2, 0, 6}, {6, 4, 10}, {10, 0, 6}, {12, 0, 6}, {12, 4, 10}, {0, 4, 10}}),
          roof({{0, 4, 10}, {12, 4, 10}, {12, 8, 6}, {0, 8, 6}}),
          roof({{2, 0, 6}, {2, -6, 6}, {6, -6, 10}, {6, 4, 10}}),
          roof({{10, 0, 6}, {6, 4, 10}, {6, -6, 10}, {10, -6, 6}})}}}});
  const auto lines = measured(model).lines;
  EXPECT_EQ(count(lines, RoofLineKind::valley), 2);
  EXPECT_EQ(count(lines, RoofLineKind::ridge), 2);
  EXPECT_EQ(count(lines, RoofLineKind::eave), 5);
}

TEST(FormTruth, finds_everything_in_a_model_that_is_the_truth) {
  const auto truth = model_of({{gable({0, 0}, {12, 8}, 0, 6, 10), box({4, 1}, {6, 3.5}, 5, 8.8)}});
  const auto both = compared(truth, truth);
  EXPECT_EQ(both.planes.truth.count, 3U);
  EXPECT_EQ(both.planes.truth.found, 3U);
  EXPECT_EQ(both.planes.model.found, 3U);
  EXPECT_EQ(both.lines[0].truth.count, 1U);
  EXPECT_EQ(both.lines[0].truth.found, 1U);
  EXPECT_EQ(both.dormers.truth.found, 1U);
  EXPECT_EQ(both.dormers.model.found, 1U);
  EXPECT_EQ(both.unchecked, 0U);
}

TEST(FormTruth, does_not_find_a_flat_roof_for_a_gable_nor_a_gable_half_a_metre_higher) {
  const auto truth = model_of({{gable({0, 0}, {12, 8}, 0, 6, 9)}});
  const auto flat = compared(truth, model_of({{box({0, 0}, {12, 8}, 0, 7.5)}}));
  EXPECT_EQ(flat.planes.truth.found, 0U);
  EXPECT_EQ(flat.planes.model.count, 1U);
  EXPECT_EQ(flat.planes.model.found, 0U);
  const auto higher = compared(truth, model_of({{gable({0, 0}, {12, 8}, 0, 6.5, 9.5)}}));
  EXPECT_EQ(higher.planes.truth.found, 0U);
  EXPECT_EQ(higher.lines[0].truth.found, 0U);
  EXPECT_DOUBLE_EQ(higher.lines[0].truth.size_found, 0);
}

TEST(FormTruth, finds_half_the_length_of_a_ridge_where_the_model_has_half_of_it) {
  const auto truth = model_of({{gable({0, 0}, {12, 8}, 0, 6, 9)}});
  const auto half = compared(truth, model_of({{gable({0, 0}, {6, 8}, 0, 6, 9), box({6, 0}, {12, 8}, 0, 7.5)}}));
  EXPECT_NEAR(half.lines[0].truth.size_found, 6.3, 0.11);
  EXPECT_EQ(half.lines[0].truth.found, 1U);
}

TEST(FormTruth, compares_a_building_of_the_model_with_all_true_ones_that_it_covers) {
  const auto west = gable({0, 0}, {6, 8}, 0, 6, 9), east = gable({6, 0}, {12, 8}, 0, 6, 9);
  const auto merged = compared(model_of({{west}, {east}}), model_of({{gable({0, 0}, {12, 8}, 0, 6, 9)}}));
  EXPECT_EQ(merged.planes.truth.count, 4U);
  EXPECT_EQ(merged.planes.truth.found, 4U);
  EXPECT_EQ(merged.planes.model.found, 2U);
}

auto results(const std::vector<ComparedPlane>& planes) {
  std::vector<ComparedPlane::Result> out;
  for (const auto& plane : planes) out.push_back(plane.result);
  return out;
}
constexpr auto found = ComparedPlane::Result::found, not_found = ComparedPlane::Result::not_found,
               too_small = ComparedPlane::Result::too_small;
using Results = std::vector<ComparedPlane::Result>;

TEST(FormTruth, says_which_planes_of_a_building_are_found_and_how_far_off_the_others_are) {
  // The roof is right, the flat annex 0.4 m too high; a box of 0.8 m² on it is in the model only.
  const auto house = gable({0, 0}, {12, 8}, 0, 6, 9);
  const auto truth = model_of({{house, box({12, 0}, {16, 8}, 0, 3)}});
  const auto off = compared(truth, model_of({{house, box({12, 0}, {16, 8}, 0, 3.4), box({13, 1}, {14, 1.8}, 3.4, 5)}}));
  ASSERT_EQ(off.compared.size(), 1U);
  const auto& one = off.compared[0];
  EXPECT_EQ(one.truth, 0U);
  EXPECT_EQ(one.model, std::vector<std::uint32_t>{0});
  EXPECT_EQ(results(one.truth_planes), (Results{found, found, not_found}));
  EXPECT_EQ(results(one.model_planes), (Results{found, found, not_found, too_small}));
  EXPECT_FALSE(one.every_plane_right());
  EXPECT_FALSE(one.truth_planes[0].nearest);
  ASSERT_TRUE(one.truth_planes[2].nearest && one.model_planes[2].nearest);
  EXPECT_NEAR(one.truth_planes[2].nearest->height, -0.4, 1e-9);
  EXPECT_NEAR(one.model_planes[2].nearest->height, 0.4, 1e-9);
  EXPECT_NEAR(one.model_planes[2].nearest->shared, 32, 1e-9);
  EXPECT_NEAR(one.model_planes[2].nearest->angle, 0, 1e-9);
  EXPECT_DOUBLE_EQ(one.ground, 0);
  // What is too small for a comparison does no harm.
  const auto same = compared(truth, model_of({{house, box({12, 0}, {16, 8}, 0, 3), box({13, 1}, {14, 1.8}, 3, 5)}}));
  EXPECT_TRUE(same.compared[0].every_plane_right());
}

TEST(FormTruth, does_not_call_a_building_right_that_the_model_or_the_truth_does_not_have) {
  const auto west = gable({0, 0}, {6, 8}, 0, 6, 9), east = gable({20, 0}, {26, 8}, 2, 6, 9);
  const auto missing = compared(model_of({{west}, {east}}), model_of({{west}}));
  ASSERT_EQ(missing.compared.size(), 2U);
  EXPECT_TRUE(missing.compared[0].every_plane_right());
  EXPECT_FALSE(missing.compared[1].every_plane_right());
  EXPECT_TRUE(missing.compared[1].model.empty());
  EXPECT_EQ(results(missing.compared[1].truth_planes), (Results{not_found, not_found}));
  const auto added = compared(model_of({{west}}), model_of({{west}, {east}}));
  ASSERT_EQ(added.compared.size(), 2U);
  EXPECT_FALSE(added.compared[1].truth);
  EXPECT_EQ(added.compared[1].model, std::vector<std::uint32_t>{1});
  EXPECT_EQ(results(added.compared[1].model_planes), (Results{not_found, not_found}));
  EXPECT_FALSE(added.compared[1].every_plane_right());
  EXPECT_DOUBLE_EQ(added.compared[1].ground, 2);
}

TEST(FormTruth, gives_a_true_building_the_planes_of_a_building_that_is_several_of_the_truth) {
  const auto west = gable({0, 0}, {6, 8}, 0, 6, 9), east = gable({6, 0}, {12, 8}, 0, 6, 9);
  const auto truth = model_of({{west}, {east}});
  const auto joined = compared(truth, model_of({{gable({0, 0}, {12, 8}, 0, 6, 9)}}));
  for (const auto& building : joined.compared) {
    EXPECT_EQ(results(building.model_planes), (Results{found, found}));
    EXPECT_TRUE(building.every_plane_right());
  }
  // One building of the model with the west roof right and the east one wrong.
  const auto half = compared(truth, model_of({{west, box({6, 0}, {12, 8}, 0, 7.5)}}));
  EXPECT_TRUE(half.compared[0].every_plane_right());
  EXPECT_EQ(results(half.compared[1].truth_planes), (Results{not_found, not_found}));
  EXPECT_EQ(results(half.compared[1].model_planes), (Results{not_found}));
}

TEST(RoofPlanes, have_a_pitch_an_azimuth_and_a_mean_height) {
  const auto planes = roof_planes_of(model_of({{gable({0, 0}, {12, 8}, 0, 6, 9)}})).planes;  // the ridge runs along x
  ASSERT_EQ(planes.size(), 2U);
  std::vector<double> azimuths;
  for (const auto& plane : planes) {
    EXPECT_NEAR(pitch_of(plane), std::atan(0.75), 1e-12);
    const auto azimuth = azimuth_of(plane);
    const auto centre = centre_of(plane);
    ASSERT_TRUE(azimuth && centre);
    azimuths.push_back(*azimuth);
    EXPECT_NEAR(centre->x, 6, 1e-9);
    EXPECT_NEAR(centre->y, *azimuth < 1 ? 6 : 2, 1e-9);
    EXPECT_NEAR(centre->z, 7.5, 1e-9);
  }
  std::ranges::sort(azimuths);
  EXPECT_NEAR(azimuths[0], 0, 1e-12);
  EXPECT_NEAR(azimuths[1], std::numbers::pi, 1e-12);
  EXPECT_FALSE(azimuth_of(roof_planes_of(model_of({{box({0, 0}, {1, 1}, 0, 1)}})).planes[0]));
}

}  // namespace
