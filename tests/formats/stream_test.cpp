// Cities written building by building and read back, through files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/scratch.hpp"
#include "cities.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/detail/records.hpp"
#include "mansard/formats/stream.hpp"

namespace {

using namespace cities;
using namespace mansard;
using Json = nlohmann::ordered_json;
using formats::Format;
using testing::HasSubstr;

class Stream : public testing::Test {
 protected:
  static auto ending(Format format) -> std::string {
    for (const auto& each : formats::formats())
      if (each.format == format) return std::string(each.ending);
    return {};
  }

  /// The bytes of the file, written and taken away.
  auto written(const City& city, Format format, formats::Solids solids = formats::Solids::part) -> std::string {
    formats::WriteOptions options;
    options.solids = solids;
    const auto path = folder_ / ("city" + ending(format));
    base::Outputs outputs;
    auto writer = formats::open_writer(format, path, {city.frame, city.made_by}, options, outputs);
    if (!writer) return "no writer: " + to_string(writer.error());
    const auto done = formats::write_city(city, **writer);
    if (!done) return "not written: " + to_string(done.error());
    const auto committed = outputs.commit();
    if (!committed) return "not committed: " + to_string(committed.error());
    return *base::read_file(path);
  }

  auto file(const std::string& name, const std::string& text) -> std::filesystem::path {
    EXPECT_TRUE(base::write_file(folder_ / name, text));
    return folder_ / name;
  }

  auto read(const std::string& text, Format format) -> base::Result<City> {
    auto reader = formats::read_city(file("read" + ending(format), text));
    if (!reader) return reader.error();
    return formats::read_whole(**reader);
  }

