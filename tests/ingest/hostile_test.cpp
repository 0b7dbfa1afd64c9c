// Small files that ask for much: for memory, for time, for the stack, or for what is no file. What fuzzers find is
// replayed from fuzz/corpus; here stand those that one has to understand.
#include <gmock/gmock.h>
#include <cstdlib>

#include "ingest/gltf_workshop.hpp"
#include "mansard/ingest/model.hpp"

namespace mansard::ingest::test {
namespace {

using ::testing::HasSubstr;

class Hostile : public Workshop {
 protected:
  static auto scan(const fs::path& path) -> base::Diagnostic {
    const auto mesh = read_mesh({path}, {}, {});
    EXPECT_FALSE(mesh.has_value()) << path;
    return mesh ? base::Diagnostic{} : mesh.error();
  }
  void expect_format(const fs::path& path, const std::string& words) const {
    const auto error = scan(path);
    EXPECT_EQ(error.code, "ingest-mesh-format") << path;
    EXPECT_THAT(error.message, HasSubstr(words));
  }
  /// A million arrays in one another: whoever calls himself for each is at the end of his stack.
  static auto deep() -> std::string {
    constexpr std::size_t levels = 1'000'000;
    return std::string(levels, '[') + std::string(levels, ']');
  }
  static auto root(const Json& more) -> Json {
    Json out{{"boundingVolume", box(0, 0, 1, 1)}, {"geometricError", 1}};
    out.update(more);
    return out;
  }
  static auto implicit(const std::string& content, const std::string& subtrees) -> std::string {
    return tileset(root({{"content", {{"uri", content}}},
                         {"implicitTiling",
                          {{"subdivisionScheme", "QUADTREE"},
                           {"subtreeLevels", 10},
                           {"availableLevels", 30},
                           {"subtrees", {{"uri", subtrees}}}}}}));
  }
};

TEST_F(Hostile, json_of_a_million_levels_is_refused_by_every_reader) {
  const std::string many = R"("asset":{"version":"2.0"},"extras":)" + deep();
  expect_format(file("a.gltf", "{" + many + "}"), "levels deep");
  expect_format(file("tileset.json", R"({"root":{"geometricError":1},)" + many + "}"), "levels deep");
  file("s.subtree", R"({"contentAvailability":)" + deep() + "}");
  expect_format(file("b.json", implicit("{level}-{x}-{y}.glb", "s.subtree?{level}-{x}-{y}")), "nests too deep");
  const std::string city = R"({"type":"CityJSON","version":"2.0","vertices":[],"CityObjects":{"b":{"type":"Building",)";
  const auto model = file("c.city.json", city + R"("attributes":{"a":)" + deep() + "}}}}");
  const auto read = read_model(model);
  ASSERT_FALSE(read.has_value());
  EXPECT_EQ(read.error().code, "ingest-model-format");
  const auto footprints = read_footprints(model, {});
  ASSERT_FALSE(footprints.has_value());
  EXPECT_EQ(footprints.error().code, "ingest-footprints-format");
  EXPECT_THAT(footprints.error().message, HasSubstr("nests too deep"));
}

TEST_F(Hostile, a_sparse_accessor_cannot_have_more_points_than_the_file_bytes) {
  auto json = plain_gltf(3, 3);
  const auto bytes = bytes_of(triangle_at(0, 0));
  json["accessors"][0].erase("bufferView");
  json["accessors"][0]["count"] = 900'000'000;
  json["accessors"][0]["sparse"] = {
      {"count", 1}, {"indices", {{"bufferView", 1}, {"componentType", 5125}}}, {"values", {{"bufferView", 0}}}};
  expect_format(file("a.glb", glb(json, bytes)), "positions");
  json["accessors"][0]["count"] = 3;
  EXPECT_EQ(scan(file("b.glb", glb(json, bytes))).code, "ingest-mesh-unusable");  // read, and all in one place
}

TEST_F(Hostile, indices_below_zero_name_no_point) {
  auto json = plain_gltf(3, 3);
  json["accessors"][1]["componentType"] = 5120;  // signed bytes, which the standard does not allow
  auto bytes = bytes_of(triangle_at(0, 0));
  bytes[36] = bytes[37] = bytes[38] = '\xff';
  EXPECT_EQ(scan(file("a.glb", glb(json, bytes))).code, "ingest-mesh-unusable");
  json["accessors"][0].erase("bufferView");
  json["accessors"][0]["sparse"] = {
      {"count", 1}, {"indices", {{"bufferView", 1}, {"componentType", 5120}}}, {"values", {{"bufferView", 0}}}};
  expect_format(file("b.glb", glb(json, bytes)), "positions");
}

TEST_F(Hostile, room_to_unpack_into_is_no_more_than_the_codecs_can_fill) {
  auto json = plain_gltf(3, 3);
  json["extensionsUsed"] = {"EXT_meshopt_compression"};
  json["buffers"] = {{{"byteLength", 48}}, {{"byteLength", 4'000'000'000'000}}};
  for (auto& view : json["bufferViews"]) {
    view["buffer"] = 1;
    view["extensions"]["EXT_meshopt_compression"] = {
        {"buffer", 0}, {"byteLength", 48}, {"byteStride", 12}, {"mode", "ATTRIBUTES"}, {"count", 3}};
  }
  expect_format(file("a.glb", glb(json, std::string(48, '\0'))), "4000000000000 bytes");
  json["buffers"][1]["byteLength"] = 48;
  expect_format(file("b.glb", glb(json, std::string(48, '\0'))), "buffer view 0");
}

/// A primitive compressed with Draco.
auto with_draco(const std::string& packed) -> std::string {
  auto json = plain_gltf(3, 3);
  json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
  json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0},
                                                                                    {"attributes", {{"POSITION", 0}}}};
  for (auto& accessor : json["accessors"]) accessor.erase("bufferView");
  json["bufferViews"] = {{{"buffer", 0}, {"byteLength", packed.size()}}};
  json["buffers"] = {{{"byteLength", packed.size()}}};
  return glb(json, packed);
}
auto varint(std::uint64_t value) -> std::string {
  std::string out;
  for (; value >= 128; value /= 128) out += static_cast<char>(value % 128 + 128);
  return out + static_cast<char>(value);
}

