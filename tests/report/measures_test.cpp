#include "mansard/report/measures.hpp"

#include <gmock/gmock.h>

#include "formats/cities.hpp"
#include "mansard/report/attributes.hpp"

namespace {

using namespace cities;
using namespace mansard;
using testing::DoubleNear;

template <class T>
auto value(const model::Attributes& attributes, std::string_view name) -> std::optional<T> {
  for (const auto& [key, one] : attributes)
    if (key == name)
      if (const auto* found = std::get_if<T>(&one)) return *found;
  return std::nullopt;
}

/// 10 by 8 m, ground at 1.25, eaves at 7.25, ridge at 11.25.
auto gabled_house() -> Building { return street().buildings[0]; }

TEST(Heights, of_a_strip_between_two_rows_of_samples_are_those_below_it) {
  const rays::Scene level({{{0, 0, 7}, {9, 0, 7}, {9, 9, 7}, {0, 9, 7}}, {{0, 1, 2}, {0, 2, 3}}});
  const geometry::Polygon strip{{{1, 1.1}, {6, 1.1}, {6, 1.4}, {1, 1.4}}, {}};
  const auto heights = report::heights_over(level, strip, 0.5);
  ASSERT_FALSE(heights.empty());
  EXPECT_EQ(heights.front(), 7);
  EXPECT_TRUE(report::heights_over(level, {{{20, 1.1}, {26, 1.1}, {26, 1.4}, {20, 1.4}}, {}}, 0.5).empty());
}

TEST(BuildingMeasures, of_a_gabled_house_are_those_that_one_calculates) {
  auto house = gabled_house();
  house.parts[0].model.solid.faces[5].kind = house.parts[0].model.solid.faces[6].kind = FaceKind::side;
  const auto all = report::building_measures(house, 100, 3);
  EXPECT_EQ(value<double>(all, "ms_h_eave"), 107.25);
  EXPECT_EQ(value<double>(all, "ms_h_ridge"), 111.25);
  EXPECT_EQ(value<double>(all, "ms_h_roof_min"), 107.25);
  EXPECT_THAT(*value<double>(all, "ms_h_roof_50p"), DoubleNear(109.25, 1e-6));
  EXPECT_THAT(*value<double>(all, "ms_h_roof_70p"), DoubleNear(110.05, 1e-6));
  EXPECT_EQ(value<std::string>(all, "ms_roof_type"), "slanted");
  EXPECT_EQ(value<std::string>(all, "roofType"), "1030");
  EXPECT_EQ(value<std::int64_t>(all, "ms_roof_planes"), 2);
  EXPECT_EQ(value<std::int64_t>(all, "ms_ridges"), 1);
  EXPECT_EQ(value<std::int64_t>(all, "ms_parts"), 1);
  EXPECT_THAT(*value<double>(all, "measuredHeight"), DoubleNear(10, 1e-9));
  EXPECT_EQ(value<std::int64_t>(all, "ms_storeys"), 3) << "8.8 m in storeys of 3 m";
  EXPECT_THAT(*value<double>(all, "ms_area_footprint"), DoubleNear(80, 1e-9));
  EXPECT_THAT(*value<double>(all, "ms_area_roof_sloped"), DoubleNear(2 * 10 * std::sqrt(32), 1e-9));
  EXPECT_THAT(*value<double>(all, "ms_area_wall"), DoubleNear(2 * 10 * 6 + 2 * 8 * 6 + 8 * 4, 1e-9));
}

TEST(BuildingMeasures, find_eaves_and_ridges_on_the_grid_of_the_files_whichever_way_a_house_is_turned) {
  for (double angle = 0; angle < 3.2; angle += 0.37) {
    auto house = gabled_house();
    auto& solid = house.parts[0].model.solid;
    for (auto& v : solid.vertices) {
      const Point3 turned{std::cos(angle) * v.x - std::sin(angle) * v.y, std::sin(angle) * v.x + std::cos(angle) * v.y,
                          v.z + 0.00004};
      for (const auto& [to, from] : {std::pair{&v.x, turned.x}, std::pair{&v.y, turned.y}, std::pair{&v.z, turned.z}})
        *to = std::round(from * 1e4) / 1e4;
    }
    solid.vertices[solid.faces[5].loops[0][0]].z += 0.0001;  // as the union of parts leaves it
    for (auto& face : solid.faces) {
      Point3 normal;
      const auto& loop = face.loops[0];
      for (std::size_t i = 1; i + 1 < loop.size(); ++i)
        normal = normal + cross(solid.vertices[loop[i]] - solid.vertices[loop[0]],
                                solid.vertices[loop[i + 1]] - solid.vertices[loop[0]]);
      face.normal = geometry::normalised(normal);
    }
    const auto all = report::building_measures(house, 0, 3);
    ASSERT_TRUE(value<double>(all, "ms_h_eave")) << angle;
    EXPECT_THAT(*value<double>(all, "ms_h_eave"), DoubleNear(7.25, 2e-4)) << angle;
    EXPECT_EQ(value<std::int64_t>(all, "ms_ridges"), 1) << angle;
  }
}

TEST(BuildingMeasures, leave_what_the_source_has) {
  auto house = gabled_house();
  house.attributes = {{"storeysAboveGround", std::int64_t{5}}, {"roofType", std::string("gable")}};
  const auto all = report::building_measures(house, 0, 3);
  EXPECT_FALSE(value<std::int64_t>(all, "storeysAboveGround"));
  EXPECT_FALSE(value<std::string>(all, "roofType"));
  EXPECT_TRUE(value<double>(all, "measuredHeight"));
}

TEST(BuildingMeasures, of_a_building_without_a_model_are_its_footprint) {
  Building none = gabled_house();
  none.parts.clear();
  const auto all = report::building_measures(none, 0, 3);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].first, "ms_area_footprint");
}

