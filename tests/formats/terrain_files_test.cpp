// A terrain is the same surface in every format, in the frame of the models.
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>

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

TEST_F(TerrainFiles, tileset_of_few_triangles_is_one_tile) {
  const auto folder = write(Format::tiles, "t.3dtiles");
  const auto root = Json::parse(*base::read_file(folder / "tileset.json"))["root"];
  EXPECT_TRUE(std::filesystem::exists(folder / root["content"]["uri"].get<std::string>()));
  EXPECT_FALSE(root.contains("children"));
  EXPECT_EQ(root["geometricError"], 0);
}

/// Corners by single precision, so that those of different tiles are compared bit by bit.
using Corner = std::array<float, 3>;
struct TileMesh {
  std::vector<std::array<Corner, 3>> triangles;
  /// Edges of one triangle, in its direction.
  [[nodiscard]] auto border() const -> std::set<std::pair<Corner, Corner>> {
    std::set<std::pair<Corner, Corner>> out;
    for (const auto& t : triangles)
      for (std::size_t i = 0; i < 3; ++i)
        if (out.erase({t[(i + 1) % 3], t[i]}) == 0) out.insert({t[i], t[(i + 1) % 3]});
    return out;
  }
};

/// Triangles that face down: y is up. Those of three corners on one line may have any side.
auto folded(const TileMesh& mesh) -> std::ptrdiff_t {
  return std::ranges::count_if(mesh.triangles, [](const auto& t) {
    const auto side = [&](std::size_t i, std::size_t axis) { return double(t[i][axis]) - double(t[0][axis]); };
    return side(1, 2) * side(2, 0) - side(1, 0) * side(2, 2) < -0.01;
  });
}

auto read_tile(const std::filesystem::path& path) -> TileMesh {
  const auto bytes = *base::read_file(path);
  std::uint32_t size = 0;
  std::memcpy(&size, bytes.data() + 12, 4);
  const auto json = Json::parse(bytes.substr(20, size));
  const auto* binary = bytes.data() + 28 + size;
  const auto at = [&](std::size_t accessor) {
    return binary + json["bufferViews"][accessor]["byteOffset"].get<std::size_t>();
  };
  std::vector<Corner> corners(json["accessors"][0]["count"].get<std::size_t>());
  std::memcpy(corners.data(), at(0), corners.size() * sizeof(Corner));
  std::vector<std::uint32_t> indices(json["accessors"][2]["count"].get<std::size_t>());
  std::memcpy(indices.data(), at(2), indices.size() * 4);
  TileMesh out;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    out.triangles.push_back({corners[indices[i]], corners[indices[i + 1]], corners[indices[i + 2]]});
  return out;
}

/// A hilly square of 60 by 60 m around a building, whose ground is not part of it.
class HillyTiles : public TerrainFiles {
 protected:
  HillyTiles() {
    mesh_ = {};
    constexpr std::uint32_t side = 61;
    for (std::uint32_t y = 0; y < side; ++y)
      for (std::uint32_t x = 0; x < side; ++x)
        mesh_.vertices.push_back(
            {double(x), double(y), 3 * std::sin(0.1 * x) * std::cos(0.13 * y) + 0.01 * (x * y % 7)});
    for (std::uint32_t y = 0; y + 1 < side; ++y)
      for (std::uint32_t x = 0; x + 1 < side; ++x) {
        const std::uint32_t v = y * side + x;
        auto& triangles = x >= 20 && x < 30 && y >= 20 && y < 25 ? below_.triangles : mesh_.triangles;
        triangles.push_back({v, v + 1, v + side});
        triangles.push_back({v + 1, v + side + 1, v + side});
      }
    below_.vertices = mesh_.vertices;
  }
  auto tiles(const std::string& name) -> std::filesystem::path {
    base::Outputs outputs;
    formats::WriteOptions options;
    options.tile_triangles = 200;
    const auto path = folder_ / name;
    const auto done =
        formats::write_terrain(Format::tiles, path, mesh_, {frame_, {"0", {}, {}, {}}}, options, outputs, below_);
    EXPECT_TRUE(done) << to_string(done.error());
    EXPECT_TRUE(outputs.commit());
    return path;
  }
  geometry::Mesh below_;
};

