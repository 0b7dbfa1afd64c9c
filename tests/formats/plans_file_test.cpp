// JSON read from front to back, and files of plans whose buildings are read on demand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>

#include "base/scratch.hpp"
#include "cities.hpp"
#include "mansard/base/files.hpp"
#include "mansard/base/run.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/json_cursor.hpp"
#include "mansard/formats/json_list.hpp"
#include "mansard/formats/plans_file.hpp"

namespace {

using namespace cities;
using mansard::formats::JsonCursor;
using mansard::formats::JsonList;
using mansard::formats::PlansFile;
using Json = nlohmann::ordered_json;

auto is_read(const std::string& text) -> bool {
  JsonCursor json(text);
  json.skip();
  return json.done();
}

TEST(JsonCursor, takes_numbers_as_the_doubles_that_are_nearest_to_them) {
  mansard::base::Random random(3);
  std::vector<std::string> values{"0",
                                  "-0",
                                  "0.0",
                                  "-0.0",
                                  "1e22",
                                  "1e-7",
                                  "9007199254740993.0",
                                  "0.1",
                                  "1E5",
                                  "12e+3",
                                  "5e-324",
                                  "-1.5",
                                  "1.7976931348623157e308",
                                  "0.30000000000000004",
                                  "123456789012345678",
                                  "-123456789012345678",
                                  "0.0000000000000000000001"};
  for (int i = 0; i < 20'000; ++i) {
    const double value = std::bit_cast<double>(random.next());
    const auto text = mansard::base::to_text(value);
    const bool whole = text.find_first_of(".e") == std::string::npos;  // integers of more than 18 digits are refused
    if (std::isnormal(value) && !(whole && text.size() > 18)) values.push_back(text);
    values.push_back(mansard::base::to_text(random.uniform(-1e6, 1e6), static_cast<int>(random.index(18))));
  }
  for (const auto& text : values) {
    JsonCursor json(text);
    const double read = json.number();
    ASSERT_TRUE(json.done()) << text;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(read), std::bit_cast<std::uint64_t>(Json::parse(text).get<double>()))
        << text;
    JsonCursor again(text);
    const auto value = again.value();
    const auto parsed = Json::parse(text);
    if (parsed.is_number_float()) EXPECT_TRUE(std::holds_alternative<double>(value)) << text;
    else EXPECT_EQ(std::get<std::int64_t>(value), parsed.get<std::int64_t>());
  }
}

TEST(JsonCursor, takes_strings_with_their_escapes) {
  for (const std::string text : {R"("")", R"("a b")", R"("m²")", R"("\u00b2")", R"("\"\\\/\b\f\n\r\t")",
                                 R"("\ud83c\udfe0!")", R"("\uFFFF\u0041")", R"("\u0000")", "\"\xf0\x9f\x8f\xa0\""}) {
    JsonCursor json(text);
    EXPECT_EQ(json.text(), Json::parse(text).get<std::string>()) << text;
    EXPECT_TRUE(json.done()) << text;
  }
}

TEST(JsonCursor, takes_no_text_that_is_not_json) {
  for (const std::string text : {"",
                                 " ",
                                 "{",
                                 "[1,]",
                                 "[1 2]",
                                 "{\"a\":1,}",
                                 "{\"a\" 1}",
                                 "{a:1}",
                                 "1234567890123456789",
                                 "01",
                                 "-",
                                 "1.",
                                 ".5",
                                 "1e",
                                 "+1",
                                 "nul",
                                 "tru",
                                 "\"",
                                 "\"a",
                                 "\"\\x\"",
                                 "\"\\u12g4\"",
                                 R"("\ud800")",
                                 R"("\udc00")",
                                 R"("\ud800\u0041")",
                                 "\"\n\"",
                                 "\"\xff\"",
                                 "\"\xc3\"",
                                 "[1]]",
                                 "1 1",
                                 "{\"a\":1]",
                                 "[1}",
                                 "NaN",
                                 "1e999"}) {
    EXPECT_FALSE(is_read(text)) << text;
  }
  EXPECT_TRUE(is_read(R"( { "a" : [ 1 , { } , [ ] , null , true , false ] } )"));
  EXPECT_FALSE(is_read(std::string(65, '[') + std::string(65, ']')));
}

