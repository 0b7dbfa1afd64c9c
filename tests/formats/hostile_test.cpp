// Files of buildings that were made to do harm, or were changed by hand without care.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>

#include "base/scratch.hpp"
#include "cities.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/stream.hpp"

namespace {

using namespace cities;
using namespace mansard;
using testing::HasSubstr;

class HostileCity : public testing::Test {
 protected:
  auto error(const std::string& name, const std::string& text) const -> base::Diagnostic {
    EXPECT_TRUE(base::write_file(folder_ / name, text));
    auto reader = formats::read_city(folder_ / name);
    if (!reader) return reader.error();
    const auto city = formats::read_whole(**reader);
    return city ? base::Diagnostic{} : city.error();
  }
  static auto deep() -> std::string {
    constexpr std::size_t levels = 1'000'000;
    return std::string(levels, '[') + std::string(levels, ']');
  }
  static auto replaced(std::string text, const std::string& what, const std::string& by) -> std::string {
    const auto at = text.find(what);
    EXPECT_NE(at, text.npos) << what;
    return text.replace(at, what.size(), by);
  }

  mansard::test::Scratch folder_;
};

TEST_F(HostileCity, json_of_a_million_levels_is_refused_by_every_reader) {
  EXPECT_EQ(error("a.json", R"({"type":"mansard-plan","version":)" + deep() + "}").code, "write-plan-json");
  EXPECT_EQ(error("a.city.json", R"({"type":"CityJSON","transform":)" + deep() + "}").code, "write-plan-json");
  const std::string head = R"({"type":"CityJSON","CityObjects":{},"transform":)" + deep() + "}";
  EXPECT_EQ(error("a.city.jsonl", head + "\n{}\n").code, "write-plan-json");
  EXPECT_EQ(error("tileset.json", R"({"root":{},"asset":{"extras":{"header":{"a":)" + deep() + "}}}}").code,
            "write-read-format");
  std::string json = R"({"asset":{"version":"2.0","extras":{"header":{"a":)" + deep() + "}}}}";
  while (json.size() % 4 != 0) json += ' ';
  std::string glb("glTF\2\0\0\0\0\0\0\0\0\0\0\0JSON", 20);
  const auto all = static_cast<std::uint32_t>(20 + json.size()), part = static_cast<std::uint32_t>(json.size());
  std::memcpy(glb.data() + 8, &all, 4);
  std::memcpy(glb.data() + 12, &part, 4);
  EXPECT_EQ(error("a.glb", glb + json).code, "write-read-format");
}

TEST_F(HostileCity, a_part_is_the_child_of_one_building_once) {
  const auto text = formats::cityjson(street());
  ASSERT_TRUE(text) << base::to_string(text.error());
  EXPECT_EQ(error("a.city.json", *text).code, "");
  const auto start = text->find("\"children\"") + 10, end = text->find(']', start);
  const std::string list = text->substr(text->find('[', start) + 1, end - text->find('[', start) - 1);
  const auto twice = error("b.city.json", replaced(*text, "[" + list + "]", "[" + list + "," + list + "]"));
  EXPECT_EQ(twice.code, "write-plan-value");
  EXPECT_THAT(twice.message, HasSubstr("named once"));
}

TEST_F(HostileCity, vertices_that_are_no_array_are_told) {
  const auto text = formats::cityjson(street());
  ASSERT_TRUE(text) << base::to_string(text.error());
  const auto at = text->find("\"vertices\"");
  ASSERT_NE(at, text->npos);
  const auto start = text->find('[', at);
  // An object of as many members: each has a place, but no number.
  const auto bent = error("a.city.json", text->substr(0, start) + R"({"a":[0,0,0]}})");
  EXPECT_EQ(bent.code, "write-plan-value");
  EXPECT_THAT(bent.message, HasSubstr("vertices must be an array"));
}

}  // namespace
