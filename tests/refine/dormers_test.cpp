// Dormers on slopes: found where they are, and nothing else taken for one.
#include "mansard/refine/detail/dormers.hpp"

#include <gmock/gmock.h>

#include "scans.hpp"

namespace {

using namespace scans;
using testing::IsEmpty;
using testing::SizeIs;

const geometry::Ring house = rectangle(10, 20, 12, 9);

auto gabled() -> Plan { return plan(house, {roof(5, 0.9), wall(5), roof(5, 0.9), wall(5)}, 12); }
/// A box on the southern slope, its front 0.8 m from the eaves.
auto box(double x, double width, double high) -> Plan {
  const double front = 5 + 0.9 * 0.8;
  const double depth = high / 0.9;
  return plan(rectangle(x, 20.8, width, depth), std::vector<Profile>(4, wall(front + high)), front + high);
}

auto options_at(double price) -> refine::Options {
  refine::Options options;
  options.dormers.price = price;
  return options;
}

auto refined(const std::vector<Plan>& seen, const refine::Options& options = options_at(0.25))
    -> std::vector<refine::Part> {
  auto out = refine::refine(std::vector{flat_draft(house, 6)}, scan(seen), options, {});
  EXPECT_THAT(out.failed, IsEmpty());
  for (const auto& part : out.parts) {
    EXPECT_THAT(solid::check(part.raised.solid), IsEmpty());
    EXPECT_EQ(part.raised.outcome, extrude::Outcome::full);
  }
  return std::move(out.parts);
}

TEST(Dormers, become_parts_in_holes_of_the_roof) {
  const auto parts = refined({gabled(), box(12, 1.6, 1.4), box(16, 1.6, 1.4)});
  ASSERT_THAT(parts, SizeIs(3));
  EXPECT_THAT(parts[0].plan.holes, SizeIs(2));
  EXPECT_NEAR(difference(parts, {gabled(), box(12, 1.6, 1.4), box(16, 1.6, 1.4)}), 0, 0.15);
  for (const std::size_t d : {1U, 2U}) {
    EXPECT_NEAR(geometry::area(model::polygon_of(parts[d].plan)), 1.6 * 1.4 / 0.9, 0.8);
    EXPECT_NEAR(parts[d].plan.cap, 5 + 0.9 * 0.8 + 1.4, 0.15);
  }
}

TEST(Dormers, cost_what_they_must_explain) {
  EXPECT_THAT(refined({gabled(), box(12, 1.6, 1.4)}, options_at(100)), SizeIs(1));
  EXPECT_THAT(refined({gabled(), box(12, 1.6, 1.4)}, options_at(0)), SizeIs(1));
}

TEST(Dormers, too_narrow_ones_and_plain_roofs_are_none) {
  EXPECT_THAT(refined({gabled()}), SizeIs(1));
  EXPECT_THAT(refined({gabled(), box(12, 0.6, 1.4)}), SizeIs(1));  // a chimney
}

}  // namespace
