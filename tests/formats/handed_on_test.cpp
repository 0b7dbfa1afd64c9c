// What a city hands on: levels of detail, chosen attributes, and formats that other programs read.
#include <gmock/gmock.h>
#include <ogrsf_frmts.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "base/scratch.hpp"
#include "mansard/base/files.hpp"
#include "mansard/crs/gdal.hpp"
#include "mansard/formats/attribute_choice.hpp"
#include "mansard/formats/foreign.hpp"
#include "mansard/formats/levels.hpp"
#include "mansard/formats/stream.hpp"
#include "mansard/solid/solid.hpp"
#include "painted.hpp"
#include "val3dity_rules.hpp"

namespace {

using namespace cities;
using namespace mansard;
using formats::Format;
using Json = nlohmann::json;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using enum formats::Lod;

class HandedOn : public testing::Test {
 protected:
  auto write(const City& city, Format format, const std::string& name, const formats::WriteOptions& options = {})
      -> base::Result<std::filesystem::path> {
    base::Outputs outputs;
    const auto path = folder_ / name;
    auto writer = formats::open_writer(format, path, {city.frame, city.made_by}, options, outputs);
    if (!writer) return writer.error();
    if (auto done = formats::write_city(city, **writer); !done) return done.error();
    if (auto kept = outputs.commit(); !kept) return kept.error();
    return path;
  }
  auto bytes(const City& city, Format format, const std::string& name, const formats::WriteOptions& options = {})
      -> std::string {
    const auto path = write(city, format, name, options);
    return path ? *base::read_file(*path) : to_string(path.error());
  }
  static auto open(const std::filesystem::path& path) -> GDALDatasetUniquePtr {
    crs::register_gdal();
    return GDALDatasetUniquePtr(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY));
  }

  mansard::test::Scratch folder_;
};

/// A gabled house with a chimney of 1 m² on its roof and a tower of 12 m beside it, as one building.
auto house_with_chimney() -> City {
  City city = street();
  city.buildings.resize(1);
  auto& building = city.buildings[0];
  const Polygon tower = rectangle(11.0625, 2.125, 4, 8);
  building.parts.push_back({"house-2", plan_of(tower, 1.25, 12), prism(tower, 1.25, 13.25), {}});
  const Polygon chimney = rectangle(4, 3.5, 1, 1);
  building.parts.push_back({"house-3", plan_of(chimney, 1.25, 12), prism(chimney, 1.25, 12.25), {}});
  return city;
}

auto lods_in(const Json& file) -> std::set<std::string> {
  std::set<std::string> out;
  for (const auto& object : file["CityObjects"])
    if (object.contains("geometry"))
      for (const auto& geometry : object["geometry"]) out.insert(geometry["lod"].get<std::string>());
  return out;
}

TEST(Lods, of_a_text_are_those_of_the_format_or_of_all_formats) {
  EXPECT_THAT(*formats::lods_of("", Format::cityjson), ElementsAre(lod0, lod12, lod13, lod22));
  EXPECT_THAT(*formats::lods_of("2.2, 1.2", Format::cityjson), ElementsAre(lod12, lod22));
  EXPECT_THAT(*formats::lods_of("1.2;cityjson=2.0", Format::cityjson), ElementsAre(lod20));
  EXPECT_THAT(*formats::lods_of("1.2;cityjson=2.0", Format::geopackage), ElementsAre(lod12));
  EXPECT_THAT(*formats::lods_of("0,1.2,1.3", Format::obj), ElementsAre(lod13)) << "the finest, where there is one";
  EXPECT_THAT(*formats::lods_of("0", Format::obj), ElementsAre(lod22)) << "none of these fits";
}

TEST(Lods, that_are_unknown_or_too_many_are_refused) {
  for (const char* text : {"3.0", "cityjson=1.4", "no_format=1.2", "obj=0", "obj=1.2,2.2", "1,2"}) {
    const auto known = formats::check_lods(text);
    ASSERT_FALSE(known) << text;
    EXPECT_EQ(known.error().code, "option-value") << text;
    EXPECT_THAT(known.error().message, HasSubstr("expected levels")) << text;
  }
}

