// Plan + profiles, there and back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/scratch.hpp"
#include "cities.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/stream.hpp"
#include "schema.hpp"

namespace {

using namespace cities;
using Json = nlohmann::ordered_json;
using testing::HasSubstr;

class Plans : public testing::Test {
 protected:
  auto file(const std::string& text) -> std::filesystem::path {
    const auto path = folder_ / "plan.json";
    EXPECT_TRUE(mansard::base::write_file(path, text));
    return path;
  }
  auto read(const std::string& text) { return mansard::formats::read_plans(file(text)); }

  mansard::test::Scratch folder_;
};

void expect_same(const City& a, const City& b) {
  EXPECT_EQ(a.frame.origin, b.frame.origin);
  EXPECT_EQ(a.frame.crs, b.frame.crs);
  EXPECT_EQ(a.made_by.version, b.made_by.version);
  EXPECT_EQ(a.made_by.options, b.made_by.options);
  ASSERT_EQ(a.made_by.inputs.size(), b.made_by.inputs.size());
  for (std::size_t i = 0; i < a.made_by.inputs.size(); ++i) {
    EXPECT_EQ(a.made_by.inputs[i].path, b.made_by.inputs[i].path);
    EXPECT_EQ(a.made_by.inputs[i].bytes, b.made_by.inputs[i].bytes);
    EXPECT_EQ(a.made_by.inputs[i].sha256, b.made_by.inputs[i].sha256);
  }
  ASSERT_EQ(a.buildings.size(), b.buildings.size());
  for (std::size_t i = 0; i < a.buildings.size(); ++i) {
    const auto &x = a.buildings[i], &y = b.buildings[i];
    EXPECT_EQ(x.id, y.id);
    EXPECT_EQ(x.attributes, y.attributes);
    EXPECT_EQ(x.ground, y.ground);
    EXPECT_EQ(x.footprint, y.footprint);
    ASSERT_EQ(x.parts.size(), y.parts.size());
    for (std::size_t p = 0; p < x.parts.size(); ++p) {
      EXPECT_EQ(x.parts[p].id, y.parts[p].id);
      EXPECT_EQ(x.parts[p].attributes, y.parts[p].attributes);
      EXPECT_EQ(x.parts[p].plan, y.parts[p].plan);
    }
  }
}

TEST_F(Plans, come_back_as_they_were) {
  const auto city = read(mansard::formats::plans(street()));
  ASSERT_TRUE(city) << to_string(city.error());
  expect_same(street(), *city);
  EXPECT_TRUE(city->buildings[0].parts[0].model.solid.faces.empty()) << "plans only, no models";
}

TEST_F(Plans, are_the_same_text_after_a_round_trip) {
  const std::string text = mansard::formats::plans(street());
  EXPECT_EQ(mansard::formats::plans(*read(text)), text);
}

/// So many buildings of 32 kB each: more than 512 are a large file, which is read building by building.
auto many(std::size_t count, std::size_t twice = 0) -> std::string {
  auto json = Json::parse(mansard::formats::plans(street()));
  const auto house = json["buildings"][0];
  json["buildings"] = Json::array();
  for (std::size_t i = 0; i < count; ++i) {
    auto one = house;
    one["id"] = "h" + std::to_string(twice > 0 && i == twice ? 0 : i);
    one["attributes"]["note"] = std::string(32'000, '"');  // which is escaped, and doubled
    json["buildings"].push_back(std::move(one));
  }
  return json.dump();
}

TEST_F(Plans, of_a_large_file_are_those_of_a_small_one) {
  const auto large = read(many(600)), small = read(many(3));
  ASSERT_TRUE(large) << to_string(large.error());
  ASSERT_TRUE(small);
  auto first = *large;
  ASSERT_EQ(first.buildings.size(), 600U);
  EXPECT_EQ(first.buildings.back().id, "h599");
  first.buildings.resize(3);
  expect_same(first, *small);
}

TEST_F(Plans, of_a_large_file_complain_in_the_same_words) {
  EXPECT_THAT(read(many(600, 7)).error().message, HasSubstr("buildings[7].id"));
  EXPECT_EQ(read(many(600, 7)).error().message, read(many(9, 7)).error().message);
  auto cut = many(600);
  cut.resize(cut.size() - 1);
  const auto why = read(cut).error();
  EXPECT_EQ(why.code, "write-plan-json");
  EXPECT_THAT(why.message, HasSubstr("byte " + std::to_string(cut.size() + 1)));
}

TEST_F(Plans, come_back_to_the_bit_whatever_the_numbers) {
  mansard::base::Random random(11);
  const auto wild = [&] {  // any magnitude near the origin, most digits
    return random.uniform(-1, 1) * std::pow(10.0, random.uniform(-12, 4.9));
  };
  for (int round = 0; round < 50; ++round) {
    City city;
    city.frame.origin = {static_cast<std::int64_t>(random.next() >> 35U),
                         -static_cast<std::int64_t>(random.next() >> 40U), 7};
    city.frame.crs = "PROJCS[\"lo\ncal\"]";
    for (std::size_t b = random.index(4); b-- > 0;) {
      Building building;
      building.id = "ü" + std::to_string(b);
      building.ground = wild();
      building.attributes = {{"x", wild()},
                             {"n", static_cast<std::int64_t>(random.next())},
                             {"0", 3.0},
                             {"t", std::string("\"\\\n€")},
                             {"big", std::numeric_limits<std::int64_t>::min()},
                             {"no", std::monostate{}},
                             {"f", false}};
      building.footprint = {{{{wild(), wild()}, {wild(), wild()}, {wild(), wild()}}, {{{1, 1}, {wild(), 2}, {3, 3}}}}};
      for (std::size_t p = random.index(3); p-- > 0;) {
        Part part;
        part.id = building.id + "-" + std::to_string(p);
        part.plan.base = wild();
        part.plan.cap = std::abs(wild()) + 1e-9;
        for (std::size_t k = 1 + random.index(3); k-- > 0;) {
          mansard::model::Profile profile{{0, 0}};
          for (std::size_t i = 1 + random.index(4); i-- > 0;)
            profile.push_back(
                {profile.back().inward + random.uniform(0, 3), profile.back().height + random.uniform(0.01, 5)});
          part.plan.profiles.push_back(profile);
        }
        const auto ring = [&] {
          mansard::model::PlanRing out;
          for (std::size_t i = 3 + random.index(6); i-- > 0;) {
            out.points.push_back({wild(), wild()});
            out.profile_of_edge.push_back(static_cast<std::uint32_t>(random.index(part.plan.profiles.size())));
          }
          if (random.index(2) == 0)
            for (std::size_t i = 0; i < out.points.size(); ++i) out.overhang_of_edge.push_back(random.uniform(0, 3));
          return out;
        };
        part.plan.outer = ring();
        for (std::size_t h = random.index(3); h-- > 0;) part.plan.holes.push_back(ring());
        building.parts.push_back(part);
      }
      city.buildings.push_back(building);
    }
    const auto back = read(mansard::formats::plans(city));
    ASSERT_TRUE(back) << to_string(back.error());
    expect_same(city, *back);
  }
}

TEST_F(Plans, have_an_overhang_for_each_edge_or_none) {
  auto city = street();
  auto& ring = city.buildings[0].parts[0].plan.outer;
  const std::string none = mansard::formats::plans(city);
  EXPECT_EQ(none.find("overhang"), std::string::npos) << "files without overhangs are as they were";
  ring.overhang_of_edge.assign(ring.points.size(), 0.35);
  const std::string text = mansard::formats::plans(city);
  const auto back = read(text);
  ASSERT_TRUE(back) << to_string(back.error());
  EXPECT_EQ(back->buildings[0].parts[0].plan, city.buildings[0].parts[0].plan);
  const auto schema =
      mansard::base::read_file(std::filesystem::path(MANSARD_TEST_DATA) / "../../docs/plan.schema.json");
  EXPECT_EQ(schema::first_fault(Json::parse(*schema), Json::parse(text)), "");

  const auto refused = [&](const Json& overhangs) {
    Json json = Json::parse(text);
    json["buildings"][0]["parts"][0]["plan"]["outer"]["overhang_of_edge"] = overhangs;
    const auto read_back = read(json.dump());
    return read_back ? std::string() : read_back.error().message;
  };
  EXPECT_THAT(refused({0.1, 0.2}), HasSubstr("overhang_of_edge has 2 entries for 4 points"));
  EXPECT_THAT(refused({0.1, 0.2, -0.1, 0}), HasSubstr("overhang_of_edge[2]"));
  EXPECT_THAT(refused({0.1, 0.2, 0.1, 3.5}), HasSubstr("an overhang of 0 to 3 m"));
}

TEST_F(Plans, follow_the_published_schema) {
  const auto schema =
      mansard::base::read_file(std::filesystem::path(MANSARD_TEST_DATA) / "../../docs/plan.schema.json");
  ASSERT_TRUE(schema) << to_string(schema.error());
  const Json json = Json::parse(*schema);
  EXPECT_EQ(schema::first_fault(json, Json::parse(mansard::formats::plans(street()))), "");
  EXPECT_EQ(schema::first_fault(json, Json::parse(mansard::formats::plans(City{}))), "");

  // The schema is no rubber stamp: what the reader refuses, it refuses.
  Json spoilt = Json::parse(mansard::formats::plans(street()));
  spoilt["buildings"][0]["parts"][0]["plan"].erase("cap");
  EXPECT_EQ(schema::first_fault(json, spoilt), "buildings/0/parts/0/plan: cap is missing");
  spoilt = Json::parse(mansard::formats::plans(street()));
  spoilt["buildings"][0]["parts"][0]["plan"]["outer"]["points"][2] = {1};
  EXPECT_EQ(schema::first_fault(json, spoilt), "buildings/0/parts/0/plan/outer/points/2: too short");
}

TEST_F(Plans, are_refused_by_reader_and_schema_beyond_the_same_limits) {
  const auto text = mansard::base::read_file(std::filesystem::path(MANSARD_TEST_DATA) / "../../docs/plan.schema.json");
  ASSERT_TRUE(text) << to_string(text.error());
  const Json schema = Json::parse(*text);
  const std::vector<std::pair<const char*, std::pair<double, double>>> limits{
      {"/buildings/0/parts/0/plan/outer/points/2/0", {1e8, 1.0000001e8}},
      {"/buildings/0/parts/0/plan/outer/points/2/1", {-1e8, -1.0000001e8}},
      {"/buildings/0/parts/0/plan/base", {-1e8, -1.0000001e8}},
      {"/buildings/0/parts/0/plan/cap", {1e5, 1.0001e5}},
      {"/buildings/0/parts/0/plan/profiles/0/2/1", {1e6, 1.0001e6}},
      {"/buildings/0/ground", {1e8, 1.0000001e8}},
      {"/frame/origin/0", {1e9, 1.000001e9}},
      {"/frame/origin/2", {-1e9, -1.000001e9}}};
  for (const auto& [pointer, values] : limits)
    for (const bool beyond : {false, true}) {
      Json plans = Json::parse(mansard::formats::plans(street()));
      const double value = beyond ? values.second : values.first;
      Json& place = plans[Json::json_pointer(pointer)];
      if (std::string(pointer).starts_with("/frame")) place = static_cast<std::int64_t>(value);
      else place = value;
      EXPECT_EQ(schema::first_fault(schema, plans).empty(), !beyond) << pointer << " " << value;
      const auto city = read(plans.dump());
      EXPECT_EQ(city.has_value(), !beyond) << pointer << " " << value << (city ? "" : city.error().message);
    }
}

TEST_F(Plans, far_from_their_origin_get_one_near_them) {
  City city = street();
  const City near = city;
  const auto moved = [](Point2 p) { return p + Point2{1.5e7, -2e7}; };
  for (auto& building : city.buildings) {
    for (auto& polygon : building.footprint) {
      for (Point2& p : polygon.outer) p = moved(p);
      for (auto& hole : polygon.holes)
        for (Point2& p : hole) p = moved(p);
    }
    for (auto& part : building.parts) {
      for (Point2& p : part.plan.outer.points) p = moved(p);
      for (auto& hole : part.plan.holes)
        for (Point2& p : hole.points) p = moved(p);
    }
  }
  const auto back = read(mansard::formats::plans(city));
  ASSERT_TRUE(back) << to_string(back.error());
  const auto& origin = back->frame.origin;
  EXPECT_NE(origin, near.frame.origin);
  for (std::size_t b = 0; b < near.buildings.size(); ++b)
    for (std::size_t p = 0; p < near.buildings[b].parts.size(); ++p) {
      const auto &before = city.buildings[b].parts[p].plan.outer.points,
                 &now = back->buildings[b].parts[p].plan.outer.points;
      for (std::size_t i = 0; i < before.size(); ++i) {
        EXPECT_LT(std::abs(now[i].x), 1e3);
        EXPECT_EQ(now[i].x + static_cast<double>(origin[0] - near.frame.origin[0]), before[i].x);
        EXPECT_EQ(now[i].y + static_cast<double>(origin[1] - near.frame.origin[1]), before[i].y);
      }
    }
}

TEST_F(Plans, with_bad_parts_list_all_of_them_and_give_the_others) {
  Json plans = Json::parse(mansard::formats::plans(street()));
  plans["buildings"][0]["parts"][0]["plan"]["cap"] = 0;
  plans["buildings"][1]["parts"][1]["plan"]["profiles"][0][1][0] = -1;
  const auto strict = read(plans.dump());
  ASSERT_FALSE(strict);
  ASSERT_EQ(strict.errors().size(), 2U);
  EXPECT_THAT(strict.errors()[0].message, HasSubstr("buildings[0].parts[0].plan.cap"));
  EXPECT_THAT(strict.errors()[1].message, HasSubstr("buildings[1].parts[1].plan.profiles[0]"));

  auto reader = mansard::formats::read_city(file(plans.dump()));
  ASSERT_TRUE(reader);
  std::vector<mansard::base::Diagnostic> refused;
  const auto city = mansard::formats::read_whole(**reader, &refused);
  ASSERT_TRUE(city);
  EXPECT_EQ(refused, strict.errors());
  ASSERT_EQ(city->buildings.size(), 2U);
  EXPECT_TRUE(city->buildings[0].parts.empty());
  ASSERT_EQ(city->buildings[1].parts.size(), 1U);
  EXPECT_EQ(city->buildings[1].parts[0].id, "block-1");
}

TEST_F(Plans, keep_integers_beyond_64_bits_as_they_are_written) {
  Json plans = Json::parse(mansard::formats::plans(street()));
  plans["buildings"][0]["attributes"] = {{"n", 9223372036854775808ULL}, {"k", 9223372036854775807LL}};
  const auto city = read(plans.dump());
  ASSERT_TRUE(city) << to_string(city.error());
  EXPECT_EQ(city->buildings[0].attributes[0].second, mansard::model::Value(std::string("9223372036854775808")));
  EXPECT_EQ(city->buildings[0].attributes[1].second, mansard::model::Value(std::int64_t{9223372036854775807LL}));
}

TEST_F(Plans, may_be_written_by_hand_without_what_is_optional) {
  const auto city = read(R"({"type": "mansard-plan", "version": 1, "frame": {"origin": [0, 0, 0]},
    "buildings": [{"id": "a", "parts": [{"id": "a-1", "plan": {"base": 0, "cap": 10, "holes": [],
      "outer": {"points": [[0, 0], [10, 0], [10, 8], [0, 8]], "profile_of_edge": [0, 1, 0, 1]},
      "profiles": [[[0, 0], [0, 6], [4, 10]], [[0, 0], [0, 10]]]}}]}]})");
  ASSERT_TRUE(city) << to_string(city.error());
  EXPECT_EQ(city->buildings[0].parts[0].plan.outer.points[2], (Point2{10, 8}));
  EXPECT_EQ(city->buildings[0].parts[0].plan.profiles[0][2], (mansard::model::ProfilePoint{4, 10}));
}

TEST_F(Plans, that_are_missing_or_folders_or_empty_are_said_to_be) {
  EXPECT_EQ(mansard::formats::read_plans(folder_ / "none.json").error().code, "file-missing");
  EXPECT_EQ(mansard::formats::read_plans(folder_).error().code, "file-read");
  EXPECT_EQ(read("").error().code, "write-plan-json");
}

struct BadPlan {
  const char* what;
  void (*spoil)(Json&);
  const char* code;
  const char* message;
};

TEST_F(Plans, with_defects_are_refused_with_the_place_and_the_remedy) {
  const std::vector<BadPlan> cases{
      {"type", [](Json& j) { j["type"] = "FeatureCollection"; }, "write-plan-type",
       "\"type\" must be \"mansard-plan\""},
      {"no type", [](Json& j) { j.erase("type"); }, "write-plan-type", "\"type\""},
      {"version", [](Json& j) { j["version"] = 2; }, "write-plan-version", "version 2"},
      {"no version", [](Json& j) { j.erase("version"); }, "write-plan-missing", "\"version\""},
      {"no frame", [](Json& j) { j.erase("frame"); }, "write-plan-missing", "the file has no \"frame\""},
      {"no buildings", [](Json& j) { j.erase("buildings"); }, "write-plan-missing", "\"buildings\""},
      {"origin",
       [](Json& j) {
         j["frame"]["origin"] = {1, 2};
       },
       "write-plan-value", "frame.origin must be"},
      {"half metres", [](Json& j) { j["frame"]["origin"][1] = 0.5; }, "write-plan-value",
       "frame.origin[1] must be a whole"},
      {"huge", [](Json& j) { j["frame"]["origin"][1] = 18446744073709551615ULL; }, "write-plan-value",
       "frame.origin[1]"},
      {"misspelt", [](Json& j) { j["buildings"][1]["footprnt"] = 1; }, "write-plan-key", "did you mean \"footprint\"?"},
      {"unknown", [](Json& j) { j["zzzzzz"] = 1; }, "write-plan-key", "unknown member \"zzzzzz\"; take it out"},
      {"twice", [](Json& j) { j["buildings"][1]["id"] = "house"; }, "write-plan-value",
       "buildings[1].id must be an id"},
      {"part twice", [](Json& j) { j["buildings"][1]["parts"][1]["id"] = "block-1"; }, "write-plan-value",
       "buildings[1].parts[1].id"},
      {"id number", [](Json& j) { j["buildings"][0]["id"] = 5; }, "write-plan-value", "must be a text, not 5"},
      {"no cap", [](Json& j) { j["buildings"][0]["parts"][0]["plan"].erase("cap"); }, "write-plan-missing",
       "buildings[0].parts[0].plan has no \"cap\""},
      {"cap 0", [](Json& j) { j["buildings"][0]["parts"][0]["plan"]["cap"] = 0; }, "write-plan-value",
       "plan.cap must be"},
      {"base null", [](Json& j) { j["buildings"][0]["parts"][0]["plan"]["base"] = nullptr; }, "write-plan-value",
       "plan.base must be a number, not null"},
      {"point",
       [](Json& j) {
         j["buildings"][0]["parts"][0]["plan"]["outer"]["points"][2] = {1, 2, 3};
       },
       "write-plan-value", "plan.outer.points[2] must be an array of 2 numbers"},
      {"point text", [](Json& j) { j["buildings"][0]["parts"][0]["plan"]["outer"]["points"][2][1] = "NaN"; },
       "write-plan-value", "points[2][1] must be a number, not \"NaN\""},
      {"two points",
       [](Json& j) {
         j["buildings"][0]["parts"][0]["plan"]["outer"] = {{"points", {{0, 0}, {1, 1}}}, {"profile_of_edge", {0, 0}}};
       },
       "write-plan-value", "at least 3 points"},
      {"too few", [](Json& j) { j["buildings"][0]["parts"][0]["plan"]["outer"]["profile_of_edge"].erase(0); },
       "write-plan-value", "has 3 entries for 4 points"},
      {"missing profile", [](Json& j) { j["buildings"][0]["parts"][0]["plan"]["outer"]["profile_of_edge"][3] = 2; },
       "write-plan-profile", "profile_of_edge[3] names profile 2, but there are 2"},
      {"negative profile",
       [](Json& j) { j["buildings"][1]["parts"][0]["plan"]["holes"][0]["profile_of_edge"][0] = -1; },
       "write-plan-profile", "holes[0].profile_of_edge[0] names profile -1"},
      {"one point", [](Json& j) { j["buildings"][0]["parts"][0]["plan"]["profiles"][0].erase(2); }, "", ""},
      {"start",
       [](Json& j) {
         j["buildings"][0]["parts"][0]["plan"]["profiles"][0][0] = {0, 1};
       },
       "write-plan-profile", "profiles[0] must start at [0, 0]"},
      {"overhang",
       [](Json& j) {
         j["buildings"][0]["parts"][0]["plan"]["profiles"][0][2] = {-1, 9};
       },
       "write-plan-profile", "profiles[0] goes outward at point 2"},
      {"down",
       [](Json& j) {
         j["buildings"][0]["parts"][0]["plan"]["profiles"][0][2] = {1, 5};
       },
       "write-plan-profile", "profiles[0] goes down at point 2"},
      {"repeat",
       [](Json& j) {
         j["buildings"][0]["parts"][0]["plan"]["profiles"][0][2] = {0, 6};
       },
       "write-plan-profile", "profiles[0] repeats point 1"},
      {"single",
       [](Json& j) {
         j["buildings"][0]["parts"][0]["plan"]["profiles"][1] = {{0, 0}};
       },
       "write-plan-profile", "profiles[1] must have at least 2 points"},
      {"attribute",
       [](Json& j) {
         j["buildings"][0]["attributes"]["year"] = {1, 2};
       },
       "write-plan-value", "buildings[0].attributes.year must be a text"},
      {"bytes", [](Json& j) { j["made_by"]["inputs"][0]["bytes"] = -1; }, "write-plan-value",
       "made_by.inputs[0].bytes"},
      {"list", [](Json& j) { j["buildings"] = 5; }, "write-plan-value", "buildings must be an array, not 5"},
      {"root",
       [](Json& j) {
         j = Json::array({1, 2});
       },
       "write-plan-type", "type"},
  };
  for (const auto& bad : cases) {
    Json json = Json::parse(mansard::formats::plans(street()));
    bad.spoil(json);
    const auto city = read(json.dump());
    if (*bad.code == 0) {
      EXPECT_TRUE(city) << bad.what;
      continue;
    }
    ASSERT_FALSE(city) << bad.what;
    EXPECT_EQ(city.error().code, bad.code) << bad.what;
    EXPECT_THAT(city.error().message, HasSubstr(bad.message)) << bad.what;
    EXPECT_EQ(city.error().subject, (folder_ / "plan.json").string());
  }
}

TEST_F(Plans, travel_in_cityjson) {
  const auto city = read(*mansard::formats::cityjson(street()));
  ASSERT_TRUE(city) << to_string(city.error());
  expect_same(street(), *city);
}

/// As version 0.1 wrote it: no extension, footprints as LoD 0 only.
auto as_it_was(Json json) -> Json {
  for (auto& [id, object] : json["CityObjects"].items()) {
    auto& attributes = object["attributes"];
    attributes.erase("+ms_footprint");
    if (!attributes.contains("+ms_plan")) continue;
    attributes["ms_plan"] = attributes["+ms_plan"];
    attributes.erase("+ms_plan");
  }
  json["metadata"]["mansard"] = json["+mansard"]["made_by"];
  json.erase("+mansard");
  json.erase("extensions");
  return json;
}

TEST_F(Plans, travel_in_cityjson_of_version_0_1) {
  City expected = street();
  const auto city = read(as_it_was(Json::parse(*mansard::formats::cityjson(expected))).dump());
  ASSERT_TRUE(city) << to_string(city.error());
  ASSERT_EQ(city->buildings.size(), 2U);
  for (std::size_t b = 0; b < 2; ++b) {
    // Parts must agree to the bit; the footprint of LoD 0 is rounded to 0.1 mm, and the ground is its height.
    const auto &got = city->buildings[b], &want = expected.buildings[b];
    ASSERT_EQ(got.footprint.size(), want.footprint.size());
    for (std::size_t p = 0; p < want.footprint.size(); ++p)
      for (std::size_t i = 0; i < want.footprint[p].outer.size(); ++i)
        EXPECT_LT(length(got.footprint[p].outer[i] - want.footprint[p].outer[i]), 1e-4);
    EXPECT_EQ(got.footprint[0].holes.size(), want.footprint[0].holes.size());
    EXPECT_NEAR(got.ground, want.ground, 1e-4);
    expected.buildings[b].footprint = got.footprint;
    expected.buildings[b].ground = got.ground;
  }
  expect_same(expected, *city);
}

TEST_F(Plans, in_cityjson_may_have_origins_of_their_own) {
  Json json = Json::parse(*mansard::formats::cityjson(street()));
  auto& plan = json["CityObjects"]["block-2"]["attributes"]["+ms_plan"];
  plan["origin"] = {84700, 447300, 10};  // the same coordinates now lie elsewhere
  const auto city = read(json.dump());
  ASSERT_TRUE(city) << to_string(city.error());
  EXPECT_EQ(city->frame.origin, (std::array<std::int64_t, 3>{84800, 447400, 0}));
  EXPECT_EQ(city->buildings[1].parts[1].plan.outer.points[0], (Point2{-60, -100}));
  EXPECT_EQ(city->buildings[1].parts[1].plan.base, 10.5);
}

TEST_F(Plans, in_damaged_cityjson_are_refused_with_the_place) {
  const std::vector<BadPlan> cases{
      {"no plans",
       [](Json& j) {
         for (auto& [id, object] : j["CityObjects"].items()) object["attributes"].erase("+ms_plan");
       },
       "write-plan-type", "carries no plans"},
      {"no objects", [](Json& j) { j.erase("CityObjects"); }, "write-plan-missing", "\"CityObjects\""},
      {"version", [](Json& j) { j["CityObjects"]["house-1"]["attributes"]["+ms_plan"]["version"] = 9; },
       "write-plan-version", "version 9"},
      {"profile",
       [](Json& j) { j["CityObjects"]["block-2"]["attributes"]["+ms_plan"]["outer"]["profile_of_edge"][0] = 7; },
       "write-plan-profile", "CityObjects.block-2.+ms_plan.outer.profile_of_edge[0] names profile 7"},
      {"child", [](Json& j) { j["CityObjects"]["block"]["children"][0] = "gone"; }, "write-plan-value",
       "CityObjects.block.children[0]"},
      {"vertex",
       [](Json& j) {
         j = as_it_was(j);
         j["CityObjects"]["block"]["geometry"][0]["boundaries"][0][0][0] = 9999;
       },
       "write-plan-value", "boundaries[0][0][0] must be the number of a vertex"},
      {"transform", [](Json& j) { j.erase("transform"); }, "write-plan-missing", "\"transform\""},
      {"object", [](Json& j) { j["CityObjects"]["house"] = 5; }, "", ""},
      {"attribute",
       [](Json& j) {
         j["CityObjects"]["house"]["attributes"]["list"] = {1, 2};
       },
       "", ""},
      {"attributes", [](Json& j) { j["CityObjects"]["house"]["attributes"] = 1; }, "", ""},
  };
  for (const auto& bad : cases) {
    Json json = Json::parse(*mansard::formats::cityjson(street()));
    bad.spoil(json);
    const auto city = read(json.dump());
    if (*bad.code == 0) {
      EXPECT_TRUE(city) << bad.what;
      continue;
    }
    ASSERT_FALSE(city) << bad.what;
    EXPECT_EQ(city.error().code, bad.code) << bad.what;
    EXPECT_THAT(city.error().message, HasSubstr(bad.message)) << bad.what;
  }
}

TEST_F(Plans, that_are_cut_short_anywhere_are_refused) {
  const std::string text = mansard::formats::plans(street());
  for (std::size_t n = 0; n + 2 < text.size(); n += 17) {
    const auto city = read(text.substr(0, n));
    ASSERT_FALSE(city) << n;
    EXPECT_EQ(city.error().code, "write-plan-json");
  }
}

TEST_F(Plans, with_numbers_no_double_can_hold_are_refused) {
  for (const char* number : {"1e999", "NaN", "Infinity", "-1e400"}) {
    std::string text = mansard::formats::plans(street());
    const auto at = text.find("\"cap\":10");
    ASSERT_NE(at, std::string::npos);
    text.replace(at, 8, std::string("\"cap\":") + number);
    const auto city = read(text);
    ASSERT_FALSE(city) << number;
    EXPECT_EQ(city.error().code, "write-plan-json");
  }
}

}  // namespace
