#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <numbers>

#include "mansard/formats/documents.hpp"
#include "mansard/formats/plans.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/solid/solid.hpp"
#include "pipeline/houses.hpp"

namespace mansard::pipeline {
namespace {

using test::footprint;
using test::rectangle;

auto reconstructed(const model::Scene& scene, const Options& options = {}) -> report::Reconstruction {
  auto result = reconstruct(scene, options);
  EXPECT_TRUE(result) << base::to_string(result.error());
  return std::move(*result);
}

void expect_valid(const report::Reconstruction& r) {
  for (const auto& building : r.city.buildings)
    for (const auto& part : building.parts) EXPECT_THAT(solid::check(part.model.solid), testing::IsEmpty()) << part.id;
}

TEST(Reconstruct, raises_a_gabled_house_as_it_stands) {
  const auto r = reconstructed(test::lone_house());
  ASSERT_EQ(r.city.buildings.size(), 1U);
  ASSERT_EQ(r.city.buildings[0].parts.size(), 1U);
  EXPECT_EQ(r.buildings[0].outcome, report::Outcome::full) << base::to_string(r.buildings[0].reasons.at(0));
  expect_valid(r);
  EXPECT_NEAR(r.buildings[0].volume, 12 * 8 * 5 + 12 * 8 * 3 / 2, 15);
  EXPECT_NEAR(r.buildings[0].roof_max, 8, 0.3);
  EXPECT_LT(r.scores.footprint_mse, 0.05);
  EXPECT_LT(r.scores.missed, 3);
  const auto& areas = r.buildings[0].areas;
  EXPECT_NEAR(areas.roof_sloped, 2 * 12 * 5, 5);              // each slope is 5 m from eaves to ridge
  EXPECT_NEAR(areas.wall, 2 * 12 * 5 + 2 * (8 * 5 + 12), 8);  // the gables are wall up to the ridge
}

auto value(const model::Attributes& attributes, std::string_view name) -> double {
  for (const auto& [key, found] : attributes)
    if (key == name) return std::get<double>(found);
  return std::nan("");
}

TEST(Reconstruct, has_no_ridge_above_the_highest_point_of_the_roof) {
  const auto r = reconstructed(test::lone_house());
  const auto& building = r.city.buildings.at(0);
  double ridge = 0, top = 0;
  for (const auto& part : building.parts) {
    for (const auto& v : part.model.solid.vertices)
      top = std::max(top, v.z + static_cast<double>(r.city.frame.origin[2]));
    ridge = value(part.attributes, "ms_h_ridge");
    EXPECT_GE(value(part.attributes, "ms_h_roof_max"), ridge) << part.id;
  }
  EXPECT_DOUBLE_EQ(value(building.attributes, "ms_h_roof_max"), top);
  EXPECT_DOUBLE_EQ(r.buildings[0].roof_max, top);
}

TEST(Reconstruct, sees_nothing_through_the_place_of_a_crown) {
  // A flat roof of small triangles under a lumpy crown, and below it the ground in two large ones, whose middles are
  // far from the crown.
  auto scene = test::terrace();
  scene.mesh = {};
  test::add_quad(scene.mesh, {-20, -20, 0}, {50, -20, 0}, {50, 40, 0}, {-20, 40, 0});
  test::add_house(scene.mesh, 0, 0, 12, 10, 6, 6);
  scene.mesh.triangles.resize(scene.mesh.triangles.size() - 4);  // its roof
  for (int i = 0; i < 24; ++i)
    for (int j = 0; j < 20; ++j) {
      const double x = i / 2.0, y = j / 2.0;
      test::add_quad(scene.mesh, {x, y, 6}, {x + 0.5, y, 6}, {x + 0.5, y + 0.5, 6}, {x, y + 0.5, 6});
    }
  const auto crown = [](int around, int up) -> geometry::Point3 {
    const double a = around * std::numbers::pi / 16, e = (up / 16.0 - 0.5) * std::numbers::pi;
    const double r = 2.6 + 0.25 * std::sin(5 * a + 3 * e) * std::cos(4 * e + a);
    return {8 + r * std::cos(e) * std::cos(a), 5 + r * std::cos(e) * std::sin(a), 9.2 + r * std::sin(e)};
  };
  for (int up = 0; up < 16; ++up)
    for (int i = 0; i < 32; ++i)
      test::add_quad(scene.mesh, crown(i, up), crown(i + 1, up), crown(i + 1, up + 1), crown(i, up + 1));
  scene.footprints.resize(1);

  const auto r = reconstructed(scene);
  EXPECT_THAT(r.warnings, testing::Contains(testing::Field(&base::Diagnostic::code, "vegetation-crowns")));
  EXPECT_EQ(r.buildings.at(0).parts, 1U);
  EXPECT_NEAR(r.buildings.at(0).volume, 12 * 10 * 6, 5);
  EXPECT_NEAR(r.buildings.at(0).roof_min, 6, 0.1);
  // What is below the crown, of 21 m² and what is next to it, counts as not seen.
  EXPECT_GT(value(r.city.buildings.at(0).attributes, "ms_nodata_share"), 21.0 / 120);
  EXPECT_LT(value(r.city.buildings.at(0).attributes, "ms_nodata_share"), 0.5);
}

TEST(Reconstruct, keeps_the_identity_of_every_feature) {
  const auto r = reconstructed(test::terrace());
  ASSERT_EQ(r.city.buildings.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& building = r.city.buildings[i];
    EXPECT_EQ(building.id, i == 0 ? "low" : "high");
    EXPECT_EQ(building.attributes.front().first, "use");
    ASSERT_EQ(building.parts.size(), 1U);
    EXPECT_EQ(r.buildings[i].outcome, report::Outcome::full);
    EXPECT_NEAR(r.buildings[i].roof_max, i == 0 ? 6 : 9, 0.2);
    EXPECT_GT(r.buildings[i].areas.party_wall, 40);
  }
  expect_valid(r);
  EXPECT_EQ(r.blocks.size(), 1U);
  EXPECT_EQ(r.blocks[0].status, "optimal");
  EXPECT_NEAR(r.blocks[0].objective, r.blocks[0].bound, 1e-3);
}

TEST(Reconstruct, does_the_same_on_coordinates_far_from_the_origin) {
  auto moved = test::lone_house();
  for (auto& v : moved.mesh.vertices) v = v + geometry::Point3{300, -200, 40};
  for (auto& p : moved.footprints[0].polygons[0].outer) p = p + geometry::Point2{300, -200};
  const auto here = reconstructed(test::lone_house()), there = reconstructed(moved);
  EXPECT_NEAR(here.buildings[0].volume, there.buildings[0].volume, 2);
  EXPECT_NEAR(there.buildings[0].ground, 40, 0.1);
}

TEST(Reconstruct, gives_the_same_bytes_at_any_thread_count) {
  auto scene = test::terrace();
  test::add_house(scene.mesh, 0, 20, 9, 27, 4, 6);
  scene.footprints.push_back(footprint("behind", rectangle(0, 20, 9, 27)));
  std::vector<std::string> files;
  for (const std::size_t threads : {1, 2, 2}) {
    base::limit_threads(threads);
    const auto r = reconstructed(scene);
    files.push_back(*formats::cityjson(r.city) + formats::plans(r.city));
  }
  base::limit_threads(0);
  EXPECT_EQ(files[0], files[1]);
  EXPECT_EQ(files[1], files[2]);
}

TEST(Reconstruct, lets_a_bad_footprint_affect_no_other) {
  auto scene = test::lone_house();
  model::Footprint bad;
  bad.id = "bad";
  bad.defect = base::error("ingest-footprint-geometry", "crosses itself", "bad");
  scene.footprints.insert(scene.footprints.begin(), bad);
  const auto r = reconstructed(scene);
  ASSERT_EQ(r.buildings.size(), 2U);
  EXPECT_EQ(r.buildings[0].outcome, report::Outcome::refused);
  EXPECT_EQ(r.buildings[0].reasons.at(0).message, "crosses itself");
  EXPECT_EQ(r.buildings[1].outcome, report::Outcome::full);
  const auto alone = reconstructed(test::lone_house());
  EXPECT_EQ(r.city.buildings[1].parts[0].plan, alone.city.buildings[0].parts[0].plan);
}

TEST(Reconstruct, raises_a_footprint_without_mesh_as_a_prism_and_says_so) {
  auto scene = test::lone_house();
  scene.footprints.push_back(footprint("nowhere", rectangle(60, 60, 70, 68)));
  scene.footprints.push_back(footprint("far", rectangle(500, 100, 510, 108)));
  Options options;
  options.assumed_height = 4;
  const auto r = reconstructed(scene, options);
  EXPECT_EQ(r.buildings[1].outcome, report::Outcome::fallback);
  EXPECT_EQ(r.buildings[1].reasons.at(0).code, "pipeline-no-mesh");
  EXPECT_NEAR(r.buildings[1].volume, 10 * 8 * 4, 1e-6);
  EXPECT_EQ(r.buildings[2].outcome, report::Outcome::refused);
  EXPECT_EQ(r.buildings[2].reasons.at(0).code, "pipeline-no-ground");
  expect_valid(r);
}

TEST(Reconstruct, leaves_a_footprint_over_which_nothing_is_seen_without_a_model_and_says_so) {
  auto scene = test::lone_house();
  scene.footprints.push_back(footprint("nowhere", rectangle(60, 60, 70, 68)));
  auto outside = footprint("outside", rectangle(900, 900, 910, 908));
  outside.defect = base::error("ingest-footprint-outside", "it lies outside the mesh", "outside");
  scene.footprints.push_back(outside);
  const auto r = reconstructed(scene);
  EXPECT_EQ(r.buildings[0].outcome, report::Outcome::full);
  for (const std::size_t i : {1, 2}) {
    EXPECT_EQ(r.buildings[i].outcome, report::Outcome::refused);
    EXPECT_EQ(r.buildings[i].parts, 0U);
    EXPECT_THAT(r.city.buildings[i].parts, testing::IsEmpty());
    EXPECT_THAT(r.city.buildings[i].footprint, testing::SizeIs(1)) << "written as LoD 0";
    EXPECT_TRUE(std::isnan(value(r.city.buildings[i].attributes, "ms_volume_lod22")));
  }
  EXPECT_EQ(r.buildings[1].reasons.at(0).code, "pipeline-no-mesh");
  EXPECT_EQ(r.buildings[2].reasons.at(0).code, "ingest-footprint-outside");
}

TEST(Reconstruct, continues_a_roof_of_which_the_scan_shows_a_half_and_says_so) {
  auto scene = test::lone_house();
  scene.mesh = {};  // the scan ends in the middle of the house
  test::add_quad(scene.mesh, {-20, -20, 0}, {6, -20, 0}, {6, 40, 0}, {-20, 40, 0});
  for (const bool south : {true, false}) {
    const double eaves = south ? 0 : 8;
    test::add_quad(scene.mesh, {0, eaves, 0}, {6, eaves, 0}, {6, eaves, 5}, {0, eaves, 5});
    test::add_quad(scene.mesh, {0, eaves, 5}, {6, eaves, 5}, {6, 4, 8}, {0, 4, 8});
  }
  test::add_quad(scene.mesh, {0, 8, 0}, {0, 0, 0}, {0, 0, 5}, {0, 8, 5});
  test::add_triangle(scene.mesh, {0, 8, 5}, {0, 0, 5}, {0, 4, 8});
  const auto r = reconstructed(scene);
  EXPECT_NEAR(r.buildings.at(0).volume, 12 * 8 * 5 + 12 * 8 * 3 / 2, 15);
  EXPECT_NEAR(value(r.city.buildings[0].attributes, "ms_nodata_share"), 0.5, 0.06);
  EXPECT_THAT(r.buildings[0].reasons,
              testing::Contains(testing::Field(&base::Diagnostic::code, "pipeline-partly-seen")));
  expect_valid(r);
}

TEST(Reconstruct, says_what_the_height_of_the_ground_comes_from) {
  const auto source_of = [](const model::Scene& scene, const Options& options = {}) {
    const auto r = reconstructed(scene, options);
    for (const auto& [name, found] : r.city.buildings.at(0).attributes)
      if (name == "ms_ground_source") return std::get<std::string>(found);
    return std::string("none");
  };
  auto scene = test::lone_house();
  EXPECT_EQ(source_of(scene), "scan");
  scene.footprints[0].ground = -1;
  EXPECT_EQ(source_of(scene), "attribute");
  scene.footprints[0].ground.reset();
  scene.roofs_only = true;
  EXPECT_EQ(source_of(scene), "assumed");
  const auto r = reconstructed(scene);
  EXPECT_THAT(r.buildings[0].reasons,
              testing::Contains(testing::Field(&base::Diagnostic::code, "block-ground-assumed")));
  Options options;
  options.block.ground_height = 1.5;
  EXPECT_EQ(source_of(scene, options), "option");
  EXPECT_NEAR(reconstructed(scene, options).buildings[0].ground, 1.5, 1e-3);
}

TEST(Reconstruct, raises_a_footprint_on_bare_ground_as_a_low_prism_and_says_so) {
  auto scene = test::lone_house();
  scene.footprints.push_back(footprint("meadow", rectangle(22, 22, 30, 30)));
  const auto r = reconstructed(scene);
  EXPECT_EQ(r.buildings[1].outcome, report::Outcome::fallback);
  EXPECT_EQ(r.buildings[1].reasons.at(0).code, "pipeline-low");
  expect_valid(r);
}

TEST(Reconstruct, stops_on_request) {
  base::Cancel cancel;
  cancel.request();
  base::Run run;
  run.cancel = &cancel;
  const auto result = reconstruct(test::lone_house(), {}, run);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, "cancelled");
}

TEST(Reconstruct, fails_when_no_footprint_can_be_used) {
  auto scene = test::lone_house();
  scene.footprints[0].defect = base::error("ingest-footprint-geometry", "no area", "house");
  scene.footprints[0].polygons.clear();
  const auto result = reconstruct(scene, {});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, "pipeline-nothing");
}

