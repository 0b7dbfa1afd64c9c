// Footprints without a mesh, raised by their attributes.
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "mansard/formats/documents.hpp"
#include "mansard/formats/plans.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/solid/solid.hpp"
#include "pipeline/houses.hpp"

namespace mansard::pipeline {
namespace {

using model::Attributes;
using model::Value;
using test::rectangle;
using testing::HasSubstr;
using testing::IsEmpty;

auto tagged(std::string id, geometry::Polygon polygon, Attributes attributes) -> model::Footprint {
  auto footprint = test::footprint(std::move(id), std::move(polygon));
  footprint.attributes = std::move(attributes);
  return footprint;
}

auto raised(const model::Scene& scene, const Options& options = {}) -> report::Reconstruction {
  auto result = raise_footprints(scene, options);
  EXPECT_TRUE(result) << base::to_string(result.error());
  for (const auto& building : result->city.buildings)
    for (const auto& part : building.parts) EXPECT_THAT(solid::check(part.model.solid), IsEmpty()) << part.id;
  return std::move(*result);
}

auto text(const char* value) -> Value { return std::string(value); }

// Two squares joined by a neck, a thin wall around a yard, a needle, and corners near edges: as an editor of plans may
// have them, past every repair of files.
auto narrow_outlines() -> std::vector<geometry::Polygon> {
  std::vector<geometry::Polygon> out;
  for (const double by : {1e-7, 1e-6, 1e-5, 5e-5, 1e-4, 2e-4, 5e-4, 7e-4, 9e-4, 1e-3, 1.1e-3, 2e-3, 5e-3}) {
    const double neck = 6 - by;
    out.push_back({{{0, 0}, {6, 0}, {6, neck}, {12, neck}, {12, 12}, {neck, 12}, {neck, 6}, {0, 6}}, {}});
    out.push_back({rectangle(0, 0, 10, 10).outer, {{{by, by}, {by, 10 - by}, {10 - by, 10 - by}, {10 - by, by}}}});
    out.push_back({{{0, 0}, {10, 0}, {10, by}}, {}});
    out.push_back({{{0, 0}, {8, 0}, {8, 8}, {4, by}, {0, 8}}, {}});
    out.push_back({{{0, 0}, {8, 0}, {8, 8}, {4 + by, 8}, {4 + by, 8 - 6}, {4, 8 - 6}, {4, 8}, {0, 8}}, {}});
    out.push_back({rectangle(0, 0, 10, 10).outer, {{{5, by}, {3, 4}, {7, 4}}}});
  }
  return out;
}

TEST(RaiseFootprints, measures_nothing_that_is_not_there) {
  const char* const shapes[]{"flat", "gabled", "hipped", "mansard"};
  model::Scene scene;
  for (const auto& polygon : narrow_outlines())
    for (const char* shape : shapes) {
      auto one = polygon;
      const auto at = static_cast<double>(scene.footprints.size()) * 40;
      const auto move = [&](geometry::Ring& ring) {
        for (auto& p : ring) p.x += at;
      };
      move(one.outer);
      for (auto& hole : one.holes) move(hole);
      scene.footprints.push_back(tagged(std::to_string(scene.footprints.size()), std::move(one),
                                        {{"roof:shape", text(shape)}, {"height", 9.0}}));
    }
  const auto r = raised(scene);
  std::size_t with = 0, without = 0;
  for (std::size_t i = 0; i < r.buildings.size(); ++i) {
    const auto& [building, report] = std::tie(r.city.buildings[i], r.buildings[i]);
    SCOPED_TRACE(building.id);
    const bool is_there = report.outcome == report::Outcome::full || report.outcome == report::Outcome::fallback;
    (is_there ? with : without) += 1;
    EXPECT_EQ(!building.solids.empty(), is_there);
    EXPECT_EQ(report.parts, building.parts.size());
    EXPECT_EQ(report.parts > 0, is_there);
    EXPECT_EQ(report.volume > 0, is_there);
    double volume = 0;
    std::set<std::size_t> in;
    for (const auto& one : building.solids) {
      EXPECT_THAT(solid::check(one.model.solid, solid::written_rules()), IsEmpty());
      volume += solid::volume(one.model.solid);
      in.insert(one.parts.begin(), one.parts.end());
    }
    EXPECT_EQ(in.size(), building.parts.size());
    EXPECT_NEAR(report.volume, volume, 0.01 * volume + 0.1);
    const auto has = [&](std::string_view name) {
      return std::ranges::any_of(building.attributes, [&](const auto& one) { return one.first == name; });
    };
    EXPECT_EQ(has("ms_volume_lod22"), is_there);
    EXPECT_EQ(has("ms_h_roof_max"), is_there);
    EXPECT_EQ(has("ms_area_wall"), is_there);
    EXPECT_EQ(report.reasons.empty() && !is_there, false);
  }
  EXPECT_GT(with, 100U);
  EXPECT_GT(without, 20U);
}

TEST(RaiseFootprints, gives_walls_and_roofs_the_areas_worked_out_by_hand) {
  model::Scene scene;
  const auto house = [](const char* shape) {
    return Attributes{{"roof:shape", text(shape)}, {"height", 9.0}, {"roof:height", text("3 m")}};
  };
  scene.footprints.push_back(tagged("gabled", rectangle(0, 0, 12, 8), house("gabled")));
  scene.footprints.push_back(tagged("hipped", rectangle(20, 0, 32, 8), house("hipped")));
  scene.footprints.push_back(tagged("flat", rectangle(40, 0, 52, 8), house("flat")));
  const auto r = raised(scene);
  for (const auto& building : r.buildings) {
    EXPECT_EQ(building.outcome, report::Outcome::full);
    EXPECT_EQ(building.roof, building.id);
    EXPECT_EQ(building.height_from, "height");
    EXPECT_NEAR(building.roof_max, 9, 1e-3);
    EXPECT_NEAR(building.areas.ground, 96, 0.01);
    EXPECT_THAT(building.reasons, IsEmpty());
  }
  EXPECT_NEAR(r.buildings[0].areas.roof_sloped, 2 * 12 * 5, 0.01);  // 4 m across and 3 m up are 5 m of roof
  EXPECT_NEAR(r.buildings[0].areas.wall, 40 * 6 + 8 * 3, 0.01);     // and two gables
  EXPECT_NEAR(r.buildings[1].areas.roof_sloped, 96 * 5 / 4.0, 0.01);
  EXPECT_NEAR(r.buildings[1].areas.wall, 40 * 6, 0.01);
  EXPECT_NEAR(r.buildings[2].areas.roof_flat, 96, 0.01);
  EXPECT_NEAR(r.buildings[0].volume, 576 + 144, 0.01);
  const auto& attributes = r.city.buildings[0].parts[0].attributes;
  const auto of = [&](std::string_view name) {
    for (const auto& [key, value] : attributes)
      if (key == name) return value;
    return Value(std::string("none"));
  };
  EXPECT_EQ(of("ms_roof_shape"), text("gabled"));
  EXPECT_NEAR(std::get<double>(of("ms_h_roof_min")), 6, 1e-3);
  EXPECT_NEAR(std::get<double>(of("ms_h_ridge")), 9, 1e-3);
}

TEST(RaiseFootprints, cuts_a_roof_off_flat_that_would_rise_beyond_what_a_plan_can_hold) {
  model::Scene scene;
  scene.footprints.push_back(tagged("small", rectangle(0, 0, 10, 8), {}));
  scene.footprints.push_back(tagged("wide", rectangle(100, 0, 400, 300), {}));
  Options options;
  options.roof.profile = "0,0 0,6 0.01,16";
  const auto r = raised(scene, options);
  EXPECT_EQ(r.buildings[0].outcome, report::Outcome::full);
  ASSERT_EQ(r.buildings[1].outcome, report::Outcome::fallback);
  ASSERT_EQ(r.buildings[1].reasons.size(), 1U);
  EXPECT_EQ(r.buildings[1].reasons[0].code, "extrude-cap");
  EXPECT_THAT(r.buildings[1].reasons[0].message,
              testing::AllOf(HasSubstr("the maximum is 100000 m"), HasSubstr("cut off flat 16.00 m above the base")));
  ASSERT_EQ(r.city.buildings[1].parts.size(), 1U);
  EXPECT_NEAR(r.buildings[1].roof_max, 16, 1e-3);
}

TEST(RaiseFootprints, finds_party_walls_between_neighbours) {
  model::Scene scene;
  for (int i = 0; i < 2; ++i)
    scene.footprints.push_back(tagged(std::to_string(i), rectangle(12 * i, 0, 12 * i + 12, 8), {{"height", 6.0}}));
  const auto r = raised(scene);
  for (const auto& building : r.buildings) EXPECT_NEAR(building.areas.party_wall, 8 * 6, 0.01);
}

TEST(RaiseFootprints, lets_a_bad_building_affect_no_other_and_names_building_and_value) {
  model::Scene scene;
  scene.footprints.push_back(tagged("church", rectangle(0, 0, 12, 8), {{"height", text("tall")}}));
  scene.footprints.push_back(tagged("hole", {}, {{"height", 5.0}}));
  scene.footprints.back().polygons.clear();
  scene.footprints.back().defect = base::error("ingest-footprint-empty", "it has no geometry", "hole");
  scene.footprints.push_back(tagged("barn", rectangle(20, 0, 32, 8),
                                    {{"height", 6.0}, {"roof:shape", text("gabled")}, {"roof:height", text("9")}}));
  scene.footprints.push_back(
      tagged("kiosk", rectangle(40, 0, 44, 4), {{"height", text("-3")}, {"roof:shape", text("crosspitched")}}));
  geometry::Polygon yard = rectangle(60, 0, 80, 20);
  yard.holes.push_back({{66, 6}, {66, 14}, {74, 14}, {74, 6}});
  scene.footprints.push_back(tagged("yard", yard, {{"height", 9.0}, {"roof:shape", text("pyramidal")}}));
  const auto r = raised(scene);
  const auto said = [&](std::size_t i, const char* code, const char* words) {
    for (const auto& reason : r.buildings[i].reasons)
      if (reason.code == code && reason.subject == r.buildings[i].id && reason.message.find(words) != std::string::npos)
        return true;
    return false;
  };
  EXPECT_EQ(r.buildings[0].outcome, report::Outcome::full);
  EXPECT_TRUE(said(0, "roof-value", "\"tall\""));
  EXPECT_EQ(r.buildings[0].height_from, "assumed");
  EXPECT_EQ(r.buildings[1].outcome, report::Outcome::refused);
  EXPECT_EQ(r.buildings[2].outcome, report::Outcome::full);
  EXPECT_TRUE(said(2, "roof-conflict", "roof:height = \"9\""));
  EXPECT_TRUE(said(3, "roof-value", "\"-3\""));
  EXPECT_TRUE(said(3, "roof-shape-unknown", "\"crosspitched\""));
  EXPECT_EQ(r.buildings[3].roof, "gabled");
  EXPECT_EQ(r.buildings[4].outcome, report::Outcome::fallback);
  EXPECT_TRUE(said(4, "roof-shape-here", "hipped"));
  EXPECT_EQ(r.buildings[4].roof, "hipped");
  ASSERT_EQ(r.warnings.size(), 1U);
  EXPECT_THAT(r.warnings[0].message, HasSubstr("2 of 5 buildings"));
}

TEST(RaiseFootprints, takes_one_profile_for_every_edge) {
  model::Scene scene;
  scene.footprints.push_back(tagged("a", rectangle(0, 0, 12, 8), {{"height", 50.0}, {"min_height", 3.0}}));
  Options options;
  options.roof.profile = "0,0 0,6 4,9";
  const auto r = raised(scene, options);
  EXPECT_NEAR(r.buildings[0].volume, 576 + 3 * (4 * 4 + 64 / 3.0), 0.01);
  EXPECT_EQ(r.buildings[0].height_from, "profile");
  options.roof.profile = "0,0 -1,6";
  const auto bad = raise_footprints(scene, options);
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().code, "roof-profile");
  options.roof.profile.clear();
  options.roof.building_height_attribute = "hoogte";
  const auto missing = raise_footprints(scene, options);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, "roof-attribute");
  EXPECT_EQ(raise_footprints({}, {}).error().code, "pipeline-nothing");
}

