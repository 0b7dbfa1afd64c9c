#include "mansard/report/report.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "mansard/pipeline/pipeline.hpp"
#include "mansard/report/pictures.hpp"
#include "mansard/solid/solid.hpp"
#include "pipeline/houses.hpp"

namespace mansard::report {
namespace {

auto reconstructed(const model::Scene& scene) -> Reconstruction {
  auto result = pipeline::reconstruct(scene, {});
  EXPECT_TRUE(result) << base::to_string(result.error());
  return std::move(*result);
}

TEST(Report, counts_every_footprint_and_every_term) {
  const auto scene = test::terrace();
  const auto report = nlohmann::json::parse(run_json(reconstructed(scene), scene));
  EXPECT_EQ(report["counts"]["footprints"], 2);
  EXPECT_EQ(report["counts"]["full"], 2);
  EXPECT_EQ(report["buildings"].size(), 2U);
  const auto& block = report["blocks"][0];
  for (const auto* key : {"triangles", "slices", "slice_segments", "sweep_edges", "faces"})
    EXPECT_GT(block[key], 0) << key;
  const auto& o = block["objective"];
  EXPECT_NEAR(o["total"].get<double>(),
              o["sweep_unused"].get<double>() + o["unsupported"].get<double>() + o["height"].get<double>() +
                  o["thin"].get<double>(),
              1e-6);
  for (const auto* stage : {"block", "slice", "sweep", "fracture", "segment", "profile", "refine", "label", "evaluate"})
    EXPECT_TRUE(report["times"]["stages"].contains(stage)) << stage;
  EXPECT_EQ(report["options"]["segment.alpha"], "40");
}

TEST(RelativeGap, is_a_share_of_the_objective) {
  BlockReport block;
  EXPECT_EQ(relative_gap(block), 0);
  block.objective = 200;
  block.bound = 150;
  EXPECT_EQ(relative_gap(block), 0.25);
  block.bound = 200;
  EXPECT_EQ(relative_gap(block), 0);
}

TEST(Pictures, are_drawn_for_a_reconstruction) {
  const auto scene = test::lone_house();
  const auto r = reconstructed(scene);
  const auto p = pictures(r, scene, 2.0);
  ASSERT_TRUE(p);
  for (const auto* image : {&p->above, &p->angle, &p->error}) {
    EXPECT_GT(image->width, 100U);
    EXPECT_EQ(image->pixels.size(), 3 * image->width * image->height);
  }
}

TEST(Pictures, show_the_walls_of_models_that_stand_behind_those_of_the_scan) {
  auto scene = test::lone_house();
  const auto r = reconstructed(scene);
  for (auto& footprint : scene.footprints)  // half a metre inside the walls, as many a survey is
    for (auto& polygon : footprint.polygons) {
      const auto box = geometry::bounds(polygon.outer).grown(-0.5);
      polygon = test::rectangle(box.least.x, box.least.y, box.most.x, box.most.y);
    }
  auto moved = r;
  for (auto& building : moved.city.buildings)
    for (auto& part : building.parts)
      for (auto& v : part.model.solid.vertices) v = v + geometry::Point3{-0.4, 0.4, 0};  // behind walls to the south
  const auto image = pictures(moved, scene, 2.0).value().angle;
  std::size_t walls = 0;  // warm grey; the scan is blue, the paper white, roofs are red
  for (std::size_t y = 0; y < image.height; ++y)
    for (std::size_t x = image.width / 2 + 20; x < image.width; ++x) {
      const auto* c = image.pixels.data() + 3 * (y * image.width + x);
      walls += c[0] > c[2] + 4 && c[0] < c[2] + 40 && c[0] < 235 ? 1 : 0;
    }
  EXPECT_GT(walls, 20000U);
}

TEST(Pictures, show_a_solid_that_cannot_be_cut_into_triangles) {
  auto city = reconstructed(test::lone_house()).city;
  const auto whole = picture_of(city);
  auto& solid = city.buildings.at(0).parts.at(0).model.solid;
  for (auto& face : solid.faces)
    if (face.loops.front().size() == 4) {
      std::swap(face.loops.front()[1], face.loops.front()[2]);  // crosses itself
      break;
    }
  ASSERT_FALSE(solid::triangulate(solid));
  const auto crossed = picture_of(city);
  city.buildings.clear();
  EXPECT_NE(crossed.pixels, picture_of(city).pixels);
  EXPECT_EQ(crossed.pixels.size(), whole.pixels.size());
}

}  // namespace
}  // namespace mansard::report