TEST(Presets, only_name_options_that_exist) {
  for (const auto& preset : presets()) {
    Options options;
    auto lists = option_lists(options);
    for (const auto& [key, value] : preset.values) {
      const auto set = set_option(lists, key, value);
      EXPECT_TRUE(set) << preset.name << ": " << base::to_string(set.error());
    }
  }
}

TEST(SetOption, names_the_nearest_option_for_a_misspelt_one) {
  Options options;
  auto lists = option_lists(options);
  const auto set = set_option(lists, "sweep.gama", "5");
  ASSERT_FALSE(set);
  EXPECT_EQ(set.error().code, "option-unknown");
  EXPECT_THAT(set.error().message, testing::HasSubstr("'sweep.gamma'"));
}

TEST(SetOption, says_of_an_option_of_earlier_versions_that_it_was_removed) {
  Options options;
  auto lists = option_lists(options);
  const auto gone = set_option(lists, "profile.step", "1"), merged = set_option(lists, "profile.assumed_storey", "4");
  ASSERT_FALSE(gone);
  ASSERT_FALSE(merged);
  EXPECT_EQ(gone.error().code, "option-unknown");
  EXPECT_THAT(gone.error().message, testing::HasSubstr("was removed"));
  EXPECT_THAT(merged.error().message, testing::HasSubstr("use 'pipeline.assumed_height'"));
  for (const auto& list : lists)
    for (const auto& option : list.options()) EXPECT_EQ(why_removed(list.module() + "." + option.name), "");
}