TEST_F(HandedOn, cityjson_has_the_levels_that_were_asked_for) {
  EXPECT_THAT(lods_in(Json::parse(bytes(street(), Format::cityjson, "a.city.json"))),
              ElementsAre("0", "1.2", "1.3", "2.2"));
  formats::WriteOptions options;
  options.lod = "1.3,2.0";
  const auto file = Json::parse(bytes(street(), Format::cityjson, "b.city.json", options));
  EXPECT_THAT(lods_in(file), ElementsAre("1.3", "2.0"));
  EXPECT_EQ(file["+mansard"]["solids"], "none");
}

TEST_F(HandedOn, a_cityjson_without_the_finest_level_comes_back_with_its_plans) {
  formats::WriteOptions options;
  options.lod = "1.2";
  const auto path = write(street(), Format::cityjson, "b.city.json", options);
  auto reader = formats::read_city(*path);
  ASSERT_TRUE(reader) << to_string(reader.error());
  EXPECT_FALSE((*reader)->has_solids());
  EXPECT_FALSE((*reader)->has_models());
  const auto city = formats::read_whole(**reader);
  ASSERT_TRUE(city);
  EXPECT_EQ(city->buildings[0].parts[0].plan, street().buildings[0].parts[0].plan);
}

TEST_F(HandedOn, every_level_is_valid_and_simpler_than_the_next_finer_one) {
  formats::WriteOptions options;
  options.lod = "0,1.2,1.3,2.0,2.2";
  const auto file = Json::parse(bytes(house_with_chimney(), Format::cityjson, "c.city.json", options));
  for (const auto& finding : val3dity::findings(file)) ADD_FAILURE() << finding.code << " " << finding.what;
  std::map<std::string, std::size_t> faces;
  for (const auto& geometry : file["CityObjects"]["house"]["geometry"])
    if (geometry["type"] == "Solid") faces[geometry["lod"].get<std::string>()] = geometry["boundaries"][0].size();
  ASSERT_THAT(faces, testing::SizeIs(4));
  EXPECT_LT(faces["1.2"], faces["1.3"]);
  EXPECT_LE(faces["1.3"], faces["2.0"]);
  EXPECT_LT(faces["2.0"], faces["2.2"]);
}

TEST_F(HandedOn, levels_of_a_building_have_the_volumes_of_their_shapes) {
  const auto city = house_with_chimney();
  const auto levels = formats::levels_of(city.buildings[0], city.frame, {});
  ASSERT_THAT(levels, testing::SizeIs(1));
  const auto volume = [&](formats::Lod lod) { return solid::volume(levels[0].at(lod).solid); };
  const double house = 10 * 8 * 6 + 10 * 8 * 4 / 2., tower = 4 * 8 * 12;
  EXPECT_NEAR(volume(lod20), house + tower, 1e-2);
  EXPECT_GT(volume(lod22), volume(lod20));
  EXPECT_NEAR(volume(lod13), 10 * 8 * (6 + 0.7 * 4) + tower, 1e-2);
}

TEST_F(HandedOn, roof_surfaces_have_their_heights) {
  const auto file = Json::parse(bytes(street(), Format::cityjson, "a.city.json"));
  std::vector<Json> roofs;
  for (const auto& geometry : file["CityObjects"]["house"]["geometry"])
    if (geometry["lod"] == "2.2")
      for (const auto& surface : geometry["semantics"]["surfaces"])
        if (surface["type"] == "RoofSurface") roofs.push_back(surface);
  ASSERT_EQ(roofs.size(), 2U);
  EXPECT_EQ(roofs[0]["ms_h_roof_min"], 7.25);
  EXPECT_EQ(roofs[0]["ms_h_roof_max"], 11.25);
  EXPECT_NEAR(roofs[0]["ms_h_roof_50p"].get<double>(), 9.25, 1e-4);
}