TEST(JsonCursor, takes_only_json_whatever_is_changed_in_a_text) {
  const auto good = Json::parse(mansard::formats::plans(street())).dump();
  mansard::base::Random random(5);
  std::size_t read = 0;
  for (int i = 0; i < 4000; ++i) {
    auto text = good;
    const auto at = random.index(text.size());
    constexpr std::string_view others = "{}[]\",:0e-.\\ ";
    if (random.index(2) == 0) text.erase(at, 1);
    else text[at] = others[random.index(others.size())];
    if (!is_read(text)) continue;
    ++read;
    EXPECT_TRUE(Json::accept(text)) << text;
  }
  EXPECT_GT(read, 0U);
}

class PlansFiles : public testing::Test {
 protected:
  auto file(const std::string& text) -> std::filesystem::path {
    const auto path = folder_ / ("plans" + std::to_string(count_++) + ".json");
    EXPECT_TRUE(mansard::base::write_file(path, text));
    return path;
  }
  /// Each building, and again by its place; none where the file cannot be read in this way.
  auto read(const std::string& text) -> std::optional<City> {
    const auto plans = PlansFile::open(file(text));
    if (plans == nullptr) return std::nullopt;
    std::mutex mutex;
    std::map<std::size_t, std::pair<PlansFile::Place, Building>> all;
    if (!plans->scan([&](std::size_t number, PlansFile::Place place, Building& building) {
          const std::scoped_lock lock(mutex);
          EXPECT_TRUE(all.emplace(number, std::pair(place, building)).second);
        }))
      return std::nullopt;
    City city{plans->header().frame, plans->header().made_by, {}};
    std::vector<PlansFile::Place> places;
    for (auto& [number, one] : all) {
      EXPECT_EQ(number, city.buildings.size());
      const auto again = plans->read(one.first);
      EXPECT_TRUE(again);
      city.buildings.push_back(one.second);
      places.push_back(one.first);
      if (again) city.buildings.back() = *again;
      EXPECT_EQ(city.buildings.back().attributes, one.second.attributes);
    }
    EXPECT_TRUE(plans->read(places, false, [&](std::size_t number, Building& building) {
      const auto& known = city.buildings[number];
      EXPECT_EQ(building.id, known.id);
      EXPECT_EQ(building.attributes, known.attributes);
      ASSERT_EQ(building.parts.size(), known.parts.size());
      for (std::size_t p = 0; p < known.parts.size(); ++p)
        EXPECT_EQ(building.parts[p].attributes, known.parts[p].attributes);
    }));
    return city;
  }
  mansard::test::Scratch folder_;
  int count_ = 0;
};

TEST_F(PlansFiles, have_the_buildings_that_reading_as_a_whole_gives) {
  auto city = street();
  for (int i = 0; i < 3000; ++i) {
    city.buildings.push_back(city.buildings.front());
    city.buildings.back().id = "more \"" + std::to_string(i);
  }
  const auto text = mansard::formats::plans(city);
  for (const auto& one : {text, Json::parse(text).dump(), Json::parse(text).dump(2, ' ', true)}) {
    const auto whole = mansard::formats::read_plans(file(one));
    const auto read = this->read(one);
    ASSERT_TRUE(whole);
    ASSERT_TRUE(read);
    EXPECT_EQ(mansard::formats::plans(*read), mansard::formats::plans(*whole));
  }
}

