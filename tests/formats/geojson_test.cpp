// Footprints as GeoJSON: what RFC 7946 asks, as GDAL and ingest read it, and the way back.
#include <gmock/gmock.h>
#include <ogrsf_frmts.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/scratch.hpp"
#include "cities.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/stream.hpp"
#include "mansard/ingest/ingest.hpp"

namespace {

namespace model = mansard::model;

using namespace cities;
using namespace mansard::formats;
namespace base = mansard::base;
using Json = nlohmann::json;

auto folder() -> const std::filesystem::path& {
  static const mansard::test::Scratch scratch;
  return scratch;
}
auto place(const std::string& name) -> std::filesystem::path { return folder() / name; }

auto written(const model::City& city, const std::string& name = "footprints.geojson") -> std::string {
  base::Outputs outputs;
  auto writer = open_writer(Format::geojson, place(name), {city.frame, city.made_by}, {}, outputs);
  EXPECT_TRUE(writer) << base::to_string(writer.error());
  const auto done = write_city(city, **writer);
  EXPECT_TRUE(done) << base::to_string(done.error());
  const auto kept = outputs.commit();
  EXPECT_TRUE(kept) << base::to_string(kept.error());
  return *base::read_file(place(name));
}

auto area(const Json& ring) -> double {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < ring.size(); ++i)
    sum += ring[i][0].get<double>() * ring[i + 1][1].get<double>() -
           ring[i + 1][0].get<double>() * ring[i][1].get<double>();
  return sum / 2;
}

TEST(GeoJson, has_a_feature_per_part_in_longitude_and_latitude_wound_as_the_rfc_asks) {
  const Json file = Json::parse(written(street()));
  EXPECT_EQ(file["type"], "FeatureCollection");
  EXPECT_FALSE(file.contains("crs"));
  ASSERT_EQ(file["features"].size(), 3U);
  for (const auto& feature : file["features"]) {
    const auto& rings = feature["geometry"]["coordinates"];
    for (std::size_t r = 0; r < rings.size(); ++r) {
      EXPECT_EQ(rings[r].front(), rings[r].back());
      EXPECT_EQ(area(rings[r]) > 0, r == 0);
    }
    EXPECT_NEAR(rings[0][0][0].get<double>(), 4.36, 0.01) << "Delft";
    EXPECT_NEAR(rings[0][0][1].get<double>(), 52.01, 0.01);
  }
  EXPECT_EQ(file["features"][1]["geometry"]["coordinates"].size(), 2U) << "the court";
}

TEST(GeoJson, carries_the_attributes_of_building_and_part) {
  const Json file = Json::parse(written(street()));
  const auto& properties = file["features"][0]["properties"];
  EXPECT_EQ(file["features"][0]["id"], "house-1");
  EXPECT_EQ(properties["building_id"], "house");
  EXPECT_EQ(properties["part_id"], "house-1");
  EXPECT_EQ(properties["name"], "Haus \"Zur Rose\"");
  EXPECT_EQ(properties["year"], 1893);
  EXPECT_EQ(properties["ms_roof_type"], "gabled");
}

TEST(GeoJson, is_read_by_ingest_as_footprints_where_they_were) {
  for (const char* crs : {"EPSG:28992", ""}) {
    model::City city = street();
    city.frame.crs = crs;
    written(city);
    mansard::ingest::Options options;
    options.crs = crs;
    const auto scene = mansard::ingest::read_footprints(place("footprints.geojson"), options);
    ASSERT_TRUE(scene) << base::to_string(scene.error());
    ASSERT_EQ(scene->footprints.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_EQ(scene->footprints[i].polygons.size(), 1U) << crs;
      const auto& part = i == 0 ? city.buildings[0].parts[0] : city.buildings[1].parts[i - 1];
      const auto box = mansard::geometry::bounds(scene->footprints[i].polygons[0].outer);
      const auto was = mansard::geometry::bounds(part.plan.outer.points);
      EXPECT_NEAR(box.least.x + static_cast<double>(scene->frame.origin[0]), 84800 + was.least.x, 1e-3) << crs;
      EXPECT_NEAR(box.most.y + static_cast<double>(scene->frame.origin[1]), 447400 + was.most.y, 1e-3) << crs;
    }
  }
}

TEST(GeoJson, says_where_coordinates_are_metres) {
  model::City city = street();
  city.frame.crs = "";
  const Json file = Json::parse(written(city));
  EXPECT_THAT(file["mansard_coordinates"].get<std::string>(), testing::HasSubstr("not RFC 7946"));
  EXPECT_EQ(file["features"][0]["geometry"]["coordinates"][0][0], Json({84801.0625, 447402.125}));
}

TEST(GeoJson, comes_back_and_is_the_same_to_the_byte_when_written_again) {
  model::City city = street();
  city.made_by.options.emplace_back("odd", ",\"features\":[,\"mansard\":{]}");
  city.buildings[0].attributes.emplace_back("odd", std::string("},\"mansard\":{\\\""));
  city.buildings.push_back({"refused", {{"ms_outcome", std::string("refused")}}, {}, 0, {}});
  city.buildings.push_back({"covered", {}, {rectangle(60, 0, 5, 5)}, 0, {}});
  const auto text = written(city);
  auto reader = read_city(place("footprints.geojson"));
  ASSERT_TRUE(reader) << base::to_string(reader.error());
  EXPECT_FALSE((*reader)->has_models());
  const auto back = read_whole(**reader);
  ASSERT_TRUE(back) << base::to_string(back.error());
  EXPECT_EQ(plans(*back), plans(city));
  model::City raised = *back;
  for (std::size_t b = 0; b < 2; ++b)
    for (std::size_t p = 0; p < raised.buildings[b].parts.size(); ++p)
      raised.buildings[b].parts[p].model = city.buildings[b].parts[p].model;
  EXPECT_TRUE(written(raised, "again.geojson") == text);
}

TEST(GeoJson, is_refused_without_plans_or_cut_short) {
  const auto text = written(street());
  ASSERT_TRUE(base::write_files({{place("cut.geojson"), text.substr(0, text.size() - 4)}}));
  auto reader = read_city(place("cut.geojson"));
  ASSERT_TRUE(reader);
  EXPECT_EQ(read_whole(**reader).error().code, "write-read-plans");
  ASSERT_TRUE(base::write_files({{place("foreign.geojson"), "{\"type\":\"FeatureCollection\",\"features\":[]}"}}));
  EXPECT_EQ(read_city(place("foreign.geojson")).error().code, "write-read-plans");
}

TEST(GeoJson, is_refused_in_a_crs_that_leads_nowhere) {
  model::City city = street();
  city.frame.crs = "LOCAL_CS[\"mine\"]";
  base::Outputs outputs;
  const auto writer = open_writer(Format::geojson, place("nowhere.geojson"), {city.frame, {}}, {}, outputs);
  ASSERT_FALSE(writer);
  EXPECT_EQ(writer.error().code, "write-geojson");
}

}  // namespace
