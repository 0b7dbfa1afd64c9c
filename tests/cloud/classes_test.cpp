// What classes are taken for, and how that is said.
#include "mansard/cloud/classes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace mansard::cloud {
namespace {

using testing::HasSubstr;

auto map_of(const char* buildings, const char* grounds = "2", const char* left_out = "") -> base::Result<ClassMap> {
  Options options;
  options.building_classes = buildings, options.ground_classes = grounds, options.left_out_classes = left_out;
  return class_map(options);
}

TEST(Classes, are_those_of_asprs_by_default) {
  const auto map = class_map({});
  ASSERT_TRUE(map);
  for (std::size_t c = 0; c < map->size(); ++c) EXPECT_EQ((*map)[c], c);
}

TEST(Classes, are_taken_for_what_the_options_say) {
  const auto map = map_of("6, 67", "66", "65");
  ASSERT_TRUE(map) << base::to_string(map.error());
  EXPECT_EQ((*map)[6], building);
  EXPECT_EQ((*map)[67], building);
  EXPECT_EQ((*map)[66], ground);
  EXPECT_EQ((*map)[2], unclassified);  // the list has it not
  EXPECT_EQ((*map)[65], noise);
  EXPECT_EQ((*map)[7], noise);
  EXPECT_EQ((*map)[18], 18);
}

TEST(Classes, that_are_none_or_in_two_lists_are_refused) {
  for (const char* wrong : {"6;67", "building", "256", "-1", "6,,67", "6.5"}) {
    const auto map = map_of(wrong);
    ASSERT_FALSE(map) << wrong;
    EXPECT_EQ(map.error().code, "option-value");
    EXPECT_EQ(map.error().subject, "cloud.building_classes");
  }
  const auto twice = map_of("6,67", "2", "67");
  ASSERT_FALSE(twice);
  EXPECT_THAT(twice.error().message, HasSubstr("class 67 is in cloud.building_classes"));
  EXPECT_TRUE(map_of(""));
}

TEST(Classes, are_told_with_their_shares_and_their_use) {
  std::array<std::uint64_t, 256> counts{};
  counts[2] = 600, counts[6] = 300, counts[67] = 90, counts[1] = 10;
  EXPECT_EQ(classes_in_words(counts, *class_map({})),
            "2 ground 60.0 % (the ground), 6 building 30.0 % (buildings), 67 9.0 % (surface where buildings are found "
            "by shape), 1 unclassified 1.0 % (surface where buildings are found by shape)");
  EXPECT_EQ(unknown_classes(counts, *class_map({})), "67 (90 points)");
  EXPECT_EQ(unknown_classes(counts, *map_of("6,67")), "");
  EXPECT_THAT(classes_in_words(counts, *map_of("6,67")), HasSubstr("67 9.0 % (buildings)"));
  EXPECT_EQ(classes_in_words({}, *class_map({})), "");
}

}  // namespace
}  // namespace mansard::cloud