TEST_F(HandedOn, metadata_are_those_that_were_given) {
  formats::WriteOptions options;
  options.title = "Two houses";
  options.date = "2026-11-23";
  options.contact = "Survey office <office@example.org>";
  options.lineage = "By hand";
  const auto file = Json::parse(bytes(street(), Format::cityjson, "a.city.json", options));
  EXPECT_EQ(file["metadata"]["title"], "Two houses");
  EXPECT_EQ(file["metadata"]["referenceDate"], "2026-11-23");
  EXPECT_EQ(file["metadata"]["pointOfContact"],
            Json({{"contactName", "Survey office"}, {"emailAddress", "office@example.org"}}));
  EXPECT_EQ(file["+mansard"]["lineage"], "By hand");
  for (const char* contact : {"nobody", "a <b>", "<a@b>"}) {
    options.contact = contact;
    EXPECT_THAT(bytes(street(), Format::cityjson, "b.city.json", options), HasSubstr("write.contact")) << contact;
  }
  options.contact.clear();
  options.date = "23.11.2026";
  EXPECT_THAT(bytes(street(), Format::cityjson, "b.city.json", options), HasSubstr("write.date"));
}

TEST_F(HandedOn, the_extension_has_an_absolute_url) {
  const auto file = Json::parse(bytes(street(), Format::cityjson, "a.city.json"));
  EXPECT_THAT(file["extensions"]["Mansard"]["url"].get<std::string>(), testing::StartsWith("https://"));
}

TEST(AttributeChoice, writes_the_sources_and_those_that_were_chosen) {
  const model::Attributes all{
      {"name", std::string("x")}, {"ms_h_ground", 1.5}, {"ms_h_roof_max", 9.5}, {"ms_ridges", std::int64_t{1}}};
  const auto names = [&](std::string_view text) {
    std::vector<std::string> out;
    for (const auto& [name, value] : formats::AttributeChoice::of(text)->chosen(all)) out.push_back(name);
    return out;
  };
  EXPECT_THAT(names("all"), ElementsAre("name", "ms_h_ground", "ms_h_roof_max", "ms_ridges"));
  EXPECT_THAT(names("none"), ElementsAre("name"));
  EXPECT_THAT(names("3dbag"), ElementsAre("name", "b3_h_maaiveld", "b3_h_dak_max", "b3_n_nok"));
  EXPECT_THAT(names("roofer"), ElementsAre("name", "rf_h_ground", "rf_h_roof_max", "rf_ridgelines"));
  EXPECT_THAT(names("ms_h_roof_max=top, ms_h_ground"), ElementsAre("name", "ms_h_ground", "top"));
}

TEST(AttributeChoice, refuses_names_that_it_does_not_compute) {
  for (const char* text :
       {"height", "ms_h_ground=", "ms_h_ground,ms_h_ground", "ms_h_ground=a,ms_h_roof_max=a", "3DBAG"}) {
    const auto choice = formats::AttributeChoice::of(text);
    ASSERT_FALSE(choice) << text;
    EXPECT_EQ(choice.error().subject, "write.attributes");
  }
}

TEST_F(HandedOn, says_which_chosen_attributes_no_building_has) {
  formats::WriteOptions options;
  const auto told = [&](const char* text) {
    options.attributes = text;
    base::Outputs outputs;
    const auto city = street();
    auto writer =
        formats::open_writer(Format::cityjson, folder_ / "c.city.json", {city.frame, city.made_by}, options, outputs);
    EXPECT_TRUE(formats::write_city(city, **writer));
    std::vector<std::string> out;
    for (const auto& warning : (*writer)->warnings()) out.push_back(warning.code + " " + warning.message.substr(0, 43));
    return out;
  };
  EXPECT_THAT(told("ms_h_grund"), ElementsAre("write-attribute-missing no building has the attribute 'ms_h_grund';"));
  EXPECT_THAT(told("3dbag"), testing::IsEmpty());
  EXPECT_THAT(told("all"), testing::IsEmpty());
}

TEST_F(HandedOn, attributes_are_chosen_in_every_format) {
  City city = street();
  city.buildings[0].attributes.emplace_back("ms_h_ground", 1.25);
  formats::WriteOptions options;
  options.attributes = "3dbag";
  const auto file = Json::parse(bytes(city, Format::cityjson, "a.city.json", options));
  EXPECT_EQ(file["CityObjects"]["house"]["attributes"]["b3_h_maaiveld"], 1.25);
  EXPECT_FALSE(file["CityObjects"]["house"]["attributes"].contains("ms_h_ground"));
  EXPECT_EQ(file["CityObjects"]["house"]["attributes"]["year"], 1893);
  EXPECT_THAT(bytes(city, Format::citygml, "a.gml", options), HasSubstr("b3_h_maaiveld"));
}

