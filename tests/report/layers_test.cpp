// The segmentation as layers: that they hold what the program measured and decided, and say why in words.
#include <gmock/gmock.h>
#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "mansard/formats/documents.hpp"
#include "mansard/formats/layers.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/report/layers.hpp"
#include "pipeline/houses.hpp"

namespace mansard::report {
namespace {

using model::Value;
using testing::HasSubstr;
using testing::IsEmpty;

auto segmented(const model::Scene& scene, const pipeline::Options& options = {}) -> Segmented {
  auto result = pipeline::segment(scene, options);
  EXPECT_TRUE(result) << base::to_string(result.error());
  return std::move(*result);
}

auto layers_of(const model::Scene& scene, const pipeline::Options& options = {}) -> std::vector<formats::Layer> {
  const auto result = segmented(scene, options);
  return segment_layers(scene, result.segmented, result.made_by);
}

auto named(const std::vector<formats::Layer>& layers, const std::string& name) -> const formats::Layer& {
  return *std::ranges::find(layers, name, &formats::Layer::name);
}

/// A column of a layer, row by row.
auto column(const formats::Layer& layer, const std::string& field) -> std::vector<Value> {
  const auto at = std::ranges::find(layer.fields, field, &formats::Field::name) - layer.fields.begin();
  std::vector<Value> values;
  for (const auto& feature : layer.features) values.push_back(feature.values.at(static_cast<std::size_t>(at)));
  return values;
}
template <class T>
auto column_of(const formats::Layer& layer, const std::string& field) -> std::vector<T> {
  std::vector<T> values;
  for (const auto& value : column(layer, field)) values.push_back(std::get<T>(value));
  return values;
}

TEST(SegmentLayers, are_seven_and_a_geopackage_takes_them) {
  const auto layers = layers_of(test::town());
  std::vector<std::string> names;
  for (const auto& layer : layers) names.push_back(layer.name);
  EXPECT_THAT(names, testing::ElementsAre("gis_footprints", "sweep_edges", "faces", "edges", "conflicts", "footprints",
                                          "made_by"));
  for (const auto& layer : layers) {
    if (layer.name == "made_by") continue;
    const std::set<Value> known{std::string("block-low"), std::string("block-wings")};
    for (const auto& block : column(layer, "block")) EXPECT_TRUE(known.contains(block)) << layer.name;
  }
  for (const auto* name : {"gis_footprints", "sweep_edges", "faces", "edges", "footprints", "made_by"})
    EXPECT_FALSE(named(layers, name).features.empty()) << name;
  const auto bytes = formats::geopackage(layers, test::town().frame);
  EXPECT_TRUE(bytes) << base::to_string(bytes.error());
}

TEST(SegmentLayers, have_costs_that_add_up_to_the_objective) {
  const std::filesystem::path folder = std::filesystem::path(MANSARD_DATA) / "b9";  // torn walls: every term is paid
  const auto scene = ingest::read_scene({folder / "mesh.off"}, folder / "footprints.geojson", {});
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  pipeline::Options options;
  options.segment.gis_edges = segment::GisEdges::candidate;
  auto result = segmented(*scene, options);
  for (auto& block : result.segmented)  // what is joined or left out afterwards is not the objective's business
    for (auto& candidate : block.segmentation.value().candidates) candidate.chosen = false;
  double objective = 0;
  for (const auto& block : result.blocks) objective += block.objective;
  const auto layers = segment_layers(*scene, result.segmented, result.made_by);
  const auto& edges = named(layers, "edges");
  const auto cut = column_of<double>(edges, "cost_if_cut"), uncut = column_of<double>(edges, "cost_if_uncut");
  const auto solved = column_of<bool>(edges, "solved");
  double sum = 0;
  for (std::size_t i = 0; i < solved.size(); ++i) sum += solved[i] ? cut[i] : uncut[i];
  const auto& conflicts = named(layers, "conflicts");
  const auto second = column(conflicts, "second");
  const auto phi = column_of<double>(conflicts, "phi");
  const auto paid = column_of<bool>(conflicts, "paid");
  for (std::size_t i = 0; i < paid.size(); ++i)  // those with the outline are in the edges' costs
    if (paid[i] && !std::holds_alternative<std::monostate>(second[i])) sum += phi[i];
  EXPECT_GT(objective, 1000);
  EXPECT_TRUE(std::ranges::count(paid, true) > 0);
  EXPECT_NEAR(sum, objective, 1e-6);
  const auto parts_of = [&](const std::vector<const char*>& names) {
    std::vector<double> total(solved.size(), 0);
    for (const auto* name : names) {
      const auto costs = column_of<double>(edges, name);
      for (std::size_t i = 0; i < total.size(); ++i) total[i] += costs[i];
    }
    return total;
  };
  EXPECT_THAT(parts_of({"cost_unsupported", "cost_outline_conflict"}), testing::Pointwise(testing::DoubleEq(), cut));
  EXPECT_THAT(parts_of({"cost_sweep_unused", "cost_height", "cost_gis_unused"}),
              testing::Pointwise(testing::DoubleNear(1e-9), uncut));
}

TEST(SegmentLayers, give_faces_and_parts_that_belong_together) {
  const auto layers = layers_of(test::town());
  const auto& faces = named(layers, "faces");
  const auto& footprints = named(layers, "footprints");
  std::map<std::pair<Value, Value>, double> area, count;  // by block and part
  for (std::size_t f = 0; f < faces.features.size(); ++f) {
    const auto key = std::pair(column(faces, "block")[f], column(faces, "part")[f]);
    area[key] += std::get<double>(column(faces, "area")[f]);
    count[key] += 1;
    EXPECT_NEAR(geometry::area(faces.features[f].polygons.at(0)), std::get<double>(column(faces, "area")[f]), 1e-6);
  }
  ASSERT_GE(footprints.features.size(), 3U);
  for (std::size_t p = 0; p < footprints.features.size(); ++p) {
    const auto key = std::pair(column(footprints, "block")[p], column(footprints, "number")[p]);
    EXPECT_NEAR(column_of<double>(footprints, "area")[p], area.at(key), 0.5);  // corners within 1 cm are dropped
    EXPECT_EQ(static_cast<double>(column_of<std::int64_t>(footprints, "faces")[p]), count.at(key));
  }
}

TEST(SegmentLayers, give_heights_in_the_frame_of_the_file) {
  const auto layers = layers_of(test::town());
  const auto& footprints = named(layers, "footprints");
  std::map<std::string, double> height;
  for (std::size_t p = 0; p < footprints.features.size(); ++p)
    height[column_of<std::string>(footprints, "feature")[p]] = column_of<double>(footprints, "height")[p];
  EXPECT_NEAR(height["low"], 106, 0.1);
  EXPECT_NEAR(height["high"], 109, 0.1);
  for (const double low : column_of<double>(named(layers, "sweep_edges"), "low")) EXPECT_GE(low, 99.9);
}

TEST(DiagnosticsLayer, has_a_row_for_every_reason_with_the_footprint_it_is_about) {
  auto scene = test::town();
  model::Footprint bad = test::footprint("bad", {{{50, 0}, {60, 0}, {60, 10}}, {}});
  bad.polygons.clear();
  bad.defect = base::error("ingest-footprint-empty", "it has no geometry", "bad");
  scene.footprints.push_back(bad);
  scene.warnings.push_back(base::warning("ingest-mesh-duplicate", "two triangles are there twice", "mesh.ply"));
  const auto result = pipeline::reconstruct(scene, {});
  ASSERT_TRUE(result) << base::to_string(result.error());
  const auto layer = diagnostics_layer(*result, scene);
  std::size_t reasons = scene.warnings.size() + result->warnings.size();
  for (const auto& building : result->buildings) reasons += building.reasons.size();
  EXPECT_EQ(layer.features.size(), reasons);
  EXPECT_THAT(column(layer, "code"), testing::Contains(Value(std::string("ingest-footprint-empty"))));
  EXPECT_THAT(column(layer, "feature"), testing::Contains(Value(std::string("bad"))));
  EXPECT_THAT(column(layer, "subject"), testing::Contains(Value(std::string("mesh.ply"))));
  for (const auto& feature : layer.features) EXPECT_EQ(feature.values.size(), layer.fields.size());
  EXPECT_TRUE(formats::geopackage({layer}, scene.frame));
}

TEST(SegmentLayers, name_variables_as_the_exported_program_does) {
  const auto scene = test::town();
  const auto result = segmented(scene);
  const auto layers = segment_layers(scene, result.segmented, result.made_by);
  const auto& edges = named(layers, "edges");
  for (const auto& block : result.segmented) {
    const auto mps = solver::mps(segment::program_of(*block.segmentation), block.name);
    ASSERT_TRUE(mps);
    std::size_t own = 0;
    for (std::size_t i = 0; i < edges.features.size(); ++i) {
      if (column(edges, "block")[i] != Value(block.name)) continue;
      ++own;
      EXPECT_THAT(*mps, HasSubstr(" " + column_of<std::string>(edges, "variable")[i] + " "));
    }
    EXPECT_EQ(own, block.segmentation->candidates.size());
  }
}

TEST(SegmentLayers, keep_the_sources_attributes_and_what_could_not_be_used) {
  auto scene = test::town();
  scene.footprints[0].attributes = {{"levels", std::int64_t{2}}, {"year", std::int64_t{1900}}, {"use", Value()}};
  scene.footprints[1].attributes = {{"levels", 2.5}, {"year", std::string("unknown")}, {"block", true}};
  scene.footprints[2].defect = base::error("ingest-footprint-crossing", "crosses itself", "wings");
  scene.footprints[2].polygons.clear();
  const auto layers = layers_of(scene);
  const auto& gis = named(layers, "gis_footprints");
  EXPECT_EQ(gis.features.size(), 3U);
  EXPECT_EQ(column(gis, "levels")[0], Value(std::int64_t{2}));
  EXPECT_EQ(column(gis, "levels")[1], Value(2.5));
  EXPECT_EQ(column(gis, "year")[0], Value(std::string("1900")));
  EXPECT_EQ(column(gis, "defect")[1], Value());
  EXPECT_EQ(column(gis, "defect")[2], Value(std::string("crosses itself")));
  EXPECT_EQ(column(gis, "parts")[2], Value(std::int64_t{0}));
  EXPECT_TRUE(formats::geopackage(layers, scene.frame));  // the source's own "block" gets another name
}

TEST(SegmentLayers, say_that_a_wall_is_between_two_features) {
  const auto layers = layers_of(test::terrace());
  const auto& edges = named(layers, "edges");
  std::size_t between = 0;
  for (std::size_t i = 0; i < edges.features.size(); ++i)
    if (column_of<bool>(edges, "forced")[i] && column_of<bool>(edges, "chosen")[i]) {
      ++between;
      EXPECT_EQ(column_of<std::string>(edges, "why")[i], "cut: between two features");
    }
  EXPECT_GT(between, 0U);
}

}  // namespace
}  // namespace mansard::report