TEST(LevelMeasures, have_volume_surface_and_validity_of_every_level) {
  const auto city = street();
  const auto all = report::level_measures(city.buildings[0], city.frame, {}, nullptr, {});
  EXPECT_THAT(*value<double>(all, "ms_volume_lod12"), DoubleNear(10 * 8 * 8, 1e-6));
  EXPECT_EQ(value<double>(all, "ms_volume_lod13"), value<double>(all, "ms_volume_lod12"));
  EXPECT_THAT(*value<double>(all, "ms_volume_lod20"), DoubleNear(10 * 8 * 8, 1e-6));
  EXPECT_FALSE(value<double>(all, "ms_rmse_lod12"));
  for (const char* lod : {"12", "13", "20", "22"}) {
    EXPECT_EQ(value<std::string>(all, std::string("ms_val3dity_lod") + lod), "[]") << lod;
    EXPECT_GT(*value<double>(all, std::string("ms_surface_lod") + lod), 2 * 80) << lod;
  }
}

TEST(LevelMeasures, say_which_codes_are_against_a_solid) {
  auto city = street();
  auto& building = city.buildings[0];
  auto broken = building.parts[0].model;
  broken.solid.faces.pop_back();
  broken.classes.pop_back();
  building.solids = {{{0}, broken}};
  const auto all = report::level_measures(building, city.frame, {}, nullptr, {});
  EXPECT_EQ(value<std::string>(all, "ms_val3dity_lod22"), "[302]");
  EXPECT_EQ(report::failed_checks("full", all), std::vector<std::string_view>{"validity"});
}

TEST(LevelMeasures, have_the_error_of_the_flat_roof_against_the_mesh) {
  const auto city = street();
  // The roof itself as the mesh: a flat one at its middle is off by up to 2 m, evenly: 2 / √3.
  geometry::Mesh mesh;
  mesh.vertices = {{1.0625, 2.125, 7.25},   {11.0625, 2.125, 7.25}, {1.0625, 6.125, 11.25},
                   {11.0625, 6.125, 11.25}, {1.0625, 10.125, 7.25}, {11.0625, 10.125, 7.25}};
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {2, 3, 5}, {2, 5, 4}};
  const rays::Scene scene(mesh);
  const auto all = report::level_measures(city.buildings[0], city.frame, {}, &scene, {0.1, 0, 0});
  EXPECT_THAT(*value<double>(all, "ms_rmse_lod12"), DoubleNear(2 / std::sqrt(3.0), 0.02));
}

