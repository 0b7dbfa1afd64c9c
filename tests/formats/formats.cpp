// OBJ and GLB.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cities.hpp"
#include "mansard/base/text.hpp"

namespace {

constexpr auto parts = mansard::formats::Solids::part;

using namespace cities;
using Json = nlohmann::json;
using testing::ElementsAre;

struct ReadObj {
  std::string library;
  std::vector<Point3> vertices;
  struct Facet {
    std::string group, material;
    std::vector<std::size_t> corners;
  };
  std::vector<Facet> facets;
  std::vector<std::string> groups;
};

auto read_obj(const std::string& text) -> ReadObj {
  ReadObj out;
  std::istringstream lines(text);
  std::string line, material;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::string word, a, b, c;
    words >> word;
    if (word == "mtllib") words >> out.library;
    if (word == "g") words >> out.groups.emplace_back();
    if (word == "usemtl") words >> material;
    if (word == "v") {
      words >> a >> b >> c;
      out.vertices.push_back(
          {*mansard::base::to_number(a), *mansard::base::to_number(b), *mansard::base::to_number(c)});
    }
    if (word == "f") {
      auto& facet = out.facets.emplace_back(ReadObj::Facet{out.groups.back(), material, {}});
      for (std::size_t i = 0; words >> i;) facet.corners.push_back(i - 1);
    }
  }
  return out;
}

auto area_of(const std::vector<Point3>& loop) -> Point3 {
  Point3 area2;
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) area2 = area2 + cross(loop[i] - loop[0], loop[i + 1] - loop[0]);
  return 0.5 * area2;
}

auto street_obj() -> ReadObj {
  const auto files = mansard::formats::obj(street(), "model.mtl", parts);
  EXPECT_TRUE(files);
  return read_obj(files->obj);
}

TEST(Obj, has_a_group_for_every_part) {
  const auto obj = street_obj();
  EXPECT_THAT(obj.groups, ElementsAre("house-1", "block-1", "block-2"));
  EXPECT_EQ(obj.library, "model.mtl");
}

TEST(Obj, gives_coordinates_in_full_in_the_frame_of_the_file) {
  const auto obj = street_obj();
  EXPECT_THAT(obj.vertices, testing::Contains(Point3{84801.0625, 447402.125, 1.25})) << "to the bit";
  const auto files = mansard::formats::obj(street(), "model.mtl", parts);
  EXPECT_THAT(files->obj, testing::HasSubstr("v 84801.0625 447402.125 1.25\n"));
}

TEST(Obj, welds_vertices_within_a_part) {
  const auto obj = street_obj();
  EXPECT_EQ(obj.vertices.size(), 10U + 16U + 8U);
  std::map<std::string, std::set<Point3>> seen;
  std::map<std::string, std::set<std::size_t>> numbers;
  for (const auto& facet : obj.facets)
    for (const auto corner : facet.corners) {
      ASSERT_LT(corner, obj.vertices.size());
      seen[facet.group].insert(obj.vertices[corner]);
      numbers[facet.group].insert(corner);
    }
  for (const auto& [group, points] : seen) EXPECT_EQ(points.size(), numbers[group].size()) << group;
}

TEST(Obj, keeps_whole_faces_and_cuts_only_those_with_holes) {
  const auto obj = street_obj();
  std::map<std::string, std::size_t> triangles, others;
  for (const auto& facet : obj.facets) ++(facet.corners.size() == 3 ? triangles : others)[facet.group];
  EXPECT_EQ(others["house-1"], 7U);
  EXPECT_EQ(triangles["house-1"], 0U);
  EXPECT_EQ(others["block-1"], 8U);
  EXPECT_EQ(triangles["block-1"], 16U) << "ground and roof, 8 points and a hole each";
}

TEST(Obj, is_closed_and_outward_part_by_part) {
  const auto obj = street_obj();
  std::map<std::string, double> volume;
  std::map<std::pair<std::size_t, std::size_t>, int> edges;
  const Point3 near{84800, 447400, 0};
  for (const auto& facet : obj.facets) {
    std::vector<Point3> loop;
    for (std::size_t i = 0; i < facet.corners.size(); ++i) {
      loop.push_back(obj.vertices[facet.corners[i]] - near);
      ++edges[{facet.corners[i], facet.corners[(i + 1) % facet.corners.size()]}];
    }
    volume[facet.group] += dot(loop[0], area_of(loop)) / 3;
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1U);
  }
  EXPECT_NEAR(volume["house-1"], 640, 1e-6);
  EXPECT_NEAR(volume["block-1"], 3600, 1e-6);
  EXPECT_NEAR(volume["block-2"], 400, 1e-6);
}

