// 3D Tiles: where tiles are on Earth, what their boxes hold, which building is in which, and the way back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <cmath>
#include <filesystem>
#include <functional>

#include "base/scratch.hpp"
#include "cities.hpp"
#include "gltf.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/stream.hpp"
#include "mansard/formats/tiles3d/tiles_tree.hpp"

namespace {

using namespace cities;
using namespace mansard;
using gltf::Glb;
using gltf::Json;

using Matrix = std::array<double, 16>;  // column by column

auto apply(const Matrix& m, Point3 p) -> Point3 {
  return {m[0] * p.x + m[4] * p.y + m[8] * p.z + m[12], m[1] * p.x + m[5] * p.y + m[9] * p.z + m[13],
          m[2] * p.x + m[6] * p.y + m[10] * p.z + m[14]};
}

auto times(const Matrix& a, const Matrix& b) -> Matrix {
  Matrix out{};
  for (std::size_t c = 0; c < 4; ++c)
    for (std::size_t r = 0; r < 4; ++r)
      for (std::size_t k = 0; k < 4; ++k) out[4 * c + r] += a[4 * k + r] * b[4 * c + k];
  return out;
}

/// Houses on a grid, `spacing` metres apart.
auto grid(int side, double spacing) -> City {
  City city = street();
  city.buildings.clear();
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const double x = spacing * i, y = spacing * j, ridge = 8 + (i * 7 + j * 3) % 4;
      Building house{
          std::to_string(i) + "/" + std::to_string(j), {{"row", std::int64_t{j}}}, {rectangle(x, y, 10, 8)}, 0, {}};
      house.parts = {{house.id + "-1", plan_of(house.footprint[0], 0, 10), gable(x, y, 10, 8, 0, 5, ridge), {}}};
      city.buildings.push_back(std::move(house));
    }
  return city;
}

struct Tile {
  Json json;
  Matrix transform{};  ///< to the frame of the whole
  int depth = 0;
};

