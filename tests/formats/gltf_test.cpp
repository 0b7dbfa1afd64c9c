// What a GLB says of its parts and surfaces; compressed; read back.
#include "gltf.hpp"
#include "base/scratch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "cities.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/stream.hpp"

namespace {

using namespace cities;
using namespace mansard;
using gltf::Glb;
using gltf::Json;
using testing::ElementsAre;

class Gltf : public testing::Test {
 protected:
  auto written(const City& city, bool compress = false, formats::Solids solids = formats::Solids::part) const
      -> std::string {
    formats::WriteOptions options;
    options.compress = compress;
    options.solids = solids;
    base::Outputs outputs;
    auto writer = formats::open_writer(formats::Format::glb, path_, {city.frame, city.made_by}, options, outputs);
    EXPECT_TRUE(writer);
    const auto done = formats::write_city(city, **writer);
    EXPECT_TRUE(done) << (done ? "" : to_string(done.error()));
    EXPECT_TRUE(outputs.commit());
    for (const auto& warning : (*writer)->warnings()) warnings_.push_back(warning.code);
    return *base::read_file(path_);
  }

  test::Scratch folder_;
  std::filesystem::path path_ = folder_ / "city.glb";
  mutable std::vector<std::string> warnings_;
};

TEST_F(Gltf, is_the_same_building_by_building_and_at_once) {
  EXPECT_EQ(written(street()), *formats::glb(street(), formats::Solids::part));
  EXPECT_EQ(written(street(), false, formats::Solids::building), *formats::glb(street()));
}

TEST_F(Gltf, has_one_solid_a_building_unless_parts_are_asked_for) {
  const Glb glb(written(street(), false, formats::Solids::building));
  EXPECT_THAT(glb.texts(0, "part_id"), ElementsAre("house", "block"));
  EXPECT_THAT(warnings_, testing::IsEmpty());
}

TEST_F(Gltf, names_part_and_surface_of_every_vertex) {
  const City city = street();
  const Glb glb(written(city));
  const auto parts = glb.texts(0, "part_id"), buildings = glb.texts(0, "building_id");
  EXPECT_THAT(parts, ElementsAre("house-1", "block-1", "block-2"));
  EXPECT_THAT(buildings, ElementsAre("house", "block", "block"));
  const auto classes = glb.values<std::uint8_t>(1, "class");
  const auto slopes = glb.values<float>(1, "slope"), azimuths = glb.values<float>(1, "azimuth");
  const std::vector<std::string> names{"wall", "party_wall", "roof", "ground", "soffit"};
  std::map<std::size_t, std::set<float>> surfaces_of_class;
  for (const auto& node : glb.json["nodes"])
    for (const auto& primitive : glb.json["meshes"][node["mesh"].get<std::size_t>()]["primitives"]) {
      const auto& attributes = primitive["attributes"];
      const auto part = glb.accessor<float>(attributes["_FEATURE_ID_0"]),
                 surface = glb.accessor<float>(attributes["_FEATURE_ID_1"]);
      const auto normals = glb.accessor<gltf::Float3>(attributes["NORMAL"]);
      for (const auto i : glb.accessor<std::uint32_t>(primitive["indices"])) {
        EXPECT_EQ(parts.at(static_cast<std::size_t>(part.at(i))), node["name"].get<std::string>());
        const auto s = static_cast<std::size_t>(surface.at(i));
        const auto& material = glb.json["materials"][primitive["material"].get<std::size_t>()];
        EXPECT_EQ(names.at(classes.at(s)), material["name"].get<std::string>());
        EXPECT_NEAR(std::cos(slopes.at(s) * M_PI / 180), std::abs(normals[i][1]), 1e-3);
        if (azimuths.at(s) >= 0)
          EXPECT_NEAR(std::sin(azimuths[s] * M_PI / 180) * std::sin(slopes[s] * M_PI / 180), normals[i][0], 1e-3);
        else EXPECT_LT(slopes[s], 0.5F);
      }
      // EXT_mesh_features: the number of unique values of the attribute, which all primitives of a mesh share.
      const std::set<float> seen(surface.begin(), surface.end()), seen_parts(part.begin(), part.end());
      const auto& ids = primitive["extensions"]["EXT_mesh_features"]["featureIds"];
      EXPECT_EQ(ids[0]["featureCount"], seen_parts.size());
      EXPECT_EQ(ids[1]["featureCount"], seen.size());
    }
  EXPECT_EQ(classes.size(), 7U + 10U + 6U);
}

TEST_F(Gltf, gives_every_attribute_a_column_of_one_type) {
  City city = street();
  city.buildings[0].attributes = {{"year built", std::int64_t{1893}},
                                  {"big", std::int64_t{503100000012869}},
                                  {"mixed", 1.5},
                                  {"some", true},
                                  {"all", false},
                                  {"name", std::string("\xFFx")},
                                  {"part_id", 2.5}};
  city.buildings[1].attributes = {{"mixed", std::string("two")}, {"all", true}, {"year_built", std::int64_t{7}}};
  const Glb glb(written(city));
  const auto& properties = glb.metadata()["schema"]["classes"]["part"]["properties"];
  EXPECT_EQ(properties["year_built"],
            Json({{"name", "year built"}, {"type", "SCALAR"}, {"componentType", "INT32"}, {"noData", -2147483648LL}}));
  EXPECT_EQ(properties["year_built_2"]["name"], "year_built");
  EXPECT_EQ(properties["big"]["componentType"], "INT64");
  EXPECT_EQ(properties["mixed"]["type"], "STRING");
  EXPECT_EQ(properties["some"]["enumType"], "flag");
  EXPECT_EQ(properties["all"]["type"], "BOOLEAN");
  EXPECT_EQ(properties["part_id_2"]["componentType"], "FLOAT64");
  EXPECT_THAT(glb.values<std::int32_t>(0, "year_built"), ElementsAre(1893, -2147483647 - 1, -2147483647 - 1));
  EXPECT_THAT(glb.values<std::int64_t>(0, "big"), ElementsAre(503100000012869, -9007199254740991, -9007199254740991));
  EXPECT_THAT(glb.texts(0, "mixed"), ElementsAre("1.5", "two", "two"));
  EXPECT_THAT(glb.texts(0, "name"), ElementsAre("\xEF\xBF\xBDx", "", ""));
  EXPECT_THAT(glb.values<std::uint8_t>(0, "some"), ElementsAre(1, 2, 2));
  EXPECT_THAT(glb.values<std::uint8_t>(0, "all"), ElementsAre(6)) << "a bit each";
  EXPECT_THAT(glb.values<std::int32_t>(0, "order"), ElementsAre(0, 1, 1));
  EXPECT_EQ(glb.values<double>(0, "ms_h_roof_70p")[1], 12.4);
}

TEST_F(Gltf, keeps_tables_at_multiples_of_eight_of_the_file) {
  const std::string bytes = written(street());
  const Glb glb(bytes);
  EXPECT_EQ((bytes.size() - glb.binary.size()) % 8, 0U);
  for (const auto& view : glb.json["bufferViews"]) EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 8, 0U);
}

