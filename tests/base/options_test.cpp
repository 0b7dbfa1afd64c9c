#include "mansard/base/options.hpp"

#include <gmock/gmock.h>

namespace mansard::base {
namespace {

enum class Mood { calm, wild };

struct Sample {
  bool on = false;
  std::int64_t count = 3;
  double size = 0.2;
  std::optional<double> limit;
  std::string name = "x";
  Mood mood = Mood::calm;
};

auto list_of(Sample& s) -> OptionList {
  OptionList list("sample");
  list.flag("on", s.on, "On or off.")
      .integer("count", s.count, "", {1, 10}, "How many.")
      .number("size", s.size, "m", {0.1, 5}, "How big.")
      .alias("size")
      .number("limit", s.limit, "s", {0, 100}, "How long, if at all.")
      .string("name", s.name, "What it is called.")
      .choice("mood", s.mood, {{"calm", Mood::calm}, {"wild", Mood::wild}}, "How it feels.");
  return list;
}

TEST(OptionList, shows_the_member_initialisers_as_defaults) {
  Sample s;
  const auto list = list_of(s);
  EXPECT_EQ(list.find("on")->get(), "false");
  EXPECT_EQ(list.find("count")->get(), "3");
  EXPECT_EQ(list.find("size")->get(), "0.2");
  EXPECT_EQ(list.find("limit")->get(), "");
  EXPECT_EQ(list.find("mood")->get(), "calm");
  EXPECT_EQ(list.find("size")->alias, "size");
  EXPECT_EQ(list.find("nothing"), nullptr);
}

TEST(OptionList, sets_the_members_from_text) {
  Sample s;
  const auto list = list_of(s);
  EXPECT_TRUE(list.find("on")->set("true"));
  EXPECT_TRUE(list.find("count")->set("10"));
  EXPECT_TRUE(list.find("size")->set("1.5"));
  EXPECT_TRUE(list.find("limit")->set("0"));
  EXPECT_TRUE(list.find("name")->set("a b"));
  EXPECT_TRUE(list.find("mood")->set("wild"));
  EXPECT_TRUE(s.on);
  EXPECT_EQ(s.count, 10);
  EXPECT_EQ(s.size, 1.5);
  EXPECT_EQ(s.limit, 0.0);
  EXPECT_EQ(s.name, "a b");
  EXPECT_EQ(s.mood, Mood::wild);
  EXPECT_TRUE(list.find("limit")->set(""));
  EXPECT_FALSE(s.limit.has_value());
}

TEST(OptionList, refuses_what_is_out_of_range_and_leaves_the_member_alone) {
  Sample s;
  const auto list = list_of(s);
  for (const auto& [name, value] : std::vector<std::pair<std::string, std::string>>{{"on", "yes"},
                                                                                    {"count", "11"},
                                                                                    {"count", "2.5"},
                                                                                    {"count", ""},
                                                                                    {"size", "0.05"},
                                                                                    {"size", "nan"},
                                                                                    {"size", "inf"},
                                                                                    {"size", "1m"},
                                                                                    {"limit", "-1"},
                                                                                    {"mood", "Wild"}}) {
    const auto set = list.find(name)->set(value);
    ASSERT_FALSE(set) << name << " = " << value;
    EXPECT_EQ(set.error().code, "option-value");
    EXPECT_EQ(set.error().subject, "sample." + name);
  }
  EXPECT_EQ(s.count, 3);
  EXPECT_EQ(s.size, 0.2);
  EXPECT_EQ(s.mood, Mood::calm);
  EXPECT_THAT(list.find("size")->set("9").error().message, testing::HasSubstr("from 0.1 to 5 m"));
}

TEST(NearestWord, finds_a_misspelt_word_and_nothing_for_a_strange_one) {
  const std::vector<std::string> known{"sweep.gamma", "segment.alpha", "segment.beta"};
  EXPECT_EQ(nearest_word("sweep.gama", known), "sweep.gamma");
  EXPECT_EQ(nearest_word("segment.apha", known), "segment.alpha");
  EXPECT_EQ(nearest_word("completely different", known), std::nullopt);
  EXPECT_EQ(nearest_word("", known), std::nullopt);
}

}  // namespace
}  // namespace mansard::base