TEST(Coverage, is_the_share_without_a_surface_and_the_largest_circle_in_it) {
  geometry::Mesh mesh;  // the left 6 m of 10
  mesh.vertices = {{0, 0, 5}, {6, 0, 5}, {6, 10, 5}, {0, 10, 5}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  const rays::Scene scene(mesh);
  const std::vector<Polygon> ground{rectangle(0.01, 0.01, 9.98, 9.98)};
  const auto found = report::coverage(scene, ground, 0.1);
  EXPECT_THAT(found.missing, DoubleNear(0.4, 0.01));
  EXPECT_THAT(found.radius, DoubleNear(2, 0.1));
  const auto all = report::coverage(scene, std::vector<Polygon>{rectangle(1, 1, 4, 4)}, 0.1);
  EXPECT_EQ(all.missing, 0);
  EXPECT_EQ(all.radius, 0);
}

using Checks = std::vector<std::string_view>;

TEST(Checks, name_those_that_failed) {
  const model::Attributes valid{{"ms_val3dity_lod22", std::string("[]")}, {"ms_nodata_share", 0.1}};
  EXPECT_EQ(report::failed_checks("full", valid), Checks{});
  EXPECT_EQ(report::failed_checks("fallback", valid), Checks{"outcome"});
  EXPECT_EQ(report::failed_checks("full", {{"ms_nodata_share", 0.6}}), Checks{"coverage"});
  EXPECT_EQ(report::failed_checks("full", valid, "terrain"), Checks{});
  EXPECT_EQ(report::failed_checks("fallback", valid, "assumed"), (Checks{"outcome", "ground"}));
}

auto quality(std::string_view outcome, const Checks& failed, std::optional<double> right) -> model::Attributes {
  model::Attributes out;
  std::optional<confidence::Confidence> confidence;
  if (right) confidence.emplace().right = *right;
  report::add_quality(outcome, failed, confidence, out);
  return out;
}

TEST(Quality, is_the_class_of_the_confidence) {
  EXPECT_EQ(value<std::string>(quality("full", {}, 0.97), "ms_quality"), "high");
  EXPECT_EQ(value<std::string>(quality("full", {}, 0.97), "ms_checks"), "no check failed");
  EXPECT_EQ(value<double>(quality("full", {}, 0.973), "ms_confidence"), 0.97);
  EXPECT_EQ(value<std::string>(quality("full", {}, 0.6), "ms_quality"), "medium");
  EXPECT_EQ(value<std::string>(quality("full", {}, 0.1), "ms_quality"), "low");
}

TEST(Quality, is_not_high_where_a_check_failed) {
  const auto found = quality("fallback", {"outcome", "ground"}, 0.97);
  EXPECT_EQ(value<std::string>(found, "ms_quality"), "medium");
  EXPECT_EQ(value<std::string>(found, "ms_checks"), "failed: outcome, ground");
}

TEST(Quality, says_nothing_without_a_scan_or_a_model) {
  EXPECT_EQ(value<std::string>(quality("full", {}, {}), "ms_quality"), "unknown");
  EXPECT_FALSE(value<double>(quality("full", {}, {}), "ms_confidence"));
  EXPECT_EQ(value<std::string>(quality("refused", {"outcome"}, {}), "ms_quality"), "none");
}

TEST(Quality, has_the_reasons_behind_it) {
  auto found = quality("full", {}, 0.3);
  found.emplace_back("ms_h_eave", 3.0);
  report::set_reasons(found, {base::warning("a", "first"), base::warning("b", "second")});
  EXPECT_EQ(value<std::string>(found, "ms_reasons"), "first; second");
  EXPECT_EQ(found.back().first, "ms_h_eave");
  EXPECT_EQ(found[found.size() - 2].first, "ms_reasons");
}

}  // namespace
