// Parapets: strips around a part that are higher than the roof within.
#include "mansard/refine/detail/rims.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "judged_by_scan.hpp"

namespace {

using namespace scans;
namespace detail = refine::detail;

constexpr double level = 6;  // m above the ground
const geometry::Ring outline = rectangle(10.05, 20.07, 10, 8);

auto flat(geometry::Ring ring, double height) -> Plan { return plan(ring, {4, wall(height)}, height); }

/// A roof at `level` with a strip of that width around it, `high` above.
auto with_parapet(double width, double high) -> std::vector<Plan> {
  const auto within = rectangle(10.05 + width, 20.07 + width, 10 - 2 * width, 8 - 2 * width);
  auto around = flat(outline, level + high);
  around.profiles.push_back(wall(level + high));
  around.holes.push_back({{within.rbegin(), within.rend()}, std::vector<std::uint32_t>(4, 4)});
  return {around, flat(within, level)};
}

class Rims : public JudgedByScan {
 protected:
  auto proposed(const std::vector<Plan>& truth, double noise = 0.005) -> std::vector<detail::Proposal> {
    const auto accuracy = of(noise);
    const auto roof = judged(flat(outline, level), truth, noise, accuracy);
    return detail::within_rims(site_, roof.view, options_.part_price, options_);
  }
  static auto of(double noise) -> model::Accuracy {
    model::Accuracy accuracy;
    accuracy.noise = noise, accuracy.correlated_area = 0.1, accuracy.blur = 0,
    accuracy.edge_noise = 0.05;  // it is sampled every 0.2 m
    return accuracy;
  }
};

TEST_F(Rims, are_proposed_where_a_strip_all_around_is_higher) {
  const auto found = proposed(with_parapet(0.8, 0.6));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].rim);
  EXPECT_NEAR(geometry::area(found[0].polygon), 8.4 * 6.4, 4);
  EXPECT_THAT(found[0].what, testing::HasSubstr("below the parapet"));
}

TEST_F(Rims, are_none_where_it_is_lower) { EXPECT_TRUE(proposed(with_parapet(0.8, -0.6)).empty()); }

TEST_F(Rims, are_none_where_it_is_higher_on_one_side) {
  const auto high = rectangle(10.05, 20.07, 10, 0.6), rest = rectangle(10.05, 20.67, 10, 7.4);
  EXPECT_TRUE(proposed({flat(high, level + 1), flat(rest, level)}).empty());
}

TEST_F(Rims, are_none_where_they_are_lower_than_the_scan_can_tell) {
  EXPECT_TRUE(proposed(with_parapet(0.8, 0.3), 0.1).empty());
}

TEST_F(Rims, become_a_part_around_the_roof) {
  const rays::Scene mesh = scan(with_parapet(0.8, 0.6), 0.005);
  const refine::Draft drafts[]{flat_draft(outline, level)};
  const auto out = refine::refine(drafts, mesh, refine::decided_by({}, of(0.005)), {});
  ASSERT_EQ(out.parts.size(), 2U);
  const auto& around = out.parts[0].plan.holes.empty() ? out.parts[1] : out.parts[0];
  const auto& within = out.parts[0].plan.holes.empty() ? out.parts[0] : out.parts[1];
  ASSERT_EQ(around.plan.holes.size(), 1U);
  EXPECT_NEAR(around.plan.cap, level + 0.6, 0.03);
  EXPECT_NEAR(within.plan.cap, level, 0.01);
}

}  // namespace
