#include "mansard/base/statistics.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace {

using namespace mansard::base;

TEST(Median, is_the_higher_of_the_two_in_the_middle) {
  EXPECT_EQ(median(std::vector{3.0, 1.0, 2.0}), 2);
  EXPECT_EQ(median(std::vector{4.0, 1.0, 2.0, 3.0}), 3);
  EXPECT_EQ(median(std::vector{7.0F}), 7.0F);
  EXPECT_EQ(median_of_sorted(std::vector{1.0, 2.0, 3.0, 4.0}), 3);
}

TEST(Mean_median, is_the_mean_of_the_two_in_the_middle) {
  EXPECT_EQ(mean_median({3.0, 1.0, 2.0}), 2);
  EXPECT_EQ(mean_median({4.0, 1.0, 2.0, 3.0}), 2.5);
  EXPECT_EQ(mean_median_of_sorted(std::vector{1.0, 2.0, 3.0}), 2);
  EXPECT_EQ(mean_median_of_sorted(std::vector{1.0, 2.0, 3.0, 4.0}), 2.5);
}

TEST(Percentile, of_a_share_between_two_ranks_is_the_nearest_or_the_one_below) {
  const std::vector<double> values{40, 10, 30, 20, 50};
  EXPECT_EQ(percentile(values, 0), 10);
  EXPECT_EQ(percentile(values, 1), 50);
  EXPECT_EQ(percentile(values, 0.65), 40);
  EXPECT_EQ(percentile(values, 0.65, Rank::below), 30);
  EXPECT_EQ(percentile(values, 0.375), 30);  // rank 1.5: the higher of two that are as near
}

TEST(Percentile, of_sorted_values_is_that_of_the_same_values_in_any_order) {
  const std::vector<double> sorted{1, 2, 4, 8, 16, 32, 64}, mixed{64, 1, 32, 2, 16, 4, 8};
  for (int i = 0; i <= 100; ++i)
    for (const Rank rank : {Rank::nearest, Rank::below})
      EXPECT_EQ(percentile(mixed, i / 100.0, rank), percentile_of_sorted(sorted, i / 100.0, rank)) << i;
}

TEST(Percentile, by_weight_is_the_value_at_which_the_share_of_the_weight_is_reached) {
  using Weighed = std::pair<double, double>;
  const std::vector<Weighed> items{{1, 5}, {2, 1}, {3, 1}, {4, 3}};
  const auto at = [&](double share) {
    return weighted_percentile_of_sorted(items, share, &Weighed::first, &Weighed::second);
  };
  EXPECT_EQ(at(0.5), 1);
  EXPECT_EQ(at(0.55), 2);
  EXPECT_EQ(at(0.7), 3);
  EXPECT_EQ(at(1), 4);
}

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