TEST(Obj, uses_a_material_for_each_class) {
  const auto obj = street_obj();
  std::map<std::string, double> areas;
  for (const auto& facet : obj.facets) {
    if (facet.group != "block-2") continue;
    std::vector<Point3> loop;
    for (const auto corner : facet.corners) loop.push_back(obj.vertices[corner]);
    areas[facet.material] += length(area_of(loop));
  }
  EXPECT_NEAR(areas["party_wall"], 80, 1e-6);
  EXPECT_NEAR(areas["wall"], 80 + 20 + 20, 1e-6);
  EXPECT_NEAR(areas["roof"], 100, 1e-6);
  EXPECT_NEAR(areas["ground"], 100, 1e-6);
  const auto mtl = mansard::formats::obj(street(), "m", parts)->mtl;
  for (const char* name : {"wall", "party_wall", "roof", "ground"})
    EXPECT_THAT(mtl, testing::HasSubstr(std::string("newmtl ") + name + "\nKd 0."));
}

TEST(Obj, writes_names_as_one_word_and_comments_as_one_line) {
  City city = street();
  city.buildings[0].parts[0].id = "my house #1\nv 0 0 0";
  city.frame.crs = "PROJCS[\n\"x\"]";
  const auto obj = mansard::formats::obj(city, "m.mtl", parts)->obj;
  EXPECT_THAT(obj, testing::HasSubstr("g my_house__1_v_0_0_0\n"));
  EXPECT_THAT(obj, testing::HasSubstr("# crs PROJCS[ \"x\"]\n"));
}

struct ReadGlb {
  Json json;
  std::string binary;

  template <class T>
  auto accessor(std::size_t index) const -> std::vector<T> {
    const auto& a = json["accessors"][index];
    const auto& view = json["bufferViews"][a["bufferView"].get<std::size_t>()];
    std::vector<T> out(a["count"].get<std::size_t>());
    const std::size_t at = view["byteOffset"].get<std::size_t>() + a["byteOffset"].get<std::size_t>();
    EXPECT_LE(at + out.size() * sizeof(T), binary.size());
    EXPECT_LE(a["byteOffset"].get<std::size_t>() + out.size() * sizeof(T), view["byteLength"].get<std::size_t>());
    std::memcpy(out.data(), binary.data() + at, out.size() * sizeof(T));
    return out;
  }
};

auto read_glb(const std::string& bytes) -> ReadGlb {
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
  };
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(number(4), 2U);
  EXPECT_EQ(number(8), bytes.size());
  const std::size_t json_size = number(12);
  EXPECT_EQ(bytes.substr(16, 4), "JSON");
  EXPECT_EQ(json_size % 4, 0U);
  ReadGlb out{Json::parse(bytes.substr(20, json_size)), {}};
  if (20 + json_size < bytes.size()) {
    EXPECT_EQ(number(20 + json_size) % 4, 0U);
    EXPECT_EQ(bytes.substr(24 + json_size, 4), std::string("BIN\0", 4));
    out.binary = bytes.substr(28 + json_size);
    EXPECT_EQ(out.binary.size(), number(20 + json_size));
    EXPECT_EQ(out.json["buffers"][0]["byteLength"], out.binary.size());
  }
  return out;
}

using Float3 = std::array<float, 3>;

auto z_up(const Float3& v) -> Point3 { return {v[0], -static_cast<double>(v[2]), v[1]}; }

TEST(Glb, has_a_node_for_every_part) {
  const auto glb = read_glb(*mansard::formats::glb(street(), parts));
  ASSERT_EQ(glb.json["nodes"].size(), 3U);
  EXPECT_EQ(glb.json["scenes"][0]["nodes"], Json({0, 1, 2}));
  EXPECT_EQ(glb.json["nodes"][2]["name"], "block-2");
  EXPECT_EQ(glb.json["nodes"][2]["extras"]["building"], "block");
}

TEST(Glb, keeps_origin_reference_system_and_how_it_was_made) {
  const auto asset = read_glb(*mansard::formats::glb(street(), parts)).json["asset"];
  EXPECT_EQ(asset["version"], "2.0");
  EXPECT_EQ(asset["extras"]["origin"], Json({84800, 447400, 0}));
  EXPECT_EQ(asset["extras"]["crs"], "EPSG:28992");
  EXPECT_EQ(asset["extras"]["header"]["made_by"]["inputs"][0]["path"], "mesh.ply");
}