  mansard::test::Scratch folder_;
};

/// The street, on the kernel's grid of 0.1 mm like everything that the kernel makes, with a building that has no parts,
/// an outline that needs more digits than the grid has, a soffit and a slope just at the border of flat.
auto town() -> City {
  City city = street();
  Building empty;
  empty.id = "empty";
  empty.ground = 1. / 3;
  empty.attributes = {{"ms_fallback", std::string("no mesh")}, {"levels", 4.0}, {"+odd", std::int64_t{-3}}};
  empty.footprint = {rectangle(1. / 3, 100.00001, 9, 7)};
  city.buildings.push_back(empty);
  Building low{"low", {}, {rectangle(60, 0, 10, 8)}, 0, {}};
  low.parts.push_back({"low-1", plan_of(low.footprint[0], 0, 5), gable(60, 0, 10, 8, 0, 3, 3.0349), {}});
  low.parts[0].model.classes[0] = model::FaceClass::soffit;
  low.parts.push_back({"low-2", plan_of(low.footprint[0], 0, 5), gable(60, 20, 10, 8, 0, 3, 3.0350), {}});
  low.parts[1].attributes = {{"ms_h_roof_70p", 3.01}};
  city.buildings.push_back(low);
  return city;
}

TEST_F(Stream, is_the_same_bytes_as_the_whole_city) {
  EXPECT_EQ(written(town(), Format::cityjson), *formats::cityjson(town(), formats::Solids::part));
  EXPECT_EQ(written(town(), Format::plans), formats::plans(town()));
  EXPECT_EQ(written(town(), Format::obj), formats::obj(town(), "city.mtl", formats::Solids::part)->obj);
}

TEST_F(Stream, reads_back_what_is_written_as_the_same_bytes) {
  for (const auto solids : {formats::Solids::part, formats::Solids::building})
    for (const Format format : {Format::cityjson, Format::cityjsonseq, Format::plans}) {
      const std::string first = written(town(), format, solids);
      const auto city = read(first, format);
      ASSERT_TRUE(city) << to_string(city.error());
      EXPECT_EQ(written(*city, format, solids), first);
    }
}

TEST_F(Stream, reads_all_pieces_of_a_part_back) {
  City city = town();
  auto& low = city.buildings.back();
  low.solids = {{{0}, low.parts[0].model}, {{0}, gable(80, 0, 10, 8, 0, 3, 5)}, {{1}, low.parts[1].model}};
  for (const Format format : {Format::cityjson, Format::cityjsonseq}) {
    const std::string first = written(city, format);
    EXPECT_THAT(first, HasSubstr("\"low-1-piece\""));
    const auto again = read(first, format);
    ASSERT_TRUE(again) << to_string(again.error());
    const auto building = std::ranges::find(again->buildings, "low", &mansard::model::Building::id);
    ASSERT_NE(building, again->buildings.end());
    ASSERT_EQ(building->solids.size(), 3U);
    EXPECT_EQ(building->solids[1].parts, std::vector<std::size_t>{0});
    EXPECT_EQ(building->parts[0].model.solid.faces.size(), 2 * low.parts[0].model.solid.faces.size());
    EXPECT_EQ(written(*again, format), first);
  }
}

TEST_F(Stream, goes_from_any_format_with_models_to_any_other_as_if_written_at_once) {
  const std::vector<Format> all{Format::cityjson, Format::cityjsonseq, Format::plans, Format::obj};
  for (const Format from : {Format::cityjson, Format::cityjsonseq}) {
    const auto city = read(written(town(), from), from);
    ASSERT_TRUE(city) << to_string(city.error());
    for (const Format to : all) EXPECT_EQ(written(*city, to), written(town(), to));
  }
}

TEST_F(Stream, reads_plans_attributes_and_how_it_was_made_from_an_obj) {
  (void)written(town(), Format::obj);
  auto reader = formats::read_city(folder_ / "city.obj");
  ASSERT_TRUE(reader) << to_string(reader.error());
  const auto city = formats::read_whole(**reader);
  ASSERT_TRUE(city) << to_string(city.error());
  EXPECT_EQ(formats::plans(*city), formats::plans(town()));
}

TEST_F(Stream, keeps_a_reference_system_that_cityjson_cannot_name) {
  City city = town();
  city.frame.crs = "PROJCS[\"mine\"]";
  (void)written(city, Format::obj);  // its plans are in the file beside it
  for (const Format format : {Format::cityjson, Format::cityjsonseq, Format::obj, Format::plans}) {
    auto reader = formats::read_city(folder_ / "city.obj");
    ASSERT_TRUE(reader) << to_string(reader.error());
    const auto back = format == Format::obj ? formats::read_whole(**reader) : read(written(city, format), format);
    ASSERT_TRUE(back) << to_string(back.error());
    EXPECT_EQ(back->frame.crs, city.frame.crs);
    EXPECT_EQ(back->frame.origin, city.frame.origin);
  }
}

TEST_F(Stream, gives_models_back_with_classes_holes_and_unit_normals) {
  const auto city = read(written(town(), Format::cityjson), Format::cityjson);
  ASSERT_TRUE(city) << to_string(city.error());
  ASSERT_EQ(city->buildings.size(), town().buildings.size());
  for (std::size_t b = 0; b < city->buildings.size(); ++b)
    for (std::size_t p = 0; p < city->buildings[b].parts.size(); ++p) {
      const auto &got = city->buildings[b].parts[p].model, want = town().buildings[b].parts[p].model;
      EXPECT_EQ(got.classes, want.classes);
      ASSERT_EQ(got.solid.faces.size(), want.solid.faces.size());
      for (std::size_t f = 0; f < want.solid.faces.size(); ++f) {
        const auto &x = got.solid.faces[f], &y = want.solid.faces[f];
        if (want.classes[f] != model::FaceClass::soffit) {
          EXPECT_GT(dot(x.normal, y.normal), 1 - 1e-6);
        }
        ASSERT_EQ(x.loops.size(), y.loops.size());
        for (std::size_t l = 0; l < y.loops.size(); ++l) {
          ASSERT_EQ(x.loops[l].size(), y.loops[l].size());
          for (std::size_t i = 0; i < y.loops[l].size(); ++i)
            EXPECT_EQ(got.solid.vertices[x.loops[l][i]], want.solid.vertices[y.loops[l][i]]);
        }
      }
    }
}

TEST_F(Stream, writes_a_sequence_of_a_header_and_a_feature_a_line) {
  std::istringstream lines(written(town(), Format::cityjsonseq));
  std::vector<Json> all;
  for (std::string line; std::getline(lines, line);) all.push_back(Json::parse(line));
  ASSERT_EQ(all.size(), 1 + town().buildings.size());
  EXPECT_EQ(all[0]["type"], "CityJSON");
  EXPECT_EQ(all[0]["CityObjects"], Json::object());
  EXPECT_EQ(all[0]["vertices"], Json::array());
  EXPECT_EQ(all[0]["transform"]["translate"], Json({84800.0, 447400.0, 0.0}));
  EXPECT_EQ(all[0]["extensions"]["Mansard"]["version"], "1.0");
  for (std::size_t b = 1; b < all.size(); ++b) {
    EXPECT_EQ(all[b]["type"], "CityJSONFeature");
    EXPECT_EQ(all[b]["id"], town().buildings[b - 1].id);
    for (const char* of_the_file : {"transform", "version", "metadata", "extensions", "+mansard"})
      EXPECT_FALSE(all[b].contains(of_the_file)) << of_the_file;
    EXPECT_EQ(all[b]["CityObjects"].size(), 1 + town().buildings[b - 1].parts.size());
  }
}

TEST_F(Stream, tells_formats_by_what_is_in_them) {
  const auto opens = [&](const std::string& name, Format format) {
    auto reader = formats::read_city(file(name, written(town(), format)));
    return reader ? formats::read_whole(**reader)->buildings.size() : 0;
  };
  EXPECT_EQ(opens("a.json", Format::cityjson), 4U);
  EXPECT_EQ(opens("b.json", Format::cityjsonseq), 4U);
  EXPECT_EQ(opens("c.city.json", Format::plans), 4U);
  EXPECT_EQ(opens("d", Format::cityjsonseq), 4U);
}

TEST_F(Stream, refuses_what_mansard_did_not_write_with_the_place) {
  const auto code = [&](const std::string& name, const std::string& text) {
    auto reader = formats::read_city(file(name, text));
    if (!reader) return reader.error().code;
    const auto city = formats::read_whole(**reader);
    return city ? std::string("read") : city.error().code;
  };
  EXPECT_EQ(code("a.obj", "v 0 0 0\n"), "write-read-plans");
  EXPECT_EQ(code("a.city.json", R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},
    "CityObjects":{"a":{"type":"Building","geometry":[]}},"vertices":[]})"),
            "write-read-plans");
  EXPECT_EQ(code("a.stl", "solid"), "write-read-format");
  EXPECT_EQ(code("a.doc", "words"), "write-read-format");
  EXPECT_EQ(code("a.city.json", "{\"type\": \"Feature\"}"), "write-read-format");
  EXPECT_EQ(formats::read_city(folder_ / "none.city.json").error().code, "file-missing");
  EXPECT_EQ(formats::read_city(folder_ / "none.obj").error().code, "file-missing");

  std::string sequence = written(town(), Format::cityjsonseq);
  sequence.replace(sequence.find("CityJSONFeature"), 15, "CityJSONFuture!");
  const auto city = read(sequence, Format::cityjsonseq);
  ASSERT_FALSE(city);
  EXPECT_EQ(city.error().code, "write-plan-value");
  EXPECT_THAT(city.error().subject, HasSubstr("read.city.jsonl:2"));
}

