#include "mansard/pipeline/inputs.hpp"

#include <gmock/gmock.h>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "pipeline/houses.hpp"

namespace mansard::pipeline {
namespace {

const std::filesystem::path hall = std::filesystem::path(MANSARD_DATA) / "hall";

auto values_of(const model::Attributes& attributes, const std::string& name) -> std::vector<model::Value> {
  std::vector<model::Value> out;
  for (const auto& [key, value] : attributes)
    if (key == name) out.push_back(value);
  return out;
}

TEST(InOrder, puts_footprints_last_only_where_names_leave_no_doubt) {
  using Paths = std::vector<std::filesystem::path>;
  const auto folder = hall.string();
  for (const auto& mesh :
       {std::string("m.ply"), std::string("scan.laz"), std::string("dsm.tif"), std::string("a/tileset.json"), folder}) {
    const auto ordered = in_order({"f.gpkg", "b.obj", mesh});
    EXPECT_TRUE(ordered.wrong_order) << mesh;
    EXPECT_EQ(ordered.paths.footprints, "f.gpkg") << mesh;
    EXPECT_EQ(ordered.paths.meshes, (Paths{"b.obj", mesh})) << mesh;
    EXPECT_TRUE(in_order({"PG:dbname=city", mesh}).wrong_order) << mesh;
    EXPECT_FALSE(in_order({mesh, "f.gpkg"}).wrong_order) << mesh;
  }
  // Two vector files, and names that say nothing.
  for (const auto& typed : {Paths{"f.gpkg", "g.geojson", "m.ply"}, Paths{"f.gpkg", "m.json"},
                            Paths{"f.gpkg", "city.gdb"}, Paths{"m.ply", "n.obj"}, Paths{"f.gpkg"}}) {
    const auto ordered = in_order(typed);
    EXPECT_FALSE(ordered.wrong_order) << typed.front();
    EXPECT_EQ(ordered.paths.footprints, typed.back());
  }
}

TEST(ReadInputs, takes_footprints_or_draws_them_but_not_both) {
  const auto given = read_inputs({{hall / "mesh.off"}, hall / "footprints.geojson", false}, {});
  ASSERT_TRUE(given) << given.error().message;
  EXPECT_EQ(given->footprints.size(), 2U);
  EXPECT_FALSE(given->footprints[0].derived);
  EXPECT_EQ(read_inputs({{hall / "mesh.off"}, hall / "footprints.geojson", true}, {}).error().code,
            "pipeline-footprints");
  EXPECT_EQ(read_inputs({{hall / "mesh.off"}, {}, false}, {}).error().code, "pipeline-footprints");
}

TEST(ReadInputs, draws_footprints_of_a_mesh_alone) {
  const auto scene = read_inputs({{hall / "mesh.off"}, {}, true}, {});
  ASSERT_TRUE(scene) << scene.error().message;
  ASSERT_EQ(scene->footprints.size(), 1U);
  EXPECT_TRUE(scene->footprints[0].derived);
  EXPECT_EQ(scene->inputs.size(), 1U);
}

TEST(ReadInputs, draws_footprints_of_the_whole_mesh_whatever_the_box) {
  const auto delft = std::filesystem::path(MANSARD_DATA) / "delft" / "mesh.ply";
  const auto all = read_inputs({{delft}, {}, true}, {});
  ASSERT_TRUE(all) << all.error().message;
  ASSERT_GT(all->footprints.size(), 10U);
  EXPECT_TRUE(all->surroundings.empty());

  geometry::Box2 middle;
  for (const auto& polygon : all->footprints[all->footprints.size() / 2].polygons)
    middle.include(geometry::bounds(polygon.outer));
  Options options;
  const auto& from = all->frame.origin;
  options.ingest.bbox = {middle.least.x + static_cast<double>(from[0]), middle.least.y + static_cast<double>(from[1]),
                         middle.most.x + static_cast<double>(from[0]), middle.most.y + static_cast<double>(from[1])};
  const auto some = read_inputs({{delft}, {}, true}, options);
  ASSERT_TRUE(some) << some.error().message;
  EXPECT_EQ(some->frame.origin, from);
  EXPECT_LT(some->footprints.size(), all->footprints.size());
  EXPECT_EQ(some->footprints.size() + some->surroundings.size(), all->footprints.size());
  const auto same_in_all = [&](const model::Footprint& one) {
    const auto found = std::ranges::find(all->footprints, one.id, &model::Footprint::id);
    return found != all->footprints.end() && found->polygons == one.polygons && found->attributes == one.attributes;
  };
  for (const auto* list : {&some->footprints, &some->surroundings})
    for (const auto& one : *list) EXPECT_TRUE(same_in_all(one)) << one.id;

  options.ingest.bbox = {1e6, 1e6, 1e6 + 1, 1e6 + 1};
  const auto none = read_inputs({{delft}, {}, true}, options);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, "derive-nothing");
  EXPECT_THAT(none.error().message, ::testing::HasSubstr("in the box asked for"));
  options.ingest.bbox = {1, 1, 0, 0};
  EXPECT_EQ(read_inputs({{delft}, {}, true}, options).error().code, "ingest-bbox");
}

TEST(Reconstruct, tells_of_derived_footprints_in_city_and_report) {
  const Options options;
  auto scene = test::lone_house();
  const auto drawn = derive::footprints(scene, options.derive);
  ASSERT_TRUE(drawn) << drawn.error().message;
  ASSERT_EQ(drawn->footprints.size(), 1U);
  scene.footprints = drawn->footprints;

  const auto made = reconstruct(scene, options);
  ASSERT_TRUE(made) << made.error().message;
  ASSERT_EQ(made->city.buildings.size(), 1U);
  EXPECT_THAT(values_of(made->city.buildings[0].attributes, "ms_derived"), ::testing::ElementsAre(model::Value(true)));
  EXPECT_GT(made->buildings[0].parts, 0U);

  const auto report = nlohmann::json::parse(report::run_json(*made, scene));
  EXPECT_EQ(report["footprints_derived"], true);
  EXPECT_EQ(report["buildings"][0]["derived"], true);
  EXPECT_EQ(report["options"]["derive.cell"], "0.5");
}

TEST(ReadInputs, says_why_nothing_can_be_drawn) {
  Options options;
  options.derive.above_ground = 50;
  const auto scene = read_inputs({{hall / "mesh.off"}, {}, true}, options);
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().code, "derive-nothing");
}

}  // namespace
}  // namespace mansard::pipeline
