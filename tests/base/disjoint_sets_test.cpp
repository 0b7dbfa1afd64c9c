#include "mansard/base/disjoint_sets.hpp"

#include <gtest/gtest.h>

namespace {

using mansard::base::DisjointSets;

TEST(Disjoint_sets, are_named_by_their_lowest_number_whatever_the_order_of_joins) {
  DisjointSets one(5), other(5);
  one.join(4, 2), one.join(2, 1);
  other.join(1, 2), other.join(4, 1);
  for (DisjointSets* sets : {&one, &other}) {
    EXPECT_EQ(sets->of(4), 1U);
    EXPECT_EQ(sets->of(2), 1U);
    EXPECT_EQ(sets->of(0), 0U);
    EXPECT_EQ(sets->of(3), 3U);
  }
}

TEST(Disjoint_sets, that_grow_have_each_further_number_alone) {
  DisjointSets sets;
  EXPECT_EQ(sets.grow(), 0U);
  EXPECT_EQ(sets.grow(), 1U);
  EXPECT_EQ(sets.of(1), 1U);
  sets.join(0, 1);
  EXPECT_EQ(sets.grow(), 2U);
  EXPECT_EQ(sets.of(1), 0U);
  EXPECT_EQ(sets.of(2), 2U);
}

}  // namespace
