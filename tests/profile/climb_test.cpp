#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "mansard/profile/detail/climb.hpp"

namespace {

using mansard::profile::detail::climb;
using mansard::profile::detail::Climb;
using mansard::profile::detail::Piece;
using mansard::profile::detail::SectionPoint;
using mansard::profile::detail::wall_position;

/// A section drawn in ASCII: a character is half a metre wide and half a metre high, '|' stands for wall, '_' for what
/// is level, '/' and '\' for slopes. The last line is the ground; the column under the '^' of the line after it is the
/// edge's foot.
auto drawn(const std::vector<std::string>& lines) -> std::vector<Piece> {
  constexpr double half = 0.5;
  const auto foot = static_cast<double>(lines.back().find('^'));
  std::vector<Piece> pieces;
  for (std::size_t row = 0; row + 1 < lines.size(); ++row) {
    const double low = half * static_cast<double>(lines.size() - 2 - row), high = low + half;
    for (std::size_t column = 0; column < lines[row].size(); ++column) {
      const double left = half * (static_cast<double>(column) - foot), right = left + half;
      switch (lines[row][column]) {
        case '|': pieces.push_back({{left, low}, {left, high}}); break;
        case '_': pieces.push_back({{left, low}, {right, low}}); break;
        case '/': pieces.push_back({{left, low}, {right, high}}); break;
        case '\\': pieces.push_back({{right, low}, {left, high}}); break;
        default: break;
      }
    }
  }
  return pieces;
}

void expect_rising(const Climb& climb) {
  for (std::size_t i = 0; i + 1 < climb.points.size(); ++i)
    EXPECT_LE(climb.points[i].height, climb.points[i + 1].height);
}

TEST(Climb, goes_up_the_wall_and_the_roof_to_the_ridge_and_down_to_the_ground) {
  const auto found = climb(drawn({
                               R"(          /\       )",
                               R"(         /  \      )",
                               R"(        /    \     )",
                               R"(       /      \    )",
                               R"(      /        \   )",
                               R"(      |         |  )",
                               R"(      |         |  )",
                               R"(      |         |  )",
                               R"(      |         |  )",
                               R"(      |         |  )",
                               R"(______|         |__)",
                               R"(      ^            )",
                           }),
                           {});
  ASSERT_TRUE(found);
  expect_rising(*found);
  EXPECT_EQ(found->points.front().height, 0);
  EXPECT_EQ(found->points.front().inward, 0);
  EXPECT_EQ(found->points.back().height, 5.5);
  EXPECT_EQ(found->points.back().inward, 2.5);
  EXPECT_EQ(wall_position(*found, {}), 0.0);
}

TEST(Climb, jumps_a_hole_of_up_to_three_metres) {
  const std::vector<std::string> section{R"(            /)", R"(           / )", R"(          /  )", R"(             )",
                                         R"(             )", R"(             )", R"(      /      )", R"(      |      )",
                                         R"(      |      )", R"(      |      )", R"(      |      )", R"(      |      )",
                                         R"(______|      )", R"(      ^      )"};
  const auto found = climb(drawn(section), {});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->points.back().height, 6.5);
  mansard::profile::Options near;
  near.jump = 1.5;
  EXPECT_EQ(climb(drawn(section), near)->points.back().height, 3.5);
}

TEST(Climb, passes_the_parapet_to_the_roof_behind) {
  const auto found = climb(drawn({
                               R"(               /)",
                               R"(              / )",
                               R"(             /  )",
                               R"(      _     /   )",
                               R"(      ||   /    )",
                               R"(      ||__/     )",
                               R"(      |         )",
                               R"(      |         )",
                               R"(      |         )",
                               R"(      |         )",
                               R"(______|         )",
                               R"(      ^         )",
                           }),
                           {});
  ASSERT_TRUE(found);
  expect_rising(*found);
  EXPECT_EQ(found->points.back().height, 5.5);
  EXPECT_EQ(found->points.back().inward, 5);
}

TEST(Climb, starts_from_the_roof_where_the_wall_is_missing_or_only_a_hedge_shows) {
  const std::vector<std::string> bare{R"(         /)", R"(        / )", R"(       /  )", R"(      /   )",
                                      R"(          )", R"(          )", R"(          )", R"(          )",
                                      R"(          )", R"(          )", R"(          )", R"(          )",
                                      R"(          )", R"(______    )", R"(      ^   )"};
  auto hedge = bare;
  hedge[11] = R"(   __     )";
  hedge[12] = R"(  |  |    )";
  hedge[13] = R"(__|  |    )";
  for (const auto& section : {bare, hedge}) {
    const auto found = climb(drawn(section), {});
    ASSERT_TRUE(found);
    expect_rising(*found);
    EXPECT_EQ(found->points.back().height, 7);
  }
}

TEST(Climb, finds_nothing_over_bare_ground) {
  EXPECT_FALSE(climb({}, {}).has_value());
  EXPECT_FALSE(climb(drawn({"____________", "      ^     "}), {}).has_value());
}

TEST(Climb, measures_heights_from_the_ground_it_is_told) {
  auto pieces = drawn({R"(      |   )", R"(      |   )", R"(      |   )", R"(      |   )", R"(      |   )",
                       R"(______|   )", R"(      ^   )"});
  for (auto& p : pieces) p.low.height += 40, p.high.height += 40;
  const auto found = climb(pieces, {}, 40);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->points.front().height, 40);
  EXPECT_EQ(found->points.back().height, 43);
}

TEST(Wall_position, is_that_of_most_of_the_wall) {
  // Two metres of van before four metres of wall.
  const Climb climbed{{{-1, 0}, {-1, 2}, {0, 2}, {0, 6}}};
  EXPECT_EQ(wall_position(climbed, {}), 0.0);
  // A roof is no wall.
  EXPECT_FALSE(wall_position(Climb{{{0, 5}, {4, 8}}}, {}).has_value());
}

}  // namespace