class Tiles : public testing::Test {
 protected:
  void write(const City& city, double triangles = 20000, bool compress = false) {
    formats::WriteOptions options;
    options.tile_triangles = triangles;
    options.compress = compress;
    base::Outputs outputs;
    auto writer = formats::open_writer(formats::Format::tiles, folder_, {city.frame, city.made_by}, options, outputs);
    ASSERT_TRUE(writer) << to_string(writer.error());
    const auto done = formats::write_city(city, **writer);
    ASSERT_TRUE(done) << to_string(done.error());
    ASSERT_TRUE(outputs.commit());
    warnings_ = (*writer)->warnings();
  }
  auto tileset() const -> Json { return Json::parse(*base::read_file(folder_ / "tileset.json")); }
  auto all() const -> std::vector<Tile> {
    std::vector<Tile> tiles;
    const std::function<void(const Json&, const Matrix&, int)> walk = [&](const Json& json, const Matrix& outer,
                                                                          int depth) {
      const Matrix here = times(outer, json.at("transform").get<Matrix>());
      tiles.push_back({json, here, depth});
      if (json.contains("children"))
        for (const auto& child : json["children"]) walk(child, here, depth + 1);
    };
    walk(tileset()["root"], {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, 0);
    return tiles;
  }
  auto glb(const Tile& tile) const -> Glb {
    return Glb(*base::read_file(folder_ / tile.json["content"]["uri"].get<std::string>()));
  }
  static auto corners(const Glb& glb) -> std::vector<Point3> {
    std::vector<Point3> out;
    if (glb.json.contains("meshes"))
      for (const auto& p : glb.accessor<gltf::Float3>(glb.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"]))
        out.push_back({p[0], -static_cast<double>(p[2]), p[1]});
    return out;
  }

  test::Scratch scratch_;
  std::filesystem::path folder_ = scratch_ / "tiles";
  std::vector<base::Diagnostic> warnings_;
};

/// Earth-centred by PROJ alone, all the way.
auto by_proj(const City& city, Point3 p) -> Point3 {
  OGRSpatialReference from, angles, earth;
  from.SetFromUserInput(city.frame.crs.c_str());
  angles.importFromEPSG(4326);
  from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  angles.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  OGRSpatialReference height;
  height.importFromEPSG(4979);
  height.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  earth.importFromEPSG(4978);
  double x = p.x + static_cast<double>(city.frame.origin[0]), y = p.y + static_cast<double>(city.frame.origin[1]),
         z = p.z + static_cast<double>(city.frame.origin[2]);
  for (const auto& [a, b] : {std::pair{&from, &angles}, std::pair{&height, &earth}}) {
    OGRCoordinateTransformation* t = OGRCreateCoordinateTransformation(a, b);
    EXPECT_TRUE(t != nullptr && t->Transform(1, &x, &y, &z));
    OGRCoordinateTransformation::DestroyCT(t);
  }
  return {x, y, z};
}

TEST_F(Tiles, stand_where_proj_says_over_twenty_kilometres) {
  const City city = grid(5, 5000);
  write(city, 30);
  std::map<std::string, Point3> foot;  // of a wall at the south-west corner
  for (const auto& building : city.buildings) foot[building.id] = building.parts[0].model.solid.vertices[0];
  std::size_t leaves = 0;
  double worst = 0;
  for (const auto& tile : all()) {
    const Glb content = glb(tile);
    const auto ids = content.texts(0, "building_id");
    const auto part =
        content.accessor<float>(content.json["meshes"][0]["primitives"][0]["attributes"]["_FEATURE_ID_0"]);
    const auto points = corners(content);
    std::map<std::string, double> nearest;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::string& id = ids.at(static_cast<std::size_t>(part.at(i)));
      const double d = length(apply(tile.transform, points[i]) - by_proj(city, foot[id]));
      nearest[id] = nearest.contains(id) ? std::min(nearest[id], d) : d;
    }
    // In single precision relative to the tile: a millimetre within 8 km of its centre.
    for (const auto& [id, d] : nearest) worst = std::max(worst, d);
    leaves += tile.json.contains("children") ? 0U : 1U;
  }
  EXPECT_GT(leaves, 9U);
  EXPECT_LT(worst, 0.002);
}

TEST_F(Tiles, stand_in_one_place_whether_the_crs_has_heights_or_not) {
  City city = street();
  const auto longitude_and_latitude = [&](const char* crs) {
    city.frame.crs = crs;
    write(city);
    const auto root = tileset()["root"]["transform"].get<Matrix>();
    OGRSpatialReference earth, angles;
    earth.importFromEPSG(4978);
    angles.importFromEPSG(4979);
    angles.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    Point3 p{root[12], root[13], root[14]};
    OGRCoordinateTransformation* t = OGRCreateCoordinateTransformation(&earth, &angles);
    EXPECT_TRUE(t != nullptr && t->Transform(1, &p.x, &p.y, &p.z));
    OGRCoordinateTransformation::DestroyCT(t);
    return p;
  };
  const Point3 plane = longitude_and_latitude("EPSG:28992"), with_heights = longitude_and_latitude("EPSG:7415");
  const std::string said = tileset()["asset"]["extras"]["heights"];
  EXPECT_NEAR(plane.x, with_heights.x, 1e-5) << "degrees";
  EXPECT_NEAR(plane.y, with_heights.y, 1e-5);
  // The geoid is 43 m above the ellipsoid there, if this machine has it.
  const bool raised = with_heights.z - plane.z > 40;
  EXPECT_NEAR(with_heights.z - plane.z, raised ? 43 : 0, 1);
  ASSERT_EQ(warnings_.size(), raised ? 0U : 1U);
  EXPECT_THAT(said, testing::HasSubstr(raised ? "are those of the coordinate system" : "no geoid"));
  if (!raised) {
    EXPECT_EQ(warnings_[0].code, "write-tiles-grid");
  }
}

TEST_F(Tiles, hold_their_contents_and_children_in_their_boxes) {
  for (const bool compress : {false, true}) {
    write(grid(12, 400), 100, compress);
    const auto tiles = all();
    EXPECT_GT(std::ranges::max(tiles, {}, &Tile::depth).depth, 1);
    for (const auto& outer : tiles) {
      const auto box = outer.json["boundingVolume"]["box"].get<std::array<double, 12>>();
      for (const auto& inner : tiles) {
        // Its own content, and that of every tile below.
        const auto is_below = [&](const auto& self, const Json& json) -> bool {
          if (json == inner.json) return true;
          if (json.contains("children"))
            for (const auto& child : json["children"])
              if (self(self, child)) return true;
          return false;
        };
        if (!is_below(is_below, outer.json)) continue;
        for (const Point3 p : corners(glb(inner))) {
          const Point3 d = apply(inner.transform, p) - apply(outer.transform, {box[0], box[1], box[2]});
          for (std::size_t axis = 0; axis < 3; ++axis) {
            const Point3 column{outer.transform[4 * axis], outer.transform[4 * axis + 1],
                                outer.transform[4 * axis + 2]};
            EXPECT_LE(std::abs(dot(d, column)), box[3 + 4 * axis]);
          }
        }
      }
    }
  }
}

TEST_F(Tiles, have_every_building_in_one_leaf_and_errors_that_fall) {
  const City city = grid(12, 40);
  write(city, 100);
  std::map<std::string, int> leaves_of;
  const std::function<void(const Json&)> fall = [&](const Json& json) {
    if (!json.contains("children")) return;
    for (const auto& child : json["children"]) {
      EXPECT_LE(child["geometricError"], json["geometricError"]);
      fall(child);
    }
  };
  fall(tileset()["root"]);
  for (const auto& tile : all()) {
    const Glb content = glb(tile);
    std::size_t triangles = 0;
    for (const auto& primitive : content.json["meshes"][0]["primitives"])
      triangles += content.json["accessors"][primitive["indices"].get<std::size_t>()]["count"].get<std::size_t>() / 3;
    EXPECT_LE(triangles, 100U);
    if (tile.json.contains("children")) {
      EXPECT_GT(tile.json["geometricError"], 0);
      EXPECT_EQ(content.metadata()["propertyTables"].size(), 2U) << "without the table of records";
      continue;
    }
    EXPECT_EQ(tile.json["geometricError"], 0);
    for (const auto& id : content.texts(0, "building_id")) ++leaves_of[id];
  }
  EXPECT_EQ(leaves_of.size(), city.buildings.size());
  for (const auto& [id, count] : leaves_of) EXPECT_EQ(count, 1) << id;
  EXPECT_GT(tileset()["geometricError"], tileset()["root"]["geometricError"]);
}

TEST_F(Tiles, state_the_largest_vertical_difference) {
  City city = grid(2, 100);  // eaves at 5 m; ridges at 8, 11, 11 and 10 m: half of the highest roof is 3 m
  write(city, 40);
  EXPECT_EQ(tileset()["root"]["geometricError"], 3);
  city.buildings[0].parts[0].attributes = {{"ms_h_roof_70p", 7.5}};  // 2.5 m above its eaves: not the largest
  write(city, 40);
  EXPECT_EQ(tileset()["root"]["geometricError"], 3);
  city.buildings[1].parts[0].attributes = {{"ms_h_roof_70p", 5.5}};  // its ridge of 11 m is 5.5 m higher
  write(city, 40);
  EXPECT_EQ(tileset()["root"]["geometricError"], 5.5);
}

TEST_F(Tiles, are_read_back_in_order_and_written_the_same) {
  City city = grid(6, 50);
  std::ranges::reverse(city.buildings);
  city.buildings.insert(city.buildings.begin() + 3, Building{"bare", {}, {rectangle(60, 60, 3, 3)}, 0, {}});
  write(city, 100);
  const auto bytes = *base::read_file(folder_ / "tileset.json"),
             leaf = *base::read_file(folder_ / all().back().json["content"]["uri"].get<std::string>());
  for (const auto& path : {folder_, folder_ / "tileset.json"}) {
    auto reader = formats::read_city(path);
    ASSERT_TRUE(reader) << to_string(reader.error());
    auto back = formats::read_whole(**reader);
    ASSERT_TRUE(back) << to_string(back.error());
    ASSERT_EQ(back->buildings.size(), city.buildings.size());
    for (std::size_t b = 0; b < city.buildings.size(); ++b) {
      EXPECT_EQ(back->buildings[b].id, city.buildings[b].id);
      for (std::size_t p = 0; p < city.buildings[b].parts.size(); ++p)
        back->buildings[b].parts.at(p).model = city.buildings[b].parts[p].model;
    }
    write(*back, 100);
    EXPECT_EQ(*base::read_file(folder_ / "tileset.json"), bytes);
    EXPECT_EQ(*base::read_file(folder_ / all().back().json["content"]["uri"].get<std::string>()), leaf);
  }
}

TEST_F(Tiles, without_a_crs_stay_in_the_local_frame) {
  City city = street();
  city.frame.crs.clear();
  write(city);
  const auto root = all().at(0);
  EXPECT_THAT(tileset()["asset"]["extras"]["heights"], testing::HasSubstr("local frame"));
  const auto placed = apply(root.transform, corners(glb(root)).at(0));
  EXPECT_NEAR(placed.x, 1.0625, 20) << "near the house, not on Earth";
  EXPECT_EQ(root.json["transform"][0], 1);
}

TEST_F(Tiles, say_when_a_crs_is_not_on_earth) {
  City city = street();
  city.frame.crs = R"(LOCAL_CS["site",UNIT["metre",1]])";
  base::Outputs outputs;
  const auto writer = formats::open_writer(formats::Format::tiles, folder_, {city.frame, city.made_by}, {}, outputs);
  ASSERT_FALSE(writer);
  EXPECT_EQ(writer.error().code, "write-tiles-crs");
}

TEST_F(Tiles, of_nothing_are_a_tileset_without_content) {
  City city = street();
  city.buildings.clear();
  write(city);
  EXPECT_FALSE(tileset()["root"].contains("content"));
  auto reader = formats::read_city(folder_);
  ASSERT_TRUE(reader);
  EXPECT_FALSE((*reader)->next()->has_value());
}

TEST_F(Tiles, outside_of_their_folder_are_not_read) {
  write(street());
  auto json = tileset();
  for (const std::string uri : {"../x.glb", "/etc/passwd", "http://x/y.glb"}) {
    json["root"]["content"]["uri"] = uri;
    ASSERT_TRUE(base::write_file(folder_ / "tileset.json", json.dump()));
    const auto reader = formats::read_city(folder_);
    ASSERT_FALSE(reader);
    EXPECT_EQ(reader.error().code, "write-read-format");
  }
  json["asset"].erase("extras");
  ASSERT_TRUE(base::write_file(folder_ / "tileset.json", json.dump()));
  EXPECT_EQ(formats::read_city(folder_).error().code, "write-read-plans");
}

TEST(TileTree, ends_with_buildings_that_all_lie_in_one_place) {
  std::vector<formats::detail::TileItem> items(50);
  for (auto& item : items) item.triangles = 100;
  const auto tree = formats::detail::tile_tree(items, 250);
  std::size_t count = 0;
  for (const auto& tile : tree.tiles)
    if (tile.children.empty()) {
      EXPECT_LE(tile.count, 2U);
      count += tile.count;
    }
  EXPECT_EQ(count, items.size());
}

}  // namespace