TEST_F(Gltf, compressed_is_within_half_a_millimetre) {
  City city = street();
  for (auto& building : city.buildings)
    for (auto& part : building.parts)
      for (auto& vertex : part.model.solid.vertices) vertex = vertex + Point3{2000.1234, -1500.4567, 0};
  const std::string plain_bytes = written(city), packed_bytes = written(city, true);
  const Glb plain(plain_bytes), packed(packed_bytes);
  EXPECT_EQ(packed.json["extensionsRequired"], Json({"EXT_meshopt_compression", "KHR_mesh_quantization"}));
  std::size_t differing = 0;
  for (std::size_t m = 0; m < plain.json["meshes"].size(); ++m)
    for (std::size_t p = 0; p < plain.json["meshes"][m]["primitives"].size(); ++p) {
      const auto &a = plain.json["meshes"][m]["primitives"][p], &b = packed.json["meshes"][m]["primitives"][p];
      const auto at = plain.accessor<gltf::Float3>(a["attributes"]["POSITION"]);
      const auto near = packed.accessor<gltf::Float3>(b["attributes"]["POSITION"]);
      const auto normals = plain.accessor<gltf::Float3>(a["attributes"]["NORMAL"]);
      const auto shorts = packed.accessor<std::array<std::int16_t, 4>>(b["attributes"]["NORMAL"]);
      ASSERT_EQ(at.size(), near.size());
      for (std::size_t i = 0; i < at.size(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) {
          EXPECT_NEAR(at[i][axis], near[i][axis], 0.00062) << "half a step, and single precision 2 km from the origin";
          EXPECT_NEAR(normals[i][axis], static_cast<float>(shorts[i][axis]) / 32767, 1e-4);
          differing += at[i][axis] != near[i][axis] ? 1U : 0U;
        }
      EXPECT_EQ(plain.accessor<float>(a["attributes"]["_FEATURE_ID_1"]),
                packed.accessor<float>(b["attributes"]["_FEATURE_ID_1"]));
      const auto corners = plain.accessor<std::uint32_t>(a["indices"]),
                 turned = packed.accessor<std::uint32_t>(b["indices"]);
      ASSERT_EQ(corners.size(), turned.size());
      for (std::size_t i = 0; i < corners.size(); i += 3) {  // a triangle may start at another corner
        const auto same = [&](std::size_t by) {
          return corners[i] == turned[i + by] && corners[i + 1] == turned[i + (by + 1) % 3] &&
                 corners[i + 2] == turned[i + (by + 2) % 3];
        };
        EXPECT_TRUE(same(0) || same(1) || same(2));
      }
      const auto& box = packed.json["accessors"][b["attributes"]["POSITION"].get<std::size_t>()];
      gltf::Float3 least = near[0];
      for (const auto& v : near)
        for (std::size_t axis = 0; axis < 3; ++axis) least[axis] = std::min(least[axis], v[axis]);
      EXPECT_EQ(box["min"].get<gltf::Float3>(), least);
    }
  EXPECT_GT(differing, 0U);
  EXPECT_EQ(packed.texts(0, "part_id"), plain.texts(0, "part_id"));
}

TEST_F(Gltf, is_read_back_and_written_the_same) {
  for (const bool compress : {false, true}) {
    City city = street();
    city.buildings.insert(city.buildings.begin() + 1, Building{"bare", {{"a", 1.5}}, {rectangle(0, 0, 3, 3)}, 0, {}});
    const std::string bytes = written(city, compress);
    auto reader = formats::read_city(path_);
    ASSERT_TRUE(reader) << to_string(reader.error());
    EXPECT_FALSE((*reader)->has_models());
    auto back = formats::read_whole(**reader);
    ASSERT_TRUE(back) << to_string(back.error());
    ASSERT_EQ(back->buildings.size(), 3U);
    for (std::size_t b = 0; b < 3; ++b)
      for (std::size_t p = 0; p < city.buildings[b].parts.size(); ++p) {
        EXPECT_EQ(back->buildings[b].parts.at(p).plan, city.buildings[b].parts[p].plan);
        back->buildings[b].parts[p].model = city.buildings[b].parts[p].model;  // as if raised
      }
    EXPECT_EQ(written(*back, compress), bytes);
  }
}

TEST_F(Gltf, of_others_or_broken_is_refused) {
  const auto refused = [&](const std::string& bytes) -> std::string {
    EXPECT_TRUE(base::write_file(path_, bytes));
    auto reader = formats::read_city(path_);
    if (!reader) return reader.error().code;
    const auto whole = formats::read_whole(**reader);
    return whole ? "" : whole.error().code;
  };
  const std::string whole = written(street());
  EXPECT_EQ(refused(whole), "");
  EXPECT_EQ(refused(whole.substr(0, 19)), "write-read-format");
  EXPECT_EQ(refused("solid of triangles, in no way a glTF"), "write-read-format");
  const std::string json = R"({"asset":{"version":"2.0"}})"
                           "     ";
  std::string foreign("glTF\2\0\0\0\64\0\0\0\40\0\0\0JSON", 20);
  EXPECT_EQ(refused(foreign + json), "write-read-plans");
  for (std::size_t size = 0; size < whole.size(); size += 97)
    EXPECT_EQ(refused(whole.substr(0, size)), "write-read-format");
  // A length within a table that is beyond its texts.
  const Glb glb(whole);
  const auto& view = glb.json["bufferViews"][glb.property(2, "record")["stringOffsets"].get<std::size_t>()];
  std::string broken = whole;
  broken[whole.size() - glb.binary.size() + view["byteOffset"].get<std::size_t>() + 7] = 'x';
  EXPECT_EQ(refused(broken), "write-read-format");
}

}  // namespace
