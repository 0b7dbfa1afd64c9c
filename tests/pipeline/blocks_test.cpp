// Runs of some blocks only, and plans raised again.
#include <gmock/gmock.h>

#include "mansard/formats/documents.hpp"
#include "mansard/formats/plans.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "pipeline/houses.hpp"

namespace mansard::pipeline {
namespace {

using test::footprint;
using test::rectangle;
using testing::HasSubstr;

/// A terrace of two, a house behind it, and one that cannot be used.
auto street() -> model::Scene {
  auto scene = test::terrace();
  model::Footprint bad;
  bad.id = "bad";
  bad.defect = base::error("ingest-footprint-geometry", "crosses itself", "bad");
  scene.footprints.insert(scene.footprints.begin(), bad);
  test::add_house(scene.mesh, 0, 24, 12, 32, 5, 8);
  scene.footprints.push_back(footprint("behind", rectangle(0, 24, 12, 32)));
  return scene;
}

auto run_of(const model::Scene& scene, const std::vector<std::string>& only) -> report::Reconstruction {
  auto result = reconstruct(scene, {}, {}, Keep::segmentations, only);
  EXPECT_TRUE(result) << base::to_string(result.error());
  return std::move(*result);
}

TEST(SomeBlocks, come_out_as_in_a_run_of_all) {
  const auto scene = street();
  const auto all = run_of(scene, {});
  ASSERT_EQ(all.blocks.size(), 2U);
  ASSERT_EQ(all.blocks[1].name, "block-" + scene.footprints[3].id);
  for (std::size_t b = 0; b < 2; ++b) {
    const auto some = run_of(scene, {all.blocks[b].name});
    ASSERT_EQ(some.blocks.size(), 1U);
    EXPECT_EQ(some.blocks[0].name, all.blocks[b].name);
    EXPECT_EQ(some.blocks[0].scores.mse, all.blocks[b].scores.mse);
    EXPECT_EQ(some.error_maps.size(), 1U);
    ASSERT_EQ(some.segmented.size(), 1U);
    EXPECT_EQ(some.segmented[0].features, all.segmented[b].features);
    model::City expected{all.city.frame, all.city.made_by, {}};
    std::vector<std::string> ids;
    for (std::size_t i = 0; i < all.buildings.size(); ++i)
      if (all.buildings[i].block == all.blocks[b].name) {
        expected.buildings.push_back(all.city.buildings[i]);
        ids.push_back(all.buildings[i].id);
      }
    ASSERT_EQ(some.buildings.size(), ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i) EXPECT_EQ(some.buildings[i].id, ids[i]);
    EXPECT_EQ(*formats::cityjson(some.city), *formats::cityjson(expected));
    EXPECT_EQ(formats::plans(some.city), formats::plans(expected));
  }
}

TEST(SomeBlocks, refuse_a_name_that_no_block_has) {
  const auto result =
      reconstruct(street(), {}, {}, Keep::models, std::vector<std::string>{"block-behind", "blokc-behind"});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, "pipeline-block-unknown");
  EXPECT_EQ(result.error().subject, "blokc-behind");
  EXPECT_THAT(result.error().message, HasSubstr("did you mean 'block-behind'"));
}

TEST(RaisePlans, makes_the_models_of_the_run_again) {
  const auto run = run_of(street(), {});
  auto plans = run.city;
  for (auto& building : plans.buildings)
    for (auto& part : building.parts) part.model = {};
  const auto raised = raise_plans(std::move(plans), {});
  ASSERT_TRUE(raised);
  EXPECT_TRUE(raised->fell_short.empty());
  EXPECT_EQ(*formats::cityjson(raised->city), *formats::cityjson(run.city));
  EXPECT_EQ(*formats::glb(raised->city), *formats::glb(run.city));
}

TEST(RaisePlans, names_the_parts_that_have_no_solid_and_gives_the_others) {
  const auto whole = run_of(street(), {}).city;
  auto city = whole;
  std::size_t parts = 0;
  for (auto& building : city.buildings) {
    parts += building.parts.size();
    if (building.id == "high") building.parts[0].plan.cap = -1;
  }
  const auto raised = raise_plans(city, {});
  ASSERT_TRUE(raised);
  ASSERT_EQ(raised->refused.size(), 1U);
  EXPECT_EQ(raised->refused[0].code, "extrude-cap");
  EXPECT_EQ(raised->refused[0].subject, "high-1");
  std::size_t left = 0;
  for (const auto& building : raised->city.buildings)
    for (const auto& part : building.parts) {
      ++left;
      EXPECT_FALSE(part.model.solid.faces.empty()) << part.id;
    }
  EXPECT_EQ(left, parts - 1);
  for (auto& building : city.buildings)
    for (auto& part : building.parts) part.plan.cap = -1;
  const auto none = raise_plans(std::move(city), {});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.errors().size(), parts);
}

TEST(RaisePlans, stops_on_request) {
  base::Cancel cancel;
  cancel.request();
  base::Run run;
  run.cancel = &cancel;
  EXPECT_EQ(raise_plans(run_of(street(), {}).city, {}, run).error().code, "cancelled");
}

}  // namespace
}  // namespace mansard::pipeline
