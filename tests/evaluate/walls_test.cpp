#include "mansard/evaluate/walls.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using mansard::evaluate::away_from_walls;
using mansard::evaluate::HeightCells;

/// So many cells of 0.25 m each way, of one height.
auto level(std::size_t columns, std::size_t rows, double height) -> HeightCells {
  return {columns, rows, 0.25, std::vector(columns * rows, height)};
}

auto kept(const std::vector<bool>& cells) { return std::ranges::count(cells, true); }

TEST(Away_from_walls, leaves_out_a_strip_along_the_end) {
  const auto cells = away_from_walls(level(20, 16, 5), 0.5);
  EXPECT_EQ(kept(cells), 16 * 12);
  EXPECT_FALSE(cells[2 * 20 + 1]);
  EXPECT_TRUE(cells[2 * 20 + 2]);
}

TEST(Away_from_walls, leaves_out_a_strip_on_both_sides_of_a_step) {
  auto tower = level(40, 40, 5);
  for (std::size_t y = 0; y < 40; ++y)
    for (std::size_t x = 20; x < 40; ++x) tower.heights[y * 40 + x] = 9;
  const auto cells = away_from_walls(tower, 0.5);
  for (const std::size_t x : {18, 19, 20, 21}) EXPECT_FALSE(cells[20 * 40 + x]) << x;
  for (const std::size_t x : {17, 22}) EXPECT_TRUE(cells[20 * 40 + x]) << x;
}

TEST(Away_from_walls, takes_a_steep_roof_for_a_roof) {
  auto roof = level(40, 40, 0);
  for (std::size_t y = 0; y < 40; ++y)
    for (std::size_t x = 0; x < 40; ++x) roof.heights[y * 40 + x] = 0.25 * 2 * static_cast<double>(x);  // 63°
  EXPECT_EQ(kept(away_from_walls(roof, 0.5)), 36 * 36);
}

TEST(Away_from_walls, goes_nearer_where_little_would_be_left) {
  EXPECT_EQ(kept(away_from_walls(level(8, 8, 5), 1)), 4 * 4) << "0.5 m, as that is the most that leaves a fifth";
  EXPECT_EQ(kept(away_from_walls(level(2, 9, 5), 1)), 18) << "nothing is away from the walls of a strip";
  EXPECT_EQ(kept(away_from_walls(level(8, 8, 5), 0)), 64);
}

TEST(Away_from_walls, counts_nothing_outside) {
  auto cells = level(20, 20, 5);
  for (std::size_t y = 0; y < 20; ++y)
    for (std::size_t x = 0; x < 10; ++x) cells.heights[y * 20 + x] = HeightCells::outside;
  const auto found = away_from_walls(cells, 0.25);
  EXPECT_FALSE(found[10 * 20 + 5]);
  EXPECT_FALSE(found[10 * 20 + 10]) << "beside the outside";
  EXPECT_TRUE(found[10 * 20 + 11]);
}

}  // namespace