// Draco would take ten thousand million bytes and some minutes.
TEST_F(Hostile, draco_is_not_asked_for_more_faces_than_bytes_can_hold) {
  const std::string faces = varint(400'000'000), symbols(1, '\0'), rest(64, 'x');
  const auto mesh = [](char method, char flags) {
    return std::string("DRACO\2\2\1", 8) + method + std::string(1, '\0') + flags;
  };
  const std::string vertices = std::string(1, '\0') + varint(200'000'000);
  const std::string more = symbols + varint(399'999'990) + rest;
  expect_format(file("edgebreaker.glb", with_draco(mesh(1, 0) + vertices + faces + more)), "400000000 faces in");
  expect_format(file("sequential.glb", with_draco(mesh(0, 0) + faces + faces + rest)), "400000000 faces in");
  // Of one attribute, with a block in a block; then of the mesh: a name of three letters with five bytes.
  const std::string metadata = std::string("\1\7\0\1\3abc\1\2no\5bytes\0", 19) + std::string("\1\3abc\5bytes\0", 12);
  expect_format(file("told.glb", with_draco(mesh(1, '\x80') + metadata + vertices + faces + more)),
                "400000000 faces in");
}

TEST_F(Hostile, what_a_file_names_is_never_a_device) {
  ::setenv("MANSARD_OUTSIDE", "yes", 1);  // otherwise nothing outside of the folder is opened at all
  const std::string up = "../../../../../../../../../../../../dev/zero";
  auto json = plain_gltf(3, 3);
  json["buffers"][0]["uri"] = up;
  EXPECT_EQ(scan(file("a.gltf", json.dump())).code, "file-read");
  EXPECT_EQ(scan(file("a.json", tileset(root({{"content", {{"uri", "/dev/zero"}}}})))).code, "file-read");
  EXPECT_EQ(scan(file("b.json", tileset(root({{"content", {{"uri", "/vsistdin/"}}}})))).code, "file-read");
  file("s.subtree", R"({"buffers":[{"uri":")" + up + R"("}],"bufferViews":[{"buffer":0,"byteLength":1}],
"tileAvailability":{"bitstream":0}})");
  EXPECT_EQ(scan(file("c.json", implicit("{level}-{x}-{y}.glb", "s.subtree?{level}-{x}-{y}"))).code, "file-read");
  ::unsetenv("MANSARD_OUTSIDE");
}

TEST_F(Hostile, a_tileset_that_is_twice_in_itself_is_found_at_once) {
  const Json twice{{"contents", {{{"uri", "b.json"}}, {{"uri", "./b.json"}}}}};
  const Json back{{"contents", {{{"uri", "x/../a.json"}}, {{"uri", "a.json"}}}}};
  file("b.json", tileset(root(back)));
  expect_format(file("a.json", tileset(root(twice))), "nested in itself");
}

TEST_F(Hostile, an_implicit_tree_has_an_address_for_each_tile) {
  file("s.subtree", R"({"tileAvailability":{"constant":1},"contentAvailability":[{"constant":1}],
"childSubtreeAvailability":{"constant":1}})");
  file("t.glb", plain_glb(triangle_at(0, 0)));
  expect_format(file("a.json", implicit("t.glb", "s.subtree?{level}-{x}-{y}")), "one address for several tiles");
  expect_format(file("b.json", implicit("{level}-{x}-{y}.glb", "s.subtree")), "one address for several tiles");
  // What follows "?" is no part of a name on disk: each subtree has an address, and all are the same file.
  expect_format(file("c.json", implicit("", "s.subtree?{level}-{x}-{y}")), "million tiles");
}

TEST_F(Hostile, members_of_another_kind_are_no_exception) {
  for (const char* vertices : {"{\"a\":[0,0,0]}", "\"abc\"", "[[0,0,0],7,{},null]", "17"})
    for (const char* geometry :
         {"{\"a\":1}", "[7]", "[[[0]]]", "\"x\"", "[{\"type\":\"Solid\",\"boundaries\":{\"a\":7}}]"}) {
      const std::string city = R"({"type":"CityJSON","version":"2.0","vertices":)" + std::string(vertices);
      const std::string building = R"(,"CityObjects":{"b":{"type":"Building","children":{"a":"b"},"geometry":)";
      const auto path = file("a.city.json", city + building + geometry + "}}}");
      const auto footprints = read_footprints(path, {});
      if (!footprints) {
        EXPECT_THAT(footprints.error().message, testing::Not(HasSubstr("json.exception"))) << vertices;
      }
      const auto model = read_model(path);
      if (!model) {
        EXPECT_THAT(model.error().message, testing::Not(HasSubstr("json.exception"))) << vertices;
      }
    }
}

}  // namespace
}  // namespace mansard::ingest::test