TEST(RaiseFootprints, gives_the_same_bytes_at_any_thread_count) {
  model::Scene scene;
  const std::vector<const char*> shapes{"flat", "gabled", "hipped", "skillion", "mansard", "pyramidal", "tall"};
  for (int i = 0; i < 60; ++i)
    scene.footprints.push_back(tagged(std::to_string(i), rectangle(15 * i, 0, 15 * i + 9 + i % 5, 8),
                                      {{"building:levels", std::int64_t{1 + i % 6}},
                                       {"roof:shape", text(shapes[static_cast<std::size_t>(i) % shapes.size()])}}));
  std::vector<std::string> bytes;
  for (const std::size_t threads : {1U, 2U, 4U}) {
    base::limit_threads(threads);
    auto r = raised(scene);
    r.times = {};
    bytes.push_back(*formats::cityjson(r.city) + report::run_json(r, scene));
  }
  base::limit_threads(0);
  EXPECT_EQ(bytes[0], bytes[1]);
  EXPECT_EQ(bytes[0], bytes[2]);
}

TEST(RaiseFootprints, reports_every_building_without_blocks_or_scores) {
  model::Scene scene;
  scene.footprints.push_back(tagged("a", rectangle(0, 0, 12, 8), {{"height", 6.0}}));
  const auto report = nlohmann::json::parse(report::run_json(raised(scene), scene));
  EXPECT_EQ(report["counts"]["full"], 1);
  EXPECT_FALSE(report.contains("mesh") || report.contains("scores") || report.contains("blocks"));
  EXPECT_EQ(report["buildings"][0]["roof"], "flat");
  EXPECT_EQ(report["buildings"][0]["height_from"], "height");
  EXPECT_EQ(report["options"]["roof.default_height"], "6");
}

TEST(RaiseFootprints, stops_when_asked) {
  model::Scene scene;
  scene.footprints.push_back(tagged("a", rectangle(0, 0, 12, 8), {{"height", 6.0}}));
  base::Cancel cancel;
  cancel.request();
  base::Run run;
  run.cancel = &cancel;
  EXPECT_EQ(raise_footprints(scene, {}, run).error().code, "cancelled");
}

}  // namespace
}  // namespace mansard::pipeline
