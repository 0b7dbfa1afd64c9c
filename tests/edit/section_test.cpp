#include <gtest/gtest.h>

#include <algorithm>

#include "edit/plans.hpp"
#include "pipeline/houses.hpp"

namespace mansard::edit {
namespace {

auto scan() -> geometry::Mesh { return mansard::test::lone_house().mesh; }

TEST(Section, shows_the_wall_and_the_roof_behind_an_edge) {
  // From the south eaves of a house 8 m deep, eaves at 5 m, ridge at 8 m.
  const auto cut = section(scan(), {0, 0}, {12, 0}, 0.4, 0, 20);
  double top = 0, wall = 0;
  for (const auto& [a, b] : cut.pieces) {
    top = std::max({top, a.height, b.height});
    if (std::abs(a.inward) < 1e-9 && std::abs(b.inward) < 1e-9) wall = std::max({wall, a.height, b.height});
    for (const auto& p : {a, b}) {
      const double roof = p.inward < 0 || p.inward > 8 ? 0 : 5 + 3 * (1 - std::abs(p.inward - 4) / 4);
      EXPECT_LE(p.height, roof + 1e-9) << p.inward;
    }
  }
  EXPECT_NEAR(top, 8, 1e-9);
  EXPECT_NEAR(wall, 5, 1e-9);
}

TEST(Section, measures_inward_to_the_left_of_the_edge_and_up_from_the_base) {
  const auto cut = section(scan(), {12, 8}, {0, 8}, 0.5, 2, 20);
  const auto at_ridge = std::ranges::any_of(cut.pieces, [](const auto& piece) {
    return std::ranges::any_of(
        piece, [](const auto& p) { return std::abs(p.inward - 4) < 1e-9 && std::abs(p.height - 6) < 1e-9; });
  });
  EXPECT_TRUE(at_ridge);
}

TEST(Section, ends_at_its_reach_to_both_sides_and_downwards) {
  auto mesh = scan();
  mansard::test::add_quad(mesh, {6, 2, -30}, {6.5, 2, -30}, {6.5, 2, 20}, {6, 2, 20});  // a mast through the house
  const auto cut = section(mesh, {0, 0}, {12, 0}, 0.52, 0, 3);
  ASSERT_FALSE(cut.pieces.empty());
  double lowest = 0;
  for (const auto& piece : cut.pieces)
    for (const auto& p : piece) {
      EXPECT_LE(std::abs(p.inward), 3 + 1e-9);
      EXPECT_GE(p.height, -3 - 1e-9);
      lowest = std::min(lowest, p.height);
    }
  EXPECT_NEAR(lowest, -3, 1e-9);
}

TEST(Section, is_empty_for_an_edge_without_length) {
  EXPECT_TRUE(section(scan(), {3, 0}, {3, 0}, 0.5, 0, 10).pieces.empty());
}

}  // namespace
}  // namespace mansard::edit