TEST(Glb, holds_closed_outward_parts_with_y_up) {
  const auto glb = read_glb(*mansard::formats::glb(street(), parts));
  const std::map<std::string, double> expected{{"house-1", 640}, {"block-1", 3600}, {"block-2", 400}};
  for (const auto& mesh : glb.json["meshes"]) {
    double volume = 0;
    for (const auto& primitive : mesh["primitives"]) {
      const auto positions = glb.accessor<Float3>(primitive["attributes"]["POSITION"]);
      const auto normals = glb.accessor<Float3>(primitive["attributes"]["NORMAL"]);
      const auto indices = glb.accessor<std::uint32_t>(primitive["indices"]);
      ASSERT_EQ(positions.size(), normals.size());
      ASSERT_EQ(indices.size() % 3, 0U);
      for (std::size_t i = 0; i < indices.size(); i += 3) {
        ASSERT_LT(std::max({indices[i], indices[i + 1], indices[i + 2]}), positions.size());
        const Point3 a = z_up(positions[indices[i]]), b = z_up(positions[indices[i + 1]]),
                     c = z_up(positions[indices[i + 2]]);
        const Point3 n = cross(b - a, c - a);
        volume += dot(a, n) / 6;
        for (int k = 0; k < 3; ++k)
          EXPECT_NEAR(dot(normalised(n), z_up(normals[indices[i + static_cast<std::size_t>(k)]])), 1, 1e-5) << "flat";
      }
    }
    EXPECT_NEAR(volume, expected.at(mesh["name"]), 1e-2);
  }
}

TEST(Glb, states_the_exact_bounds_of_positions) {
  const auto glb = read_glb(*mansard::formats::glb(street(), parts));
  for (const auto& mesh : glb.json["meshes"])
    for (const auto& primitive : mesh["primitives"]) {
      const std::size_t index = primitive["attributes"]["POSITION"];
      Float3 least{1e9F, 1e9F, 1e9F}, most{-1e9F, -1e9F, -1e9F};
      for (const auto& p : glb.accessor<Float3>(index))
        for (std::size_t axis = 0; axis < 3; ++axis) {
          least[axis] = std::min(least[axis], p[axis]);
          most[axis] = std::max(most[axis], p[axis]);
        }
      EXPECT_EQ(glb.json["accessors"][index]["min"].get<Float3>(), least);
      EXPECT_EQ(glb.json["accessors"][index]["max"].get<Float3>(), most);
    }
}

TEST(Glb, colours_by_class) {
  const auto glb = read_glb(*mansard::formats::glb(street(), parts));
  std::map<std::string, double> areas;
  for (const auto& primitive : glb.json["meshes"][2]["primitives"]) {
    const auto positions = glb.accessor<Float3>(primitive["attributes"]["POSITION"]);
    const auto indices = glb.accessor<std::uint32_t>(primitive["indices"]);
    const std::string name = glb.json["materials"][primitive["material"].get<std::size_t>()]["name"];
    for (std::size_t i = 0; i < indices.size(); i += 3)
      areas[name] += length(
          area_of({z_up(positions[indices[i]]), z_up(positions[indices[i + 1]]), z_up(positions[indices[i + 2]])}));
  }
  EXPECT_NEAR(areas["party_wall"], 80, 1e-3);
  EXPECT_NEAR(areas["wall"], 120, 1e-3);
  EXPECT_NEAR(areas["roof"], 100, 1e-3);
  EXPECT_NEAR(areas["ground"], 100, 1e-3);
}

TEST(Glb, is_valid_without_any_part) {
  City city = street();
  for (auto& building : city.buildings) building.parts.clear();
  const auto glb = read_glb(*mansard::formats::glb(city, parts));
  EXPECT_FALSE(glb.json.contains("meshes"));
  EXPECT_EQ(glb.json["extensions"]["EXT_structural_metadata"]["propertyTables"][0]["count"], 2) << "the buildings";
  city.buildings.clear();
  const auto empty = read_glb(*mansard::formats::glb(city, parts));
  EXPECT_FALSE(empty.json.contains("buffers"));
  EXPECT_TRUE(empty.binary.empty());
}

TEST(Formats, are_the_same_bytes_every_time) {
  EXPECT_EQ(*mansard::formats::glb(street(), parts), *mansard::formats::glb(street(), parts));
  EXPECT_EQ(mansard::formats::obj(street(), "m", parts)->obj, mansard::formats::obj(street(), "m", parts)->obj);
  EXPECT_EQ(*mansard::formats::cityjson(street()), *mansard::formats::cityjson(street()));
}

TEST(Formats, refuse_two_buildings_of_one_id_and_broken_models) {
  City twice = street(), broken = street();
  twice.buildings[1].id = "house";
  broken.buildings[0].parts[0].model.solid.vertices[0].x = std::nan("");
  EXPECT_EQ(mansard::formats::glb(twice, parts).error().code, "write-duplicate-id");
  EXPECT_EQ(mansard::formats::obj(twice, "m", parts).error().code, "write-duplicate-id");
  EXPECT_EQ(mansard::formats::glb(broken, parts).error().code, "write-model");
  EXPECT_EQ(mansard::formats::obj(broken, "m", parts).error().code, "write-model");
}

}  // namespace