TEST_F(HandedOn, no_line_of_an_obj_is_too_long_for_importers) {
  City city = street();
  auto& plan = city.buildings[0].parts[0].plan;
  for (int i = 0; i < 5000; ++i) plan.profiles.push_back({{0, 0}, {0, 1.0 + i}});
  for (int i = 0; i < 700; ++i)
    city.made_by.inputs.push_back({"tile-" + std::to_string(i) + std::string(2000, 'x'), 1, "ab"});
  city.frame.crs = std::string(5000, 'w');
  std::istringstream text(bytes(city, Format::obj, "a.obj"));
  std::size_t longest = 0, lines = 0;
  for (std::string line; std::getline(text, line); ++lines) longest = std::max(longest, line.size());
  EXPECT_GT(lines, 50U);
  EXPECT_LT(longest, 1000U);
  auto reader = formats::read_city(folder_ / "a.obj");
  ASSERT_TRUE(reader) << to_string(reader.error());
  EXPECT_EQ((*reader)->header().made_by.inputs.size(), city.made_by.inputs.size());
  EXPECT_EQ(formats::read_whole(**reader)->buildings[0].parts[0].plan, plan);
}

TEST_F(HandedOn, an_obj_can_have_y_up_and_coordinates_from_the_origin) {
  formats::WriteOptions options;
  options.obj_up = formats::UpAxis::y;
  options.obj_local = true;
  const auto text = bytes(street(), Format::obj, "a.obj", options);
  EXPECT_THAT(text, HasSubstr("# up y\n# origin 84800 447400 0\n"));
  EXPECT_THAT(text, HasSubstr("v 1.0625 1.25 -2.125\n"));
  EXPECT_THAT(bytes(street(), Format::obj, "b.obj"), HasSubstr("v 84801.0625 447402.125 1.25\n"));
}

TEST_F(HandedOn, citygml_has_every_building_with_its_surfaces_in_both_versions) {
  for (const auto version : {formats::CityGml::v2, formats::CityGml::v3}) {
    formats::WriteOptions options;
    options.citygml = version;
    const auto text = bytes(street(), Format::citygml, "a.gml", options);
    const auto count = [&](const std::string& word) {
      std::size_t n = 0;
      for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++n;
      return n;
    };
    EXPECT_EQ(count("<bldg:Building "), 2U);
    EXPECT_EQ(count("RoofSurface gml:id"), 4U);
    EXPECT_GT(count("xlink:href=\"#"), 10U);
    EXPECT_EQ(count("xlink:href=\"#"),
              count("gml:MultiSurface gml:id=\"house_s") + count("gml:MultiSurface gml:id=\"block_s"));
    EXPECT_THAT(text, HasSubstr("Haus &quot;Zur Rose&quot;"));
    EXPECT_THAT(text, HasSubstr("<gml:lowerCorner>84801.0625 447400.0 0.5</gml:lowerCorner>"));
    EXPECT_THAT(text, HasSubstr("srsName=\"EPSG:28992\""));
  }
}

TEST_F(HandedOn, citygml_ids_are_identifiers_and_stay_apart) {
  City city = street();
  city.buildings[0].id = "1 a";
  city.buildings[1].id = "1_a";
  const auto text = bytes(city, Format::citygml, "a.gml");
  EXPECT_THAT(text, HasSubstr("gml:id=\"_1_a_n0\""));
  EXPECT_THAT(text, HasSubstr("gml:id=\"_1_a_n1\""));
  EXPECT_THAT(text, HasSubstr("<gml:name>1 a</gml:name>"));
}

