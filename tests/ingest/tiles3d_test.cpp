// Tilesets of 3D Tiles, a few tiles each, with poisoned tiles where none may be read.
#include <gdal/cpl_vsi.h>
#include <gmock/gmock.h>

#include "ingest/gltf_workshop.hpp"
#include "mansard/formats/tiles3d/tileset.hpp"
#include "mansard/ingest/model.hpp"

namespace mansard::ingest::test {
namespace {

using ::testing::HasSubstr;

// A place in Delft, and where it is in UTM zone 31 by Krüger's series for the transverse Mercator projection.
constexpr double longitude = 4.3571, latitude = 52.0118, east = 593139.054, north = 5763220.062;

class Tiles : public Workshop {
 protected:
  /// Without footprints.
  static auto alone(const fs::path& path, const Options& options = {}) -> base::Result<model::Scene> {
    return read_scene({path}, {}, options);
  }
  static auto tile(const Json& volume, double error, const std::string& uri = "") -> Json {
    Json out{{"boundingVolume", volume}, {"geometricError", error}};
    if (!uri.empty()) out["content"] = {{"uri", uri}};
    return out;
  }
  /// x of every triangle's first corner, in file coordinates and whole metres.
  static auto places(const base::Result<model::Scene>& scene) -> std::vector<int> {
    std::vector<int> out;
    if (!scene) return ADD_FAILURE() << base::to_string(scene.error()), out;
    for (const auto& t : scene->mesh.triangles) out.push_back(static_cast<int>(std::lround(in_file(*scene, t[0]).x)));
    return out;
  }
  /// A tile file with a triangle at (x, y).
  auto put_tile(const std::string& name, float x, float y = 0) const -> fs::path {
    return file(name, plain_glb(triangle_at(x, y)));
  }
};

TEST_F(Tiles, on_the_earth_come_to_the_working_crs_with_ellipsoidal_heights) {
  auto root = tile(box(-10, -10, 10, 10), 0, "a.glb");
  root["transform"] = east_north_up(longitude, latitude, 45);
  put_tile("a.glb", 0);
  const auto scene = alone(file("tileset.json", tileset(root)));
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_EQ(scene->frame.crs, "EPSG:32631");
  expect_near(in_file(*scene, 0), {east, north, 45}, 2e-3);
  // True east is 1.07° = 1.3571° sin φ left of the grid's here, and the grid's scale 0.99970.
  const auto along = in_file(*scene, 1) - in_file(*scene, 0);
  EXPECT_NEAR(std::hypot(along.x, along.y), 0.99970, 1e-4);
  EXPECT_NEAR(std::atan2(along.y, along.x) * 180 / std::numbers::pi, 1.07, 0.01);
  EXPECT_EQ(scene->inputs.size(), 2U);
  // With footprints, theirs is the working CRS; the offset is added at the end.
  Options options;
  options.mesh_offset = {0, 0, -43};
  const auto footprint = polygons({square(84270, 447540)}, "EPSG:28992");
  const auto dutch = read({at("tileset.json")}, footprint, options);
  ASSERT_TRUE(dutch) << base::to_string(dutch.error());
  EXPECT_EQ(dutch->frame.crs, "EPSG:28992");
  expect_near(in_file(*dutch), {84279.5, 447548, 2}, 3);  // by the polynomials of Schreutelkamp and Strang van Hees
  EXPECT_NEAR(in_file(*dutch).z, 2, 1e-6);
}

TEST_F(Tiles, on_the_earth_have_no_place_in_a_local_frame) {
  auto root = tile(box(-10, -10, 10, 10), 0, "a.glb");
  root["transform"] = east_north_up(longitude, latitude, 45);
  put_tile("a.glb", 0);
  const auto path = file("tileset.json", tileset(root));
  EXPECT_EQ(code(read({path}, polygons({square(500, 300)}))), "ingest-crs-unknown");
  Options options;
  options.crs = "local";
  EXPECT_EQ(code(alone(path, options)), "ingest-crs-unknown");
  const auto mesh = read_mesh({path}, {{593000, 5763000, 0}, "EPSG:32631"}, {});
  ASSERT_TRUE(mesh) << base::to_string(mesh.error());
  expect_near(mesh->mesh.vertices[0], {east - 593000, north - 5763000, 45}, 2e-3);
}

TEST_F(Tiles, transforms_of_nested_tiles_are_applied_outermost_last) {
  auto inner = tile(box(0, 0, 1, 1), 0, "a.glb");
  inner["transform"] = {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1};  // turned by 90°, then 5 m along x
  auto root = tile(box(-100, -100, 100, 100), 10);
  root["transform"] = {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 100, 200, 0, 1};
  root["children"] = Json::array({inner});
  put_tile("a.glb", 3, 4);
  const auto scene = alone(file("tileset.json", tileset(root)));
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_EQ(scene->frame.crs, "");
  expect_near(in_file(*scene), {2 * (-4 + 5) + 100, 2 * 3 + 200, 0}, 1e-9);
}

TEST_F(Tiles, the_level_follows_the_geometric_error) {
  auto leaf = tile(box(0, 0, 1, 1), 0, "leaf.glb"), middle = tile(box(0, 0, 1, 1), 5, "middle.glb");
  middle["children"] = Json::array({leaf});
  auto root = tile(box(0, 0, 1, 1), 20, "root.glb");
  root["children"] = Json::array({middle});
  root["refine"] = "REPLACE";
  put_tile("root.glb", 1);
  put_tile("middle.glb", 2);
  put_tile("leaf.glb", 3);
  const auto levels = [&](const std::string& refine) {
    root["refine"] = refine;
    const auto path = file("tileset.json", tileset(root));
    std::vector<std::vector<int>> out;
    for (const double error : {0., 4., 5., 19., 20., 1000.}) {
      Options options;
      options.tile_error = error;
      out.push_back(places(alone(path, options)));
    }
    return out;
  };
  using Levels = std::vector<std::vector<int>>;
  EXPECT_EQ(levels("REPLACE"), (Levels{{3}, {3}, {2}, {2}, {1}, {1}}));
  EXPECT_EQ(levels("ADD"), (Levels{{1, 2, 3}, {1, 2, 3}, {1, 2}, {1, 2}, {1}, {1}}));
}

TEST_F(Tiles, an_empty_tile_is_gone_through_whatever_its_error) {
  auto root = tile(box(0, 0, 1, 1), 1);
  root["children"] = Json::array({tile(box(0, 0, 1, 1), 0, "a.glb")});
  put_tile("a.glb", 7);
  Options options;
  options.tile_error = 100;
  EXPECT_EQ(places(alone(file("tileset.json", tileset(root)), options)), std::vector<int>{7});
}

TEST_F(Tiles, tilesets_inside_are_followed_by_their_addresses) {
  auto inner = tile(box(0, 0, 1, 1), 0, "../b%20lock/a.glb?v=1");
  inner["transform"] = moved_by(10, 0, 0);
  file("sub/sheet.json", tileset(inner));
  auto root = tile(box(-100, -100, 100, 100), 10);
  root["transform"] = moved_by(100, 0, 0);
  root["content"] = {{"url", "./sub/sheet.json"}};
  put_tile("b lock/a.glb", 1);
  const auto scene = alone(file("tileset.json", tileset(root)));
  EXPECT_EQ(places(scene), std::vector<int>{111});
  EXPECT_EQ(scene->inputs.size(), 3U);
  for (const auto& input : scene->inputs) EXPECT_EQ(input.sha256.size(), 64U) << input.path;
}

TEST_F(Tiles, several_contents_are_all_read) {
  auto root = tile(box(-100, -100, 100, 100), 0);
  root["contents"] = {{{"uri", "a.glb"}}, {{"uri", "b.glb"}}};
  put_tile("a.glb", 1);
  put_tile("b.glb", 2);
  EXPECT_EQ(places(alone(file("tileset.json", tileset(root)))), (std::vector<int>{1, 2}));
}

TEST_F(Tiles, batched_models_stand_around_their_centre) {
  std::string offset_table = R"({"BATCH_LENGTH":0,"RTC_CENTER":{"byteOffset":4}})", binary;
  for (const float c : {9.F, 300.F, 400.F, 5.F}) put(binary, c);
  const auto model = plain_glb(triangle_at(1, 2, 3));
  for (const auto& bytes : {b3dm(model, R"({"BATCH_LENGTH":0,"RTC_CENTER":[300,400,5]})", "", R"({"id":[]})"),
                            b3dm(model, offset_table, binary), cmpt({b3dm(model, offset_table, binary)})}) {
    file("a.b3dm", bytes);
    const auto scene = alone(file("tileset.json", tileset(tile(box(0, 0, 1000, 1000), 0, "a.b3dm"))));
    ASSERT_TRUE(scene) << base::to_string(scene.error());
    EXPECT_EQ(in_file(*scene), (Point3{301, 402, 8}));
  }
}

TEST_F(Tiles, points_and_instances_are_left_out_with_a_warning) {
  std::string points = "pnts";
  put(points, std::uint32_t{1});
  put(points, std::uint32_t{16});
  points += "....";
  file("a.cmpt", cmpt({points, b3dm(plain_glb(triangle_at(1, 1)))}));
  file("p.pnts", points);
  auto root = tile(box(0, 0, 1000, 1000), 0);
  root["contents"] = {{{"uri", "a.cmpt"}}, {{"uri", "p.pnts"}}};
  const auto scene = alone(file("tileset.json", tileset(root)));
  EXPECT_EQ(places(scene), std::vector<int>{1});
  ASSERT_TRUE(has_warning(*scene, "ingest-tile-skipped"));
  EXPECT_THAT(scene->warnings.front().message, HasSubstr("2 tiles hold pnts"));
}

TEST_F(Tiles, headers_of_before_the_standard_and_damaged_ones_are_refused) {
  const auto with = [&](const std::string& bytes) {
    file("a.b3dm", bytes);
    return alone(file("tileset.json", tileset(tile(box(0, 0, 10, 10), 0, "a.b3dm"))));
  };
  const auto model = plain_glb(triangle_at(1, 1));
  for (const std::size_t words : {2, 3}) {
    std::string old = "b3dm";
    put(old, std::uint32_t{1});
    put(old, static_cast<std::uint32_t>(12 + 4 * words + model.size()));
    for (std::size_t i = 0; i < words; ++i) put(old, std::uint32_t{0});
    const auto scene = with(old + model);
    ASSERT_EQ(code(scene), "ingest-mesh-format");
    EXPECT_THAT(scene.error().message, HasSubstr("before 3D Tiles 1.0"));
  }
  const auto whole = b3dm(model);
  EXPECT_EQ(code(with(whole.substr(0, whole.size() - 1))), "ingest-mesh-truncated");
  EXPECT_EQ(code(with(cmpt({whole}).substr(0, 40))), "ingest-mesh-truncated");
  EXPECT_EQ(code(with("b3dm")), "ingest-mesh-truncated");
  EXPECT_EQ(code(with("")), "ingest-mesh-empty");
  EXPECT_EQ(code(with("something else")), "ingest-mesh-format");
  EXPECT_EQ(code(with(b3dm(model, R"({"RTC_CENTER":[1,2]})"))), "ingest-mesh-format");
}

TEST_F(Tiles, beside_the_box_are_not_read_at_all) {
  // Four tiles of 100 m each on the earth, by region, box and sphere; all but one are poison.
  const double degree_east = 1 / (111319.49 * std::cos(latitude * std::numbers::pi / 180)), degree_north = 1 / 111250.0;
  const auto radians = [](double degrees) { return degrees * std::numbers::pi / 180; };
  const auto region = [&](double x, double y) -> Json {
    return {{"region",
             {radians(longitude + x * degree_east), radians(latitude + y * degree_north),
              radians(longitude + (x + 100) * degree_east), radians(latitude + (y + 100) * degree_north), 0, 100}}};
  };
  Options options;
  options.bbox = {east + 320, north + 20, east + 380, north + 60};
  options.crs = "EPSG:32631";
  for (const char* kind : {"region", "box", "sphere"}) {
    auto root = tile(kind == std::string("region") ? region(-500, -500) : box(-1000, -1000, 1000, 1000), 100);
    if (kind == std::string("region"))
      root["boundingVolume"]["region"] = {radians(longitude - 0.02),
                                          radians(latitude - 0.02),
                                          radians(longitude + 0.02),
                                          radians(latitude + 0.02),
                                          0,
                                          100};
    root["transform"] = east_north_up(longitude, latitude, 0);
    root["refine"] = "REPLACE";
    root["content"] = {{"uri", "poison.glb"}};
    for (const auto& [x, y, name] : {std::tuple{0., 0., "poison.glb"},
                                     {300., 0., "good.glb"},
                                     {0., 900., "poison.json"},
                                     {-600., -600., "gone.b3dm"}}) {
      Json volume = box(x, y, x + 100, y + 100, 0, 100);
      if (kind == std::string("region")) volume = region(x, y);
      if (kind == std::string("sphere")) volume = {{"sphere", {x + 50, y + 50, 50, 80}}};
      root["children"].push_back(tile(volume, 0, name));
    }
    put_tile("good.glb", 350, 40);
    file("poison.glb", "poison");
    file("poison.json", "poison");
    const auto path = file("tileset.json", tileset(root));
    const auto scene = alone(path, options);
    ASSERT_TRUE(scene) << kind << base::to_string(scene.error());
    EXPECT_EQ(scene->mesh.triangles.size(), 1U) << kind;
    EXPECT_EQ(scene->inputs.size(), 2U) << kind;
    EXPECT_NE(code(alone(path)), "");
    auto nowhere = options;
    nowhere.bbox = {east + 600, north + 600, east + 700, north + 700};
    EXPECT_EQ(code(alone(path, nowhere)), "ingest-no-overlap") << kind;
  }
}

TEST_F(Tiles, of_a_projected_or_local_frame_stay_as_they_are) {
  // A northing that is as far from zero as the surface of the earth from its middle.
  auto root = tile(box(0, 0, 100, 100), 10);
  root["transform"] = moved_by(500000, 6360000, 0);
  root["children"] = {tile(box(0, 0, 10, 10), 0, "a.glb"), tile(box(50, 50, 60, 60), 0, "poison.glb")};
  put_tile("a.glb", 5, 6);
  put_tile("poison.glb", 55, 55);
  const auto path = file("tileset.json", tileset(root));
  const auto footprints = polygons({square(500000, 6360000)}, "EPSG:25832");
  const auto scene = read({path}, footprints);
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_EQ(scene->frame.crs, "EPSG:25832");
  EXPECT_EQ(in_file(*scene), (Point3{500005, 6360006, 0}));
  // The box is in the working CRS, with the offset.
  Options options;
  options.mesh_offset = {-100000, 0, 7};
  options.bbox = {400000, 6360000, 400010, 6360010};
  file("poison.glb", "poison");
  const auto moved = read({path}, polygons({square(400001, 6360001, 5)}, "EPSG:25832"), options);
  EXPECT_NE(code(moved), "");  // 50 m around the box reach the other tile
  root["children"][1] = tile(box(190, 190, 200, 200), 0, "poison.glb");
  file("tileset.json", tileset(root));
  const auto kept = read({path}, polygons({square(400001, 6360001, 5)}, "EPSG:25832"), options);
  ASSERT_TRUE(kept) << base::to_string(kept.error());
  EXPECT_EQ(in_file(*kept), (Point3{400005, 6360006, 7}));
}

TEST_F(Tiles, axes_are_as_the_tileset_or_the_option_says) {
  put_tile("a.glb", 1, 2);
  auto json = Json::parse(tileset(tile(box(0, 0, 10, 10), 0, "a.glb")));
  json["asset"]["gltfUpAxis"] = "Z";
  const auto path = file("tileset.json", json.dump());
  EXPECT_EQ(in_file(*alone(path)), (Point3{1, 0, -2}));
  Options options;
  options.up = formats::UpAxis::y;
  EXPECT_EQ(in_file(*alone(path, options)), (Point3{1, 2, 0}));
}

TEST_F(Tiles, a_folder_with_a_tileset_at_its_top_is_that_tileset) {
  file("city/tileset.json", tileset(tile(box(0, 0, 10, 10), 0, "a.glb")));
  file("city/a.glb", plain_glb(triangle_at(1, 1)));
  file("city/old.glb", "poison");
  EXPECT_EQ(places(alone(at("city"))), std::vector<int>{1});
  // One below, beside meshes that are none of its tiles.
  file("more.obj", "v 9 0 0\nv 10 0 0\nv 9 1 0\nf 1 2 3\n");
  EXPECT_EQ(places(alone(at("city").parent_path())), (std::vector<int>{1, 9}));
}

TEST_F(Tiles, are_read_from_an_archive) {
  const std::string archive = "/vsizip/" + at("city.zip").string();
  const auto add = [&](const std::string& entry, const std::string& bytes) {
    VSILFILE* out = VSIFOpenL((archive + "/" + entry).c_str(), "wb");
    ASSERT_NE(out, nullptr);
    VSIFWriteL(bytes.data(), 1, bytes.size(), out);
    VSIFCloseL(out);
  };
  add("tileset.json", tileset(tile(box(0, 0, 10, 10), 0, "deep/er/../a.glb")));
  add("deep/a.glb", plain_glb(triangle_at(4, 1)));
  EXPECT_EQ(places(alone(at("city.zip"))), std::vector<int>{4});
  EXPECT_EQ(places(alone(archive + "/tileset.json")), std::vector<int>{4});
  fs::copy(at("city.zip"), at("city.3tz"));
  EXPECT_EQ(places(alone(at("city.3tz"))), std::vector<int>{4});
}

TEST_F(Tiles, of_an_implicit_tree_are_found_by_their_bits) {
  // Two levels to a subtree: the root and two of its four children, of which the second has a subtree of its own.
  Json root = tile(box(0, 0, 64, 64), 16);
  root["refine"] = "REPLACE";
  root["content"] = {{"uri", "t/{level}-{x}-{y}.glb"}};
  root["implicitTiling"] = {{"subdivisionScheme", "QUADTREE"},
                            {"subtreeLevels", 2},
                            {"availableLevels", 3},
                            {"subtrees", {{"uri", "s/{level}-{x}-{y}.subtree"}}}};
  const auto subtree = [](const Json& json, const std::string& binary) {
    std::string text = json.dump(), bits = binary, out = "subt";
    pad(text, ' ', 8);
    pad(bits, '\0', 8);
    put(out, std::uint32_t{1});
    put(out, static_cast<std::uint64_t>(text.size()));
    put(out, static_cast<std::uint64_t>(bits.size()));
    return out + text + bits;
  };
  // Tiles: root, (0,0), (1,0) → bits 0, 1, 2; below (1,0), at (3,1) of level 2: index by Morton 4 + 3 = 7.
  std::string bits{'\x07', '\0', '\0', '\0', '\0', '\0', '\0', '\0', '\x80', '\0'};
  const Json first = {
      {"buffers", {{{"byteLength", 10}}}},
      {"bufferViews",
       {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 1}}, {{"buffer", 0}, {"byteOffset", 8}, {"byteLength", 2}}}},
      {"tileAvailability", {{"bitstream", 0}}},
      {"contentAvailability", Json::array({Json{{"bitstream", 0}}})},
      {"childSubtreeAvailability", {{"bitstream", 1}}}};
  file("s/0-0-0.subtree", subtree(first, bits));
  const Json last = {{"tileAvailability", {{"constant", 1}}},
                     {"contentAvailability", Json::array({Json{{"constant", 1}}})},
                     {"childSubtreeAvailability", {{"constant", 0}}}};
  file("s/2-3-1.subtree", last.dump());
  put_tile("t/0-0-0.glb", 1);
  put_tile("t/1-0-0.glb", 11, 11);
  put_tile("t/1-1-0.glb", 41, 11);
  put_tile("t/2-3-1.glb", 51, 21);
  const auto path = file("tileset.json", tileset(root));
  EXPECT_EQ(places(alone(path)), (std::vector<int>{11, 51}));
  Options options;
  options.tile_error = 8;
  EXPECT_EQ(places(alone(path, options)), (std::vector<int>{11, 41}));
  options.tile_error = 16;
  EXPECT_EQ(places(alone(path, options)), std::vector<int>{1});

