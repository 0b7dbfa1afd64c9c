#include "mansard/solid/detail/sheets.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace {

using mansard::solid::detail::Facing;
using mansard::solid::detail::Path;
using mansard::solid::detail::Sheets;

/// A solid over a ring of points: its roof, its ground floor, and a wall along each edge.
void add_solid(Sheets& sheets, const Path& roof, std::int64_t base) {
  const auto solid = static_cast<std::uint32_t>(sheets.base.size());
  sheets.base.push_back(base);
  sheets.sheets.push_back({Facing::up, solid, 0, {roof}});
  Path ground;
  for (auto node = roof.rbegin(); node != roof.rend(); ++node) ground.push_back({node->at, base});
  sheets.sheets.push_back({Facing::down, solid, 1, {ground}});
  for (std::size_t i = 0; i < roof.size(); ++i) {
    const auto &a = roof[i], &b = roof[(i + 1) % roof.size()];
    sheets.sheets.push_back(
        {Facing::aside, solid, static_cast<std::uint32_t>(2 + i), {{{a.at, base}, {b.at, base}, b, a}}});
  }
}

/// Of two solids beside each other one is lower, and its roof, as steep as a wall, passes through the other's ground
/// within a millimetre of where both begin, in plan.
TEST(Sheets, a_roof_passes_through_the_ground_beside_it_next_to_a_corner) {
  Sheets sheets;
  sheets.places = {{0, 0}, {326, 0}, {326, 4000}, {0, 4000}, {0, -4000}, {326, -4000}};
  add_solid(sheets, {{0, 11762}, {1, 40785}, {2, 40785}, {3, 11762}}, 11729);
  add_solid(sheets, {{4, 40785}, {5, 40785}, {1, 40785}, {0, 40785}}, 12061);
  EXPECT_TRUE(mansard::solid::detail::conform(sheets));
  for (const auto& sheet : sheets.sheets) {
    if (sheet.facing != Facing::up) continue;
    for (const auto& node : sheet.paths.front()) EXPECT_NE(node.z, 12061) << "its edge would be on that of the ground";
  }
}

}  // namespace
