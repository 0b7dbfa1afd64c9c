// The stages up to the segmentation: alone, and as part of a reconstruction.
#include <gmock/gmock.h>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "mansard/formats/documents.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/report/layers.hpp"
#include "pipeline/houses.hpp"

namespace mansard::pipeline {
namespace {

using testing::IsEmpty;

auto segmented(const model::Scene& scene, const Options& options = {}) -> report::Segmented {
  auto result = segment(scene, options);
  EXPECT_TRUE(result) << base::to_string(result.error());
  return std::move(*result);
}

auto layers_of(const model::Scene& scene) -> std::vector<formats::Layer> {
  const auto result = segmented(scene);
  return report::segment_layers(scene, result.segmented, result.made_by);
}

auto named(const std::vector<formats::Layer>& layers, const std::string& name) -> const formats::Layer& {
  return *std::ranges::find(layers, name, &formats::Layer::name);
}

TEST(Segment, leaves_the_other_blocks_alone_when_one_fails_and_says_so) {
  const auto good = test::town(), bad = test::with_a_bad_block(good);
  const auto alone = segmented(good), together = segmented(bad);
  ASSERT_EQ(together.blocks.size(), alone.blocks.size() + 1);
  EXPECT_EQ(together.blocks.back().status, "failed");
  ASSERT_TRUE(together.segmented.back().failure);
  EXPECT_EQ(together.segmented.back().failure->code, "pipeline-no-ground");
  EXPECT_THAT(together.warnings, testing::Contains(*together.segmented.back().failure));
  const auto before = report::segment_layers(good, alone.segmented, alone.made_by);
  const auto after = report::segment_layers(bad, together.segmented, together.made_by);
  for (const auto* name : {"faces", "edges", "conflicts", "footprints"}) {
    const auto &one = named(before, name), &other = named(after, name);
    ASSERT_EQ(one.features.size(), other.features.size()) << name;
    for (std::size_t i = 0; i < one.features.size(); ++i) EXPECT_EQ(one.features[i].values, other.features[i].values);
  }
  EXPECT_TRUE(formats::geopackage(after, bad.frame));
  const auto report = nlohmann::json::parse(report::run_json(together, bad));
  EXPECT_EQ(report["blocks"].back()["objective"]["status"], "failed");
  EXPECT_EQ(report["counts"]["without_part"], 1);
}

TEST(Segment, gives_the_same_geopackage_at_any_thread_count) {
  const auto scene = test::town();
  std::vector<std::string> files;
  for (const std::size_t threads : {1U, 2U, 4U}) {
    base::limit_threads(threads);
    files.push_back(*formats::geopackage(layers_of(scene), scene.frame));
  }
  base::limit_threads(0);
  EXPECT_TRUE(files[0] == files[1]);
  EXPECT_TRUE(files[0] == files[2]);
}

TEST(Segment, reports_every_term_and_a_relative_gap) {
  const auto scene = test::town();
  const auto report = nlohmann::json::parse(report::run_json(segmented(scene), scene));
  EXPECT_FALSE(report.contains("scores") || report.contains("buildings"));
  ASSERT_EQ(report["blocks"].size(), 2U);
  for (const auto& block : report["blocks"]) {
    EXPECT_FALSE(block.contains("scores"));
    const auto& o = block["objective"];
    double sum = 0;
    for (const auto* term : {"sweep_unused", "unsupported", "height", "thin", "gis_unused"})
      sum += o[term].get<double>();
    EXPECT_NEAR(sum, o["total"].get<double>(), 1e-9);
    EXPECT_EQ(o["status"], "optimal");
    EXPECT_EQ(o["relative_gap"], 0.0);
    EXPECT_GT(block["parts"], 0);
  }
  for (const auto* stage : {"block", "slice", "sweep", "fracture", "segment"})
    EXPECT_TRUE(report["times"]["stages"].contains(stage)) << stage;
}

TEST(Segment, fails_as_reconstruct_does) {
  base::Cancel cancel;
  cancel.request();
  base::Run run;
  run.cancel = &cancel;
  EXPECT_EQ(segment(test::town(), {}, run).error().code, "cancelled");
  EXPECT_EQ(segment({}, {}).error().code, "pipeline-nothing");
}

TEST(Reconstruct, keeps_the_segmentations_when_asked_and_they_are_those_of_segment) {
  const auto scene = test::town();
  const auto asked = reconstruct(scene, {}, {}, Keep::segmentations);
  ASSERT_TRUE(asked);
  const auto layers = report::segment_layers(scene, asked->segmented, asked->city.made_by);
  EXPECT_TRUE(*formats::geopackage(layers, scene.frame) == *formats::geopackage(layers_of(scene), scene.frame));
  const auto unasked = reconstruct(scene, {});
  ASSERT_TRUE(unasked);
  EXPECT_THAT(unasked->segmented, IsEmpty());
  EXPECT_EQ(*formats::cityjson(asked->city), *formats::cityjson(unasked->city));
}

}  // namespace
}  // namespace mansard::pipeline
