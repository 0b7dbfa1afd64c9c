// When a part with its walls on its neighbours' lines is another building.
#include <gtest/gtest.h>

#include "mansard/extrude/extrude.hpp"
#include "mansard/pipeline/detail/block_run.hpp"
#include "mansard/profile/profile.hpp"
#include "pipeline/houses.hpp"

namespace mansard::pipeline::detail {
namespace {

auto gabled(double width, double pitch) -> model::Solid {
  auto plan = profile::vertical_plan(test::rectangle(0, 0, width, 20), 0, 30);
  plan.profiles = {{{0, 0}, {0, 6}, {1, 6 + pitch}}, {{0, 0}, {0, 30}}};
  plan.outer.profile_of_edge = {1, 0, 1, 0};
  auto raised = extrude::raise(plan);
  EXPECT_TRUE(raised);
  return std::move(raised->solid);
}

TEST(Align, walls_that_moved_by_the_tolerance_leave_the_building) {
  EXPECT_FALSE(is_another(gabled(10.05, 1), gabled(10, 1), 0.05));
  EXPECT_FALSE(is_another(gabled(9.95, 2.5), gabled(10, 2.5), 0.05));
}

TEST(Align, another_roof_is_another_building) {
  EXPECT_TRUE(is_another(gabled(10, 0.2), gabled(10, 1), 0.05));
  EXPECT_TRUE(is_another(gabled(10, 1), gabled(10, 0.2), 0.05));
}

}  // namespace
}  // namespace mansard::pipeline::detail