  // The quarter of a tile's volume decides: with 50 m around the box, (0,0) of a tree of 640 m is out of reach.
  root["boundingVolume"] = box(0, 0, 640, 640);
  file("tileset.json", tileset(root));
  file("t/1-0-0.glb", "poison");
  put_tile("t/2-3-1.glb", 500, 200);
  Options near;
  near.bbox = {480, 180, 520, 220};
  EXPECT_EQ(places(alone(path, near)), std::vector<int>{500});

  file("s/0-0-0.subtree", subtree(first, bits).substr(0, 60));
  EXPECT_EQ(code(alone(path)), "ingest-mesh-truncated");
}

TEST_F(Tiles, what_is_wrong_is_said_with_the_file_that_it_is_wrong_with) {
  EXPECT_EQ(code(alone(file("a.json", R"({"type":"CityJSON"})"))), "ingest-mesh-format");
  EXPECT_EQ(code(alone(file("b.json", "{"))), "ingest-mesh-format");
  EXPECT_EQ(code(alone(at("none.json"))), "file-missing");
  const auto missing = alone(file("c.json", tileset(tile(box(0, 0, 1, 1), 0, "none.glb"))));
  ASSERT_EQ(code(missing), "file-missing");
  EXPECT_EQ(missing.error().subject, at("none.glb").string());
  const auto ring = alone(file("d.json", tileset(tile(box(0, 0, 1, 1), 0, "d.json"))));
  ASSERT_EQ(code(ring), "ingest-mesh-format");
  EXPECT_THAT(ring.error().message, HasSubstr("nested"));
  auto json = Json::parse(tileset(tile(box(0, 0, 1, 1), 0, "a.glb")));
  json["extensionsRequired"] = {"VENDOR_tiles"};
  const auto unknown = alone(file("e.json", json.dump()));
  ASSERT_EQ(code(unknown), "ingest-mesh-format");
  EXPECT_THAT(unknown.error().message, HasSubstr("VENDOR_tiles"));
  auto bent = tile(box(0, 0, 1, 1), 0, "a.glb");
  bent["transform"] = {1, 2, 3};
  EXPECT_EQ(code(alone(file("f.json", tileset(bent)))), "ingest-mesh-format");
}

TEST(TileAddress, is_found_beside_its_file_wherever_that_is) {
  using formats::address_beside;
  EXPECT_EQ(formats::address_beside("tileset.json", "a.glb"), "a.glb");
  EXPECT_EQ(formats::address_beside("/a/b/t.json", "../c/./x.glb"), "/a/c/x.glb");
  EXPECT_EQ(formats::address_beside("/a/b/t.json", "c\\x%20y.glb?v=2"), "/a/b/c/x y.glb");
  EXPECT_EQ(formats::address_beside("../t.json", "../a.glb"), "../../a.glb");
  EXPECT_EQ(formats::address_beside("/vsicurl/https://h/x/t.json?key=1", "a%20b.glb?v=2"),
            "/vsicurl/https://h/x/a%20b.glb?v=2");
  EXPECT_EQ(formats::address_beside("/vsicurl/https://h/x/t.json", "/y/a.glb"), "/vsicurl/https://h/y/a.glb");
  EXPECT_EQ(formats::address_beside("/a/t.json", "https://h/a.glb"), "/vsicurl/https://h/a.glb");
}

}  // namespace
}  // namespace mansard::ingest::test
