#include "mansard/base/sorted.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace {

using mansard::base::commonest;

TEST(Commonest, is_the_middle_of_the_fullest_window) {
  const std::vector<double> heights{0, 0.2, 3.0, 3.1, 3.2, 9};
  EXPECT_EQ(commonest(heights, 0.5), 3.1);
}

TEST(Commonest, takes_the_lower_of_two_as_full) {
  const std::vector<double> heights{1, 1.1, 5, 5.1};
  EXPECT_EQ(commonest(heights, 0.5), 1.1);
}

TEST(Commonest, of_one_value_is_that) { EXPECT_EQ(commonest(std::vector<double>{7}, 0.5), 7); }

}  // namespace
