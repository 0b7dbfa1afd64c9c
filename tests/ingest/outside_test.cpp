// Files that refer to others outside their folder, or to servers.
#include <gmock/gmock.h>
#include <cstdlib>

#include "ingest/gltf_workshop.hpp"
#include "ingest/watched.hpp"
#include "mansard/formats/files/reach.hpp"
#include "mansard/formats/source.hpp"
#include "mansard/ingest/model.hpp"

namespace mansard::ingest::test {
namespace {

using ::testing::HasSubstr;

class Outside : public Workshop {
 protected:
  void TearDown() override { ::unsetenv("MANSARD_OUTSIDE"); }
  /// The code with which a mesh cannot be read; empty if it can.
  static auto refused(const fs::path& mesh) -> std::string {
    const auto scene = read_scene({mesh}, {}, {});
    return scene ? std::string() : scene.error().code;
  }
  Listening server_;
};

TEST(Reach, is_the_folder_of_the_given_file_or_the_server_that_it_is_on) {
  const auto reaches = [](const char* given, const char* named) { return bool(formats::check_reach(given, named)); };
  EXPECT_TRUE(reaches("/a/b/t.json", "/a/b/t.json"));
  EXPECT_TRUE(reaches("/a/b/t.json", "/a/b/c/d.glb"));
  EXPECT_TRUE(reaches("/a/b/t.json", "/a/b/c/../d.glb"));
  EXPECT_TRUE(reaches("t.json", "c/d.glb"));
  EXPECT_TRUE(reaches("./t.json", "./c/d.glb"));
  EXPECT_TRUE(reaches("../x/t.json", "../x/d.glb"));
  EXPECT_TRUE(reaches("/vsizip//a/b.zip/t.json", "/vsizip//a/b.zip/c/d.glb"));
  EXPECT_TRUE(reaches("/vsicurl/https://h:1/x/t.json", "/vsicurl/https://h:1/y/d.glb?key=1"));
  EXPECT_FALSE(reaches("/a/b/t.json", "/a/d.glb"));
  EXPECT_FALSE(reaches("/a/b/t.json", "/a/b/../d.glb"));
  EXPECT_FALSE(reaches("/a/b/t.json", "/a/bc/d.glb"));
  EXPECT_FALSE(reaches("/a/b/t.json", "/etc/passwd"));
  EXPECT_FALSE(reaches("t.json", "/etc/passwd"));
  EXPECT_FALSE(reaches("t.json", "c/../../d.glb"));
  EXPECT_FALSE(reaches("../x/t.json", "../d.glb"));
  EXPECT_FALSE(reaches("/a/b/t.json", "/vsicurl/https://h/d.glb"));
  EXPECT_FALSE(reaches("/vsizip//a/b.zip/t.json", "/a/d.glb"));
  EXPECT_FALSE(reaches("/vsicurl/https://h/t.json", "/vsicurl/https://other/d.glb"));
  EXPECT_FALSE(reaches("/vsicurl/https://h/t.json", "/vsicurl/https://h:8080/d.glb"));
  EXPECT_FALSE(reaches("/vsicurl/https://h/t.json", "/etc/passwd"));
}

TEST_F(Outside, buffers_of_a_gltf_are_not_read_unless_that_is_asked_for) {
  fs::create_directories(at("model"));
  file("secret.bin", std::string(36, 'x'));
  const Json gltf{{"asset", {{"version", "2.0"}}},
                  {"scene", 0},
                  {"scenes", {{{"nodes", {0}}}}},
                  {"nodes", {{{"mesh", 0}}}},
                  {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}},
                  {"buffers", {{{"uri", "../secret.bin"}, {"byteLength", 36}}}},
                  {"bufferViews", {{{"buffer", 0}, {"byteLength", 36}}}},
                  {"accessors",
                   {{{"bufferView", 0},
                     {"componentType", 5126},
                     {"count", 3},
                     {"type", "VEC3"},
                     {"min", {0, 0, 0}},
                     {"max", {1, 1, 1}}}}}};
  file("model/a.gltf", gltf.dump());
  EXPECT_EQ(refused(at("model/a.gltf")), "ingest-outside");
  ::setenv("MANSARD_OUTSIDE", "yes", 1);
  EXPECT_NE(refused(at("model/a.gltf")), "ingest-outside");
}

TEST_F(Outside, tiles_of_a_tileset_on_disk_are_not_fetched_from_a_server) {
  for (const auto& uri : {server_.address() + "/a.glb", server_.address() + "/t.json", std::string("../a.glb")}) {
    fs::create_directories(at("set"));
    const Json volume{{"box", {0, 0, 0, 9, 0, 0, 0, 9, 0, 0, 0, 9}}};
    const Json root{{"boundingVolume", volume}, {"geometricError", 0}, {"content", {{"uri", uri}}}};
    file("set/tileset.json", Json{{"asset", {{"version", "1.1"}}}, {"geometricError", 1}, {"root", root}}.dump());
    EXPECT_EQ(refused(at("set/tileset.json")), "ingest-outside") << uri;
  }
  EXPECT_FALSE(server_.called());
}

TEST_F(Outside, the_crs_link_of_a_geojson_is_not_followed) {
  file("f.geojson", R"({"type":"FeatureCollection","crs":{"type":"link","properties":{"href":")" + server_.address() +
                        R"(/crs","type":"ogcwkt"}},"features":[{"type":"Feature","properties":{},"geometry":{"type":)" +
                        R"("Polygon","coordinates":[[[0,0],[9,0],[9,9],[0,0]]]}}]})");
  (void)read_footprints(at("f.geojson"), {});
  (void)formats::vector_source(at("f.geojson"));
  EXPECT_FALSE(server_.called());
}

