#include <gtest/gtest.h>

#include <string>

#include "mansard/base/nesting.hpp"

namespace {

using mansard::base::deepest_json;
using mansard::base::nests_too_deep;

TEST(Nesting, counts_arrays_and_objects_in_one_another) {
  const std::string open(deepest_json, '['), close(deepest_json, ']');
  EXPECT_FALSE(nests_too_deep(open + close));
  EXPECT_TRUE(nests_too_deep("[" + open));
  EXPECT_TRUE(nests_too_deep("{\"a\":" + open + close + "}"));
}

TEST(Nesting, may_be_held_to_less) {
  EXPECT_FALSE(nests_too_deep("[{}]", 2));
  EXPECT_TRUE(nests_too_deep("[{}]", 1));
}

TEST(Nesting, is_not_that_of_neighbours) {
  std::string many;
  for (std::size_t i = 0; i < 3 * deepest_json; ++i) many += "[{}],";
  EXPECT_FALSE(nests_too_deep(many));
}

TEST(Nesting, does_not_count_what_is_in_strings) {
  const std::string brackets(2 * deepest_json, '[');
  EXPECT_FALSE(nests_too_deep("[\"" + brackets + "\"]"));
  EXPECT_FALSE(nests_too_deep(R"(["\")" + brackets + "\"]"));
  EXPECT_TRUE(nests_too_deep(R"(["\\")" + brackets));
  // A line break ends what never was a string, so that the lines after it are seen.
  EXPECT_TRUE(nests_too_deep("\"\n" + brackets));
}

}  // namespace