TEST_F(HandedOn, gdal_reads_citygml_with_its_attributes_and_appearance_however_much_is_said_of_the_run) {
  auto city = painted_street();
  for (int i = 0; i < 200; ++i) city.made_by.options.emplace_back("module.option_" + std::to_string(i), "some value");
  for (const auto version : {formats::CityGml::v2, formats::CityGml::v3}) {
    formats::WriteOptions options;
    options.citygml = version;
    const auto path = write(city, Format::citygml, version == formats::CityGml::v2 ? "2.gml" : "3.gml", options);
    ASSERT_TRUE(path);
    const auto file = open(*path);
    ASSERT_NE(file, nullptr);
    GIntBig buildings = 0, years = 0;
    for (auto* layer : file->GetLayers()) {
      if (std::string_view(layer->GetName()) != "Building") continue;
      buildings = layer->GetFeatureCount();
      for (const auto& feature : layer) {
        const int year = feature->GetFieldIndex("year");
        if (year >= 0 && feature->GetFieldAsInteger(year) == 1893) ++years;
      }
    }
    EXPECT_EQ(buildings, 2);
    EXPECT_EQ(years, version == formats::CityGml::v2 ? 1 : 0) << "GDAL 3.6 does not know the solids of GML 3.2";
  }
}

TEST_F(HandedOn, gdal_reads_dxf_as_a_face_for_every_triangle_in_its_layer) {
  const auto path = write(street(), Format::dxf, "a.dxf");
  ASSERT_TRUE(path) << to_string(path.error());
  const auto file = open(*path);
  ASSERT_NE(file, nullptr);
  std::map<std::string, int> layers;
  double highest = -1e9;
  for (const auto& feature : *file->GetLayer(0)) {
    ++layers[feature->GetFieldAsString("Layer")];
    OGREnvelope3D box;
    feature->GetGeometryRef()->getEnvelope(&box);
    highest = std::max(highest, box.MaxZ);
  }
  EXPECT_EQ(layers["roof"], 2 * 2 + 10) << "two slopes, and what is left of the court and the annex";
  EXPECT_GT(layers["wall"], 0);
  EXPECT_GT(layers["ground"], 0);
  EXPECT_NEAR(highest, 12.5, 1e-9);
}

TEST_F(HandedOn, gdal_reads_flatgeobuf_with_the_attributes_of_buildings) {
  const auto path = write(street(), Format::flatgeobuf, "a.fgb");
  ASSERT_TRUE(path) << to_string(path.error());
  const auto file = open(*path);
  ASSERT_NE(file, nullptr);
  OGRLayer& layer = *file->GetLayer(0);
  EXPECT_EQ(layer.GetFeatureCount(), 2);
  EXPECT_STREQ(layer.GetSpatialRef()->GetAuthorityCode(nullptr), "28992");
  std::map<std::string, std::int64_t> years;
  for (const auto& feature : layer)
    years[feature->GetFieldAsString("building_id")] = feature->GetFieldAsInteger64("year");
  EXPECT_EQ(years["house"], 1893);
}

/// A house by somebody else: LoD 1 and 2, semantics, a part, an attribute that is no plain value.
constexpr const char* foreign_house = R"({"type":"CityJSON","version":"2.0",
"transform":{"scale":[0.001,0.001,0.001],"translate":[100000,400000,0]},
"metadata":{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/28992"},
"CityObjects":{
 "h":{"type":"Building","attributes":{"year":1900,"owner":{"name":"x"}},"children":["p"],
  "geometry":[{"type":"Solid","lod":"2.2","boundaries":[[[[0,3,2,1]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]],[[4,5,6,7]]]],
   "semantics":{"surfaces":[{"type":"GroundSurface"},{"type":"WallSurface"},{"type":"RoofSurface"}],"values":[[0,1,1,1,1,2]]}},
   {"type":"Solid","lod":"1","boundaries":[[[[0,3,2,1]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]],[[4,5,6,7]]]]}]},
 "p":{"type":"BuildingPart","parents":["h"],"attributes":{"use":"shed"},
  "geometry":[{"type":"MultiSurface","lod":"2.2","boundaries":[[[8,9,10]],[[8,8,9]]]}]},
 "road":{"type":"Road","geometry":[]}},
"vertices":[[0,0,0],[10000,0,0],[10000,8000,0],[0,8000,0],[0,0,5000],[10000,0,5000],[10000,8000,5000],[0,8000,5000],
[20000,0,1000],[21000,0,1000],[21000,1000,1000]]})";

class Foreign : public HandedOn {
 protected:
  auto foreign(const std::string& text) -> base::Result<formats::ForeignCity> {
    const auto path = folder_ / "theirs.city.json";
    EXPECT_TRUE(base::write_file(path, text));
    return formats::read_foreign(path);
  }
};