TEST_F(HillyTiles, have_levels_that_meet_without_cracks) {
  below_ = {};
  const auto folder = tiles("t.3dtiles");
  const auto json = Json::parse(*base::read_file(folder / "tileset.json"));
  std::size_t leaves = 0, triangles_of_leaves = 0, coarse = 0;
  // The triangles of all leaves below a tile.
  const std::function<TileMesh(const Json&)> visit = [&](const Json& tile) {
    auto own = read_tile(folder / tile["content"]["uri"].get<std::string>());
    if (!tile.contains("children")) {
      ++leaves;
      triangles_of_leaves += own.triangles.size();
      EXPECT_LE(own.triangles.size(), 200U);
      EXPECT_EQ(tile["geometricError"], 0);
      return own;
    }
    ++coarse;
    TileMesh all;
    for (const auto& child : tile["children"]) {
      EXPECT_LE(child["geometricError"].get<double>(), tile["geometricError"].get<double>());
      const auto mesh = visit(child);
      all.triangles.insert(all.triangles.end(), mesh.triangles.begin(), mesh.triangles.end());
    }
    EXPECT_LT(own.triangles.size(), all.triangles.size() / 2);
    EXPECT_GT(tile["geometricError"], 0);
    EXPECT_EQ(own.border(), all.border());
    EXPECT_EQ(folded(own), 0);
    return all;
  };
  visit(json["root"]);
  EXPECT_EQ(json["root"]["refine"], "REPLACE");
  EXPECT_EQ(triangles_of_leaves, mesh_.triangles.size());
  EXPECT_GT(coarse, 4U);
  EXPECT_GT(leaves, 3 * coarse - 1);
}

TEST_F(HillyTiles, have_no_holes_below_buildings_from_afar) {
  const auto root = [&](const std::filesystem::path& folder) {
    const auto json = Json::parse(*base::read_file(folder / "tileset.json"));
    return read_tile(folder / json["root"]["content"]["uri"].get<std::string>());
  };
  constexpr std::size_t around_all = 4 * 60, around_the_building = 2 * (10 + 5);
  EXPECT_EQ(root(tiles("filled.3dtiles")).border().size(), around_all);
  for (auto& v : below_.vertices) v.z += 0.5;  // a step, which no level above the leaves has
  const auto step = root(tiles("step.3dtiles"));
  EXPECT_EQ(step.border().size(), around_all);
  EXPECT_EQ(folded(step), 0);
  below_ = {};
  EXPECT_EQ(root(tiles("open.3dtiles")).border().size(), around_all + around_the_building);
}

TEST_F(HillyTiles, are_as_far_from_the_terrain_as_they_say) {
  // The corners of the terrain below the triangles of the coarsest tile, in its own frame: y is up, −z north.
  frame_.crs.clear();
  const auto folder = tiles("t.3dtiles");
  const auto root = Json::parse(*base::read_file(folder / "tileset.json"))["root"];
  const auto tile = read_tile(folder / root["content"]["uri"].get<std::string>());
  const Corner origin{root["transform"][12], root["transform"][13], root["transform"][14]};
  double most = 0;
  std::size_t found = 0;
  for (const auto& v : mesh_.vertices) {
    const double x = v.x - double(origin[0]), y = v.y - double(origin[1]), z = v.z - double(origin[2]);
    for (const auto& t : tile.triangles) {
      const auto share = [&](std::size_t i) {
        const auto &a = t[(i + 1) % 3], &b = t[(i + 2) % 3];
        return (double(a[0]) - x) * (-double(b[2]) - y) - (-double(a[2]) - y) * (double(b[0]) - x);
      };
      const double area = share(0) + share(1) + share(2);
      if (area < 1e-6 || std::min({share(0), share(1), share(2)}) < 0) continue;
      const double height =
          (share(0) * double(t[0][1]) + share(1) * double(t[1][1]) + share(2) * double(t[2][1])) / area;
      most = std::max(most, std::abs(height - z));
      ++found;
      break;
    }
  }
  EXPECT_GT(found, mesh_.vertices.size() - 5);
  EXPECT_LE(most, root["geometricError"].get<double>() + 1e-3);
  EXPECT_GT(most, 0.1 * root["geometricError"].get<double>());
}

TEST_F(HillyTiles, are_the_same_bytes_every_time) {
  const auto one = tiles("one.3dtiles"), two = tiles("two.3dtiles");
  for (const auto& entry : std::filesystem::recursive_directory_iterator(one)) {
    if (!entry.is_regular_file()) continue;
    EXPECT_EQ(*base::read_file(entry.path()), *base::read_file(two / std::filesystem::relative(entry.path(), one)));
  }
}

TEST_F(TerrainFiles, other_formats_have_no_terrain) {
  EXPECT_FALSE(formats::terrain_format_of("t.gpkg"));
  EXPECT_FALSE(formats::terrain_format_of("t.tif"));
  EXPECT_EQ(formats::terrain_format_of("t.stl"), Format::stl);
}

}  // namespace