TEST(OptionLists, have_a_meaning_for_every_option_and_no_name_twice) {
  Options options;
  std::set<std::string> names;
  for (const auto& list : option_lists(options))
    for (const auto& option : list.options()) {
      EXPECT_FALSE(option.meaning.empty()) << option.name;
      EXPECT_TRUE(names.insert(list.module() + "." + option.name).second) << option.name;
      if (!option.alias.empty()) {
        EXPECT_TRUE(names.insert(option.alias).second) << option.alias;
      }
    }
}

/// Those of the modules whose numbers have been gone through.
TEST(OptionLists, say_where_every_default_comes_from) {
  const std::set<std::string> modules{"block", "slice", "sweep", "fracture", "segment", "profile", "derive", "label"};
  Options options;
  for (const auto& list : option_lists(options))
    for (const auto& option : list.options()) {
      EXPECT_TRUE(!modules.contains(list.module()) || !option.source.empty()) << list.module() << "." << option.name;
      EXPECT_TRUE(!option.advanced || option.alias.empty()) << option.name;
    }
}

TEST(OptionLists, take_every_default_that_they_show) {
  Options options;
  for (const auto& list : option_lists(options))
    for (const auto& option : list.options()) {
      const auto value = option.get();
      if (value.empty() && option.kind != base::Option::Kind::string) continue;  // a number that is absent
      EXPECT_TRUE(option.set(value)) << list.module() << "." << option.name << " = " << value;
      EXPECT_EQ(option.get(), value) << option.name;
    }
}