TEST_F(Stream, reads_a_file_that_another_tool_moved_and_scaled) {
  Json json = Json::parse(written(town(), Format::cityjson));
  json["transform"] = {{"scale", {0.001, 0.001, 0.001}}, {"translate", {84800.5, 447400.0, 0.0}}};
  for (auto& v : json["vertices"]) v = {v[0].get<int>() / 10 - 500, v[1].get<int>() / 10, v[2].get<int>() / 10};
  const auto city = read(json.dump(), Format::cityjson);
  ASSERT_TRUE(city) << to_string(city.error());
  EXPECT_EQ(city->buildings[0].parts[0].model.solid.vertices[1].x, 11.062);
}

TEST_F(Stream, refuses_the_second_of_two_ids_and_names_it) {
  City city = town();
  city.buildings[1].id = "house";
  for (const Format format : {Format::cityjson, Format::cityjsonseq, Format::obj, Format::plans}) {
    base::Outputs outputs;
    auto writer = formats::open_writer(format, folder_ / ("twice" + ending(format)), {}, {}, outputs);
    ASSERT_TRUE(writer);
    EXPECT_TRUE((*writer)->add(city.buildings[0]));
    const auto second = (*writer)->add(city.buildings[1]);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, "write-duplicate-id");
    EXPECT_EQ(second.error().subject, "house");
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder_)) << "nothing was committed";
}

TEST(Records, are_one_line_and_come_back_to_the_bit) {
  City city = town();
  city.buildings[0].attributes.emplace_back("lines", std::string("one\ntwo\r\t\"\xE2\x82\xAC"));
  for (const Building& building : city.buildings) {
    const std::string record = formats::detail::building_record(building);
    EXPECT_EQ(record.find('\n'), std::string::npos);
    const auto back = formats::detail::read_building_record(record, "test");
    ASSERT_TRUE(back) << to_string(back.error());
    EXPECT_EQ(formats::detail::building_record(*back), record);
    EXPECT_EQ(back->attributes, building.attributes);
    EXPECT_EQ(back->footprint, building.footprint);
    ASSERT_EQ(back->parts.size(), building.parts.size());
    for (std::size_t p = 0; p < building.parts.size(); ++p) EXPECT_EQ(back->parts[p].plan, building.parts[p].plan);
  }
  const std::string record = formats::detail::header_record({city.frame, city.made_by});
  const auto header = formats::detail::read_header_record(record, "test");
  ASSERT_TRUE(header) << to_string(header.error());
  EXPECT_EQ(formats::detail::header_record(*header), record);
}

TEST(Records, are_members_of_a_file_of_plans) {
  const City city = town();
  Json file = Json::parse(formats::detail::header_record({city.frame, city.made_by}));
  for (const auto& building : city.buildings)
    file["buildings"].push_back(Json::parse(formats::detail::building_record(building)));
  EXPECT_EQ(file, Json::parse(formats::plans(city)));
}

TEST(Records, are_read_as_strictly_as_plans) {
  const auto code = [](std::string_view text) {
    const auto building = formats::detail::read_building_record(text, "test");
    return building ? std::string() : building.error().code;
  };
  EXPECT_EQ(code("{\"id\":\"a\",\"parts\":[]}"), "");
  EXPECT_EQ(code("{\"id\":\"a\""), "write-plan-json");
  EXPECT_EQ(code("{\"id\":\"a\",\"parts\":[],\"more\":1}"), "write-plan-key");
  EXPECT_EQ(code("{\"id\":\"a\"}"), "write-plan-missing");
  EXPECT_EQ(code("[]"), "write-plan-value");
  EXPECT_EQ(formats::detail::read_header_record("{\"type\":\"other\"}", "test").error().code, "write-plan-type");
  EXPECT_EQ(formats::detail::read_header_record("{\"type\":\"mansard-plan\",\"version\":2}", "test").error().code,
            "write-plan-version");
}

}  // namespace