TEST_F(Outside, a_vrt_on_disk_calls_no_server) {
  const auto source = "/vsicurl/" + server_.address() + "/dtm.tif";
  file("d.vrt", R"(<VRTDataset rasterXSize="9" rasterYSize="9"><GeoTransform>0,1,0,9,0,-1</GeoTransform>)"
                R"(<VRTRasterBand dataType="Float32" band="1"><SimpleSource><SourceFilename relativeToVRT="0">)" +
                    source +
                    R"(</SourceFilename><SourceBand>1</SourceBand><SrcRect xOff="0" yOff="0" xSize="9" ySize="9"/>)"
                    R"(<DstRect xOff="0" yOff="0" xSize="9" ySize="9"/></SimpleSource></VRTRasterBand></VRTDataset>)");
  (void)refused(at("d.vrt"));
  (void)formats::raster_source(at("d.vrt"));
  file("v.vrt", "<OGRVRTDataSource><OGRVRTLayer name=\"l\"><SrcDataSource>/vsicurl/" + server_.address() +
                    "/f.geojson</SrcDataSource></OGRVRTLayer></OGRVRTDataSource>");
  (void)read_footprints(at("v.vrt"), {});
  (void)formats::vector_source(at("v.vrt"));
  EXPECT_FALSE(server_.called());
}

TEST_F(Outside, a_vrt_in_an_archive_reads_nothing_on_the_disk) {
  file("secret.geojson", R"({"type":"FeatureCollection","features":[]})");
  file("v.vrt", "<OGRVRTDataSource><OGRVRTLayer name=\"secret\"><SrcDataSource>" + at("secret.geojson").string() +
                    "</SrcDataSource></OGRVRTLayer></OGRVRTDataSource>");
  ASSERT_EQ(std::system(("cd '" + at("").string() + "' && python3 -m zipfile -c v.zip v.vrt").c_str()), 0);
  const auto refused_footprints = read_footprints(at("v.zip"), {});
  ASSERT_FALSE(refused_footprints);
  EXPECT_EQ(refused_footprints.error().code, "ingest-outside");
}

TEST_F(Outside, a_raster_beside_the_folder_of_a_vrt_is_refused) {
  fs::create_directories(at("v"));
  file("dtm.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n");
  file("v/d.vrt", R"(<VRTDataset rasterXSize="2" rasterYSize="2"><GeoTransform>0,1,0,2,0,-1</GeoTransform>)"
                  R"(<VRTRasterBand dataType="Float32" band="1"><SimpleSource><SourceFilename relativeToVRT="1">)"
                  R"(../dtm.asc</SourceFilename><SourceBand>1</SourceBand><SrcRect xOff="0" yOff="0" xSize="2" )"
                  R"(ySize="2"/><DstRect xOff="0" yOff="0" xSize="2" ySize="2"/></SimpleSource></VRTRasterBand>)"
                  R"(</VRTDataset>)");
  EXPECT_EQ(refused(at("v/d.vrt")), "ingest-outside");
}

}  // namespace
}  // namespace mansard::ingest::test
