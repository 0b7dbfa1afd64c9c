// Heights of what crowns hide.
#include "mansard/rays/hidden.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace mansard::rays {
namespace {

using Heights = std::vector<double>;

/// A crown that rises from 4 to 6 m.
auto crown(Heights seen) -> Heights {
  Heights all = std::move(seen);
  for (int i = 0; i <= 20; ++i) all.push_back(4 + 0.1 * i);
  std::ranges::sort(all);
  return all;
}

TEST(HiddenHeight, is_where_the_crown_rises) {
  EXPECT_NEAR(hidden_height({}, crown({})).value_or(0), 4.2, 0.11);
  EXPECT_NEAR(hidden_height(Heights{0.1, 0.2}, crown({0.1, 0.2})).value_or(0), 4, 0.2) << "ground beside it";
  EXPECT_NEAR(hidden_height(Heights{0.1, 0.2, 6}, crown({0.1, 0.2, 6})).value_or(0), 4, 0.2) << "and a wall";
}

TEST(HiddenHeight, is_none_of_what_is_seen) {
  EXPECT_FALSE(hidden_height({}, {}));
  EXPECT_FALSE(hidden_height(Heights{3.9, 4}, crown({3.9, 4}))) << "a roof";
  const Heights yard{0.1, 0.1, 0.1, 0.2, 0.2, 0.2};
  EXPECT_FALSE(hidden_height(yard, crown(yard))) << "more than a fifth of all";
}

}  // namespace
}  // namespace mansard::rays
