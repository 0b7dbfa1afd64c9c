// A terrain is the same surface in every format, in the frame of the models.
#include <gmock/gmock.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "base/scratch.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/terrain.hpp"

namespace {

using namespace mansard;
using formats::Format;
using Json = nlohmann::json;

class TerrainFiles : public testing::Test {
 protected:
  auto write(Format format, const std::string& name) -> std::filesystem::path {
    base::Outputs outputs;
    const auto path = folder_ / name;
    const auto done = formats::write_terrain(format, path, mesh_, {frame_, {"0", {}, {}, {}}}, {}, outputs);
    EXPECT_TRUE(done) << to_string(done.error());
    EXPECT_TRUE(outputs.commit());
    return path;
  }
  geometry::Mesh mesh_{{{0, 0, 1}, {10, 0, 1.5}, {10, 10, 2}, {0, 10, 1.25}}, {{0, 1, 2}, {0, 2, 3}}};
  model::Frame frame_{{85000, 446000, 0}, "EPSG:28992"};
  mansard::test::Scratch folder_;
};

TEST_F(TerrainFiles, cityjson_has_a_tin_relief_on_its_grid) {
  const auto json = Json::parse(*base::read_file(write(Format::cityjson, "t.city.json")));
  const auto& object = json["CityObjects"]["terrain"];
  EXPECT_EQ(object["type"], "TINRelief");
  EXPECT_EQ(object["geometry"][0]["type"], "CompositeSurface");
  EXPECT_EQ(object["geometry"][0]["boundaries"], Json::parse("[[[0,1,2]],[[0,2,3]]]"));
  EXPECT_EQ(json["vertices"], Json::parse("[[0,0,10000],[100000,0,15000],[100000,100000,20000],[0,100000,12500]]"));
  EXPECT_EQ(json["transform"]["translate"][0], 85000);
}

TEST_F(TerrainFiles, glb_is_y_up_and_complete) {
  const auto bytes = *base::read_file(write(Format::glb, "t.glb"));
  std::uint32_t total = 0, size = 0;
  std::memcpy(&total, bytes.data() + 8, 4);
  std::memcpy(&size, bytes.data() + 12, 4);
  EXPECT_EQ(total, bytes.size());
  const auto json = Json::parse(bytes.substr(20, size));
  EXPECT_EQ(json["accessors"][0]["max"], Json::parse("[10,2,0]"));
  EXPECT_EQ(json["accessors"][0]["min"], Json::parse("[0,1,-10]"));
  EXPECT_EQ(json["asset"]["extras"]["origin"], Json::parse("[85000,446000,0]"));
}

TEST_F(TerrainFiles, tileset_names_tiles_that_exist) {
  const auto folder = write(Format::tiles, "t.3dtiles");
  const auto json = Json::parse(*base::read_file(folder / "tileset.json"));
  ASSERT_EQ(json["root"]["children"].size(), 1U);
  EXPECT_TRUE(std::filesystem::exists(folder / json["root"]["children"][0]["content"]["uri"].get<std::string>()));
  EXPECT_EQ(json["root"]["refine"], "ADD");
}

TEST_F(TerrainFiles, other_formats_have_no_terrain) {
  EXPECT_FALSE(formats::terrain_format_of("t.gpkg"));
  EXPECT_FALSE(formats::terrain_format_of("t.tif"));
  EXPECT_EQ(formats::terrain_format_of("t.stl"), Format::stl);
}

}  // namespace