TEST_F(PlansFiles, with_something_unusual_or_wrong_are_left_to_those_who_read_them_as_a_whole) {
  const auto good = Json::parse(mansard::formats::plans(street()));
  EXPECT_TRUE(read(good.dump()));
  auto other = good;
  other["type"] = "CityJSON";
  EXPECT_FALSE(read(other.dump()));
  other = good;
  other["buildings"] = Json::array();
  EXPECT_FALSE(read(other.dump()));
  other["more"] = 1;
  EXPECT_FALSE(read(other.dump())) << "the buildings do not come last";
  other = good;
  for (auto& point : other["buildings"][0]["parts"][0]["plan"]["outer"]["points"])
    point[0] = point[0].get<double>() + 2e5;
  EXPECT_FALSE(read(other.dump())) << "far from the origin";
  other = good;
  other["buildings"][1]["parts"][0]["plan"]["cap"] = -1;
  EXPECT_FALSE(read(other.dump()));
  const auto text = good.dump();
  EXPECT_FALSE(read(text.substr(0, text.size() - 1)));
  EXPECT_FALSE(read(text + "{}"));
  EXPECT_FALSE(read(""));
  EXPECT_EQ(PlansFile::open(folder_ / "none.json"), nullptr);
  EXPECT_EQ(PlansFile::open(folder_ / "."), nullptr);
}

TEST_F(PlansFiles, are_read_as_a_whole_in_the_same_way_whatever_is_changed_in_them) {
  const auto good = Json::parse(mansard::formats::plans(street())).dump();
  mansard::base::Random random(9);
  std::size_t equal = 0;
  for (int i = 0; i < 1500; ++i) {
    auto text = good;
    const auto at = good.find("\"buildings\"") + random.index(good.size() - good.find("\"buildings\""));
    constexpr std::string_view others = "{}[]\",:0192e-.\\ x";
    if (random.index(3) == 0) text.erase(at, 1 + random.index(12));
    else text[at] = others[random.index(others.size())];
    const auto read = this->read(text);
    if (!read) continue;
    const auto whole = mansard::formats::read_plans(file(text));
    ASSERT_TRUE(whole) << text;
    EXPECT_EQ(mansard::formats::plans(*read), mansard::formats::plans(*whole)) << text;
    ++equal;
  }
  EXPECT_GT(equal, 100U);
}

TEST_F(PlansFiles, say_when_they_became_shorter) {
  const auto path = file(mansard::formats::plans(street()));
  const auto plans = PlansFile::open(path);
  ASSERT_NE(plans, nullptr);
  EXPECT_EQ(plans->read({1'000'000, 10}).error().code, "file-read");
  EXPECT_EQ(plans->read({1, 100}).error().code, "write-plan-json");
}

TEST(JsonLists, give_all_items_of_a_list_in_the_middle_of_a_file) {
  const mansard::test::Scratch folder;
  const auto path = folder / "list.json";
  Json json{{"before", {{"list", {1, 2}}}}, {"list", Json::array()}, {"after", "]}\"["}};
  for (int i = 0; i < 50'000; ++i) json["list"].push_back({{"i", i}, {"text", "]}[{\"\\"}, {"deep", {{"x", {1}}}}});
  ASSERT_TRUE(mansard::base::write_file(path, json.dump()));
  const auto list = JsonList::open(path, "list");
  ASSERT_NE(list, nullptr);
  std::mutex mutex;
  std::vector<int> seen(50'000);
  EXPECT_TRUE(list->each([&](const auto& items) {
    for (const auto& item : items) {
      const auto parsed = Json::parse(item.text);
      const std::scoped_lock lock(mutex);
      EXPECT_EQ(parsed["i"], item.number);
      ++seen[item.number];
    }
    return true;
  }));
  EXPECT_EQ(seen, std::vector<int>(50'000, 1));
  json["list"] = Json::array();
  EXPECT_EQ(Json::parse(list->head() + list->tail()), json);
  for (const std::string text : {"{}", "[[]]", R"({"list":1})", R"({"a":{"list":[]}})", "{\"list\":["}) {
    ASSERT_TRUE(mansard::base::write_file(path, text));
    const auto other = JsonList::open(path, "list");
    EXPECT_FALSE(other != nullptr && other->each([](const auto&) { return true; })) << text;
  }
}

}  // namespace
