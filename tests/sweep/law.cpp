#include "mansard/sweep/law.hpp"

#include <gtest/gtest.h>

namespace mansard::sweep {
namespace {

auto of(double noise) -> double {
  model::Accuracy scan;
  scan.noise = noise;
  return decided_by({}, scan).line_distance;
}

TEST(SweepLaw, a_line_takes_what_noise_moves_off_it) {
  EXPECT_DOUBLE_EQ(of(0.2), 0.4);
  EXPECT_DOUBLE_EQ(of(0.0), Options{}.line_distance);  // walls have bays and frames
  EXPECT_DOUBLE_EQ(of(1.0), 0.45);                     // what is farther off is another wall
  Options asked;
  asked.line_distance = 0.8;
  EXPECT_DOUBLE_EQ(decided_by(asked, {}).line_distance, 0.8);
}

}  // namespace
}  // namespace mansard::sweep
