// The tables of the normal curve against the library's functions.
#include "mansard/refine/detail/normal_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using mansard::refine::detail::normal_curve;

TEST(NormalCurve, agrees_with_erfc_and_exp) {
  for (double x = -7; x < 7; x += 0.00137) {
    EXPECT_NEAR(normal_curve.below(x), 0.5 * std::erfc(-x / std::numbers::sqrt2), 2e-9) << x;
    EXPECT_NEAR(normal_curve.density(x), std::exp(-x * x / 2) / std::sqrt(2 * std::numbers::pi), 1e-8) << x;
  }
}

TEST(NormalCurve, is_exact_in_the_middle_and_symmetric) {
  EXPECT_EQ(normal_curve.below(0), 0.5);
  for (const double x : {0.25, 1.0, 2.5}) EXPECT_EQ(normal_curve.below(x) + normal_curve.below(-x), 1);
}

}  // namespace
