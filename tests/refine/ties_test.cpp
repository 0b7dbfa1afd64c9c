#include "mansard/refine/detail/ties.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "mansard/base/run.hpp"

namespace {

using mansard::refine::detail::Tie;
using mansard::refine::detail::Values;

auto equal(std::size_t a, std::size_t b) -> Tie { return {{{a, 1}, {b, -1}}, 0}; }

TEST(Ties, of_two_heights_give_their_weighed_mean_at_the_price_of_moving_both) {
  Values values;
  const auto a = values.add(5.0, 30), b = values.add(5.3, 10);
  // 30 m² move by 0.075 m and 10 m² by 0.225 m.
  EXPECT_NEAR(values.price(equal(a, b)), 30 * 0.075 * 0.075 + 10 * 0.225 * 0.225, 1e-12);
  values.hold(equal(a, b));
  EXPECT_NEAR(values[a], 5.075, 1e-12);
  EXPECT_NEAR(values[b], 5.075, 1e-12);
}

TEST(Ties, cost_nothing_where_others_imply_them_and_are_impossible_where_others_forbid_them) {
  Values values;
  const auto a = values.add(5.0, 3), b = values.add(5.3, 1), c = values.add(5.1, 2);
  values.hold(equal(a, b));
  values.hold(equal(b, c));
  EXPECT_EQ(values.price(equal(a, c)), 0);
  EXPECT_TRUE(std::isinf(values.price({{{a, 1}, {c, -1}}, 0.2})));
}

TEST(Ties, of_what_is_equal_already_cost_nothing_and_hold_from_then_on) {
  Values values;
  const auto a = values.add(5.0, 3), b = values.add(5.0, 1), c = values.add(5.4, 2);
  EXPECT_EQ(values.price(equal(a, b)), 0);
  values.hold(equal(a, b));
  values.hold(equal(b, c));
  EXPECT_NEAR(values[a], values[c], 1e-12);
}

TEST(Ties, of_pitches_let_eaves_give_way) {
  // Two planes over 5 m, sampled evenly: Σ w = 40, Σ w d = 100, Σ w d² = 1000 / 3.
  const std::array<double, 3> sums{40, 100, 1000.0 / 3};
  Values values;
  const auto a = values.add(5.0, 0.8, sums), b = values.add(5.0, 0.9, sums);
  const double price = values.price(equal(a + 1, b + 1));
  values.hold(equal(a + 1, b + 1));
  // Each turns by 0.05 about its middle, 2.5 m inward: 40 m² · 0.05² · 5² / 12.
  EXPECT_NEAR(price, 2 * 40 * 0.05 * 0.05 * 25 / 12, 1e-9);
  EXPECT_NEAR(values[a + 1], 0.85, 1e-12);
  EXPECT_NEAR(values[a], 5.0 - 0.05 * 2.5, 1e-12);
  EXPECT_NEAR(values[b], 5.0 + 0.05 * 2.5, 1e-12);
}

/// What the values cost where they are now, of those that were added in pairs.
auto cost(const Values& values, const std::vector<std::array<double, 5>>& started) -> double {
  double sum = 0;
  for (std::size_t i = 0; i < started.size(); ++i) {
    const auto& [first, second, w, d, dd] = started[i];
    const double x = values[2 * i] - first, y = values[2 * i + 1] - second;
    sum += w * x * x + 2 * d * x * y + dd * y * y;
  }
  return sum;
}

TEST(Ties, prices_add_up_to_what_the_values_cost_in_the_end) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    mansard::base::Random random(seed);
    Values values;
    std::vector<std::array<double, 5>> started;
    for (int i = 0; i < 12; ++i) {
      const double w = random.uniform(1, 50), middle = random.uniform(0.5, 5), spread = random.uniform(0.1, 3);
      started.push_back({random.uniform(4, 5), random.uniform(0.5, 1), w, w * middle, w * (middle * middle + spread)});
      const auto& s = started.back();
      values.add(s[0], s[1], {s[2], s[3], s[4]});
    }
    double sum = 0;
    std::vector<Tie> held;
    for (int k = 0; k < 15; ++k) {
      const Tie tie{{{random.index(24), 1}, {random.index(24), -random.uniform(0.5, 1.5)}}, random.uniform(-0.1, 0.1)};
      const double price = values.price(tie);
      if (std::isinf(price)) continue;
      values.hold(tie);
      sum += price;
      held.push_back(tie);
    }
    EXPECT_NEAR(cost(values, started), sum, 1e-6 * (1 + sum));
    for (const auto& tie : held) {
      double off = tie.level;
      for (const auto& term : tie.terms) off -= term.factor * values[term.value];
      EXPECT_NEAR(off, 0, 1e-7);
    }
  }
}

}  // namespace