TEST_F(Foreign, models_come_with_their_finest_level_and_their_attributes) {
  const auto read = foreign(foreign_house);
  ASSERT_TRUE(read) << to_string(read.error());
  ASSERT_EQ(read->city.buildings.size(), 1U);
  const auto& building = read->city.buildings[0];
  EXPECT_EQ(building.id, "h");
  EXPECT_EQ(building.attributes[0], (std::pair<std::string, model::Value>{"year", std::int64_t{1900}}));
  EXPECT_EQ(building.attributes[1].second, model::Value(std::string(R"({"name":"x"})")));
  ASSERT_EQ(building.parts.size(), 2U);
  EXPECT_NEAR(solid::volume(building.parts[0].model.solid), 400, 1e-9);
  EXPECT_EQ(building.parts[0].model.classes[5], FaceClass::roof);
  EXPECT_EQ(building.parts[1].model.solid.faces.size(), 1U) << "a surface without area is left out";
  EXPECT_EQ(read->city.frame.crs, "EPSG:28992");
  EXPECT_NEAR(geometry::area(building.footprint.at(0)), 80, 1e-9) << "the ground, since there is no LoD 0";
  EXPECT_EQ(read->lods, "2.2");
  std::vector<std::string> said;
  for (const auto& warning : read->warnings) said.push_back(warning.message);
  EXPECT_THAT(said, Contains(HasSubstr("1 objects of the type Road")));
  EXPECT_THAT(said, Contains(HasSubstr("1 faces have no area")));
}

TEST_F(Foreign, models_go_to_every_format_that_needs_no_plans) {
  const auto read = foreign(foreign_house);
  ASSERT_TRUE(read);
  for (const auto& format : formats::formats()) {
    if (!formats::takes_foreign(format.format)) continue;
    const auto path = write(read->city, format.format, "out" + std::string(format.ending));
    EXPECT_TRUE(path) << format.name << ": " << (path ? "" : to_string(path.error()));
    if (!path || format.format == Format::tiles) continue;
    EXPECT_GT(std::filesystem::file_size(*path), 100U) << format.name;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.plans.jsonl"));
  EXPECT_THAT(*base::read_file(folder_ / "out.obj"), HasSubstr("o h\n"));
  EXPECT_THAT(*base::read_file(folder_ / "out.gml"), HasSubstr("<gen:name>year</gen:name>"));
  EXPECT_THAT(*base::read_file(folder_ / "out.glb"), HasSubstr("\"year\":1900"));
  EXPECT_FALSE(formats::read_city(folder_ / "out.gpkg"));
}

TEST_F(Foreign, files_that_are_broken_are_refused_with_a_reason) {
  for (const char* text :
       {"", "{", "[]", R"({"type":"CityJSON","version":"2.0"})",
        R"({"type":"CityJSON","version":"2.0","CityObjects":{},"vertices":[]})", R"({"type":"FeatureCollection"})"}) {
    const auto read = foreign(text);
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().code, "ingest-model-format") << text;
  }
  // Corners that are missing, numbers that are none: the rest is taken.
  std::string odd = foreign_house;
  odd.replace(odd.find("[[0,1,5,4]]"), 11, "[[0,1,5,99]]");
  const auto read = foreign(odd);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->city.buildings[0].parts[0].model.solid.faces.size(), 5U);
}

TEST_F(Foreign, real_models_of_other_producers_are_taken) {
  const std::filesystem::path shared = MANSARD_SHARED_DATA;
  std::size_t files = 0;
  for (const char* folder : {"zurich", "denhaag"}) {
    std::error_code status;
    for (const auto& entry : std::filesystem::directory_iterator(shared / folder, status)) {
      if (entry.path().extension() != ".json") continue;
      const auto read = formats::read_foreign(entry.path());
      ASSERT_TRUE(read) << entry.path() << to_string(read.error());
      ++files;
      for (const Format format : {Format::glb, Format::geopackage, Format::citygml, Format::obj})
        EXPECT_TRUE(write(read->city, format, entry.path().stem().string() + std::to_string(static_cast<int>(format))));
    }
  }
  if (files == 0) GTEST_SKIP() << "no shared data";
}

}  // namespace