TEST(MadeBy, has_advanced_options_in_files_only_where_they_differ_and_all_in_the_report) {
  const auto scene = test::lone_house();
  const auto usual = reconstructed(scene);
  Options options;
  options.sweep.column_width = 0.25;
  const auto other = reconstruct(scene, options);
  ASSERT_TRUE(other);
  const auto has = [](const auto& pairs, const std::string& name) {
    return std::ranges::any_of(pairs, [&](const auto& pair) { return pair.first == name; });
  };
  EXPECT_TRUE(has(usual.city.made_by.options, "sweep.gamma"));
  EXPECT_FALSE(has(usual.city.made_by.options, "sweep.column_width"));
  EXPECT_TRUE(has(other->city.made_by.options, "sweep.column_width"));
  EXPECT_FALSE(has(other->city.made_by.options, "sweep.column_gap"));
  const auto report = nlohmann::json::parse(report::run_json(usual, scene));
  EXPECT_EQ(report["options"]["sweep.column_width"], "0.2");
}

TEST(Codes, are_listed_once_with_cause_and_remedy) {
  std::set<std::string> seen;
  for (const auto& code : codes()) {
    EXPECT_TRUE(seen.insert(code.code).second) << code.code;
    EXPECT_FALSE(code.cause.empty() || code.remedy.empty()) << code.code;
  }
}

}  // namespace
}  // namespace mansard::pipeline
