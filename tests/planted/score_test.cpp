// The score against cases that can be reckoned by hand.
#include "score.hpp"

#include <gtest/gtest.h>

namespace mansard::planted {
namespace {

using geometry::Point2;

auto box(double x0, double x1, double y0 = 0, double y1 = 10) -> geometry::Polygon {
  return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}};
}

/// Four houses of 10 m × 10 m in a row, two to a feature.
auto row() -> Plan {
  Plan truth;
  for (std::size_t k = 0; k < 4; ++k) {
    const double x = 10 * static_cast<double>(k);
    truth.pieces.push_back({box(x, x + 10), k / 2});
    if (k > 0) truth.walls.push_back({{x, 0}, {x, 10}});
  }
  return truth;
}

TEST(Score, is_perfect_for_the_truth) {
  const Score s = score(row(), row());
  EXPECT_EQ(s.parts.recall, 1);
  EXPECT_EQ(s.parts.precision, 1);
  EXPECT_EQ(s.features.recall, 1);
  EXPECT_EQ(s.features.precision, 1);
  EXPECT_EQ(s.splits, 0U);
  EXPECT_EQ(s.merges, 0U);
  EXPECT_NEAR(s.wall_length, 30, 1e-9);
  EXPECT_DOUBLE_EQ(s.wall_recall, 1);
  EXPECT_EQ(s.false_splits, 0);
  EXPECT_DOUBLE_EQ(s.pair_recall, 1);
  EXPECT_DOUBLE_EQ(s.pair_precision, 1);
  EXPECT_DOUBLE_EQ(s.rand, 1);
}

TEST(Score, of_everything_in_one_piece_finds_no_wall) {
  Plan found;
  found.pieces.push_back({box(0, 40), 0});
  const Score s = score(row(), found);
  EXPECT_EQ(s.parts.recall, 0);
  EXPECT_EQ(s.parts.precision, 0);
  EXPECT_EQ(s.features.recall, 0) << "a feature is just half of the whole, which is no match";
  EXPECT_EQ(s.splits, 0U);
  EXPECT_EQ(s.merges, 1U);
  EXPECT_EQ(s.wall_recall, 0);
  EXPECT_EQ(s.false_splits, 0);
  EXPECT_DOUBLE_EQ(s.pair_recall, 1);
  EXPECT_DOUBLE_EQ(s.pair_precision, 0.25);
  EXPECT_DOUBLE_EQ(s.rand, 0.25) << "pairs in different houses, three quarters of all, are judged wrongly";
}

TEST(Score, of_houses_cut_into_halves_counts_every_false_metre) {
  Plan found;
  for (std::size_t k = 0; k < 8; ++k) {
    const double x = 5 * static_cast<double>(k);
    found.pieces.push_back({box(x, x + 5), k / 4});
  }
  const Score s = score(row(), found);
  EXPECT_EQ(s.parts.recall, 0) << "a half is no match";
  EXPECT_EQ(s.features.recall, 1);
  EXPECT_EQ(s.features.precision, 1);
  EXPECT_EQ(s.splits, 4U);
  EXPECT_EQ(s.merges, 0U);
  EXPECT_DOUBLE_EQ(s.wall_recall, 1);
  EXPECT_NEAR(s.false_splits, 4.0 / 3, 1e-9);
  EXPECT_DOUBLE_EQ(s.pair_recall, 0.5);
  EXPECT_DOUBLE_EQ(s.pair_precision, 1);
  EXPECT_DOUBLE_EQ(s.rand, 1 - 0.125);
}

TEST(Score, of_houses_cut_unevenly_matches_the_greater_pieces) {
  Plan found;
  for (std::size_t k = 0; k < 4; ++k) {
    const double x = 10 * static_cast<double>(k);
    found.pieces.push_back({box(x, x + 7), {}});
    found.pieces.push_back({box(x + 7, x + 10), {}});
  }
  const Score s = score(row(), found);
  EXPECT_EQ(s.parts.recall, 1);
  EXPECT_NEAR(s.parts.precision, 0.7, 1e-9);
  EXPECT_EQ(s.features.recall, 0) << "pieces without a feature stay alone";
  EXPECT_EQ(s.splits, 4U);
  EXPECT_NEAR(s.pair_recall, 0.58, 1e-9);
}

TEST(Score, of_nothing_recalls_nothing) {
  const Score s = score(row(), {});
  EXPECT_EQ(s.parts.recall, 0);
  EXPECT_EQ(s.parts.precision, 1) << "nothing was found that is wrong";
  EXPECT_EQ(s.wall_recall, 0);
  EXPECT_DOUBLE_EQ(s.pair_precision, 0.25);
}

TEST(Score, takes_a_wall_half_a_metre_off_and_none_farther) {
  const auto with_wall_at = [](double x) {
    Plan truth, found;
    truth.pieces = {{box(0, 10), 0}, {box(10, 20), 1}};
    truth.walls = {{{10, 0}, {10, 10}}};
    found.pieces = {{box(0, x), 0}, {box(x, 20), 1}};
    return score(truth, found);
  };
  EXPECT_DOUBLE_EQ(with_wall_at(10.45).wall_recall, 1);
  EXPECT_EQ(with_wall_at(10.45).false_splits, 0);
  EXPECT_EQ(with_wall_at(10.6).wall_recall, 0);
  EXPECT_NEAR(with_wall_at(10.6).false_splits, 1, 1e-9);
  EXPECT_EQ(with_wall_at(10.6).parts.recall, 1) << "the houses themselves are found";
}

TEST(Score, takes_no_wall_across_for_one_along) {
  Plan truth, found;
  truth.pieces = {{box(0, 10), 0}, {box(10, 20), 1}};
  truth.walls = {{{10, 0}, {10, 10}}};
  found.pieces = {{box(0, 20, 0, 5), 0}, {box(0, 20, 5, 10), 1}};
  const Score s = score(truth, found);
  EXPECT_EQ(s.wall_recall, 0);
  EXPECT_NEAR(s.false_splits, 1.9, 0.02) << "20 m across, of which half a metre to both sides lies at the wall";
}

TEST(Score, is_near_one_where_the_program_works_without_errors_of_its_input) {
  Recipe recipe;
  recipe.houses = 6;
  recipe.equal = 0;
  recipe.step_least = 3;
  recipe.wings = 0;
  recipe.roofs = {Roof::flat};
  recipe.height_sigma = recipe.melt = recipe.lateral = recipe.angle = recipe.missing = recipe.twice = recipe.broken =
      recipe.shorter = recipe.clutter = recipe.gis = 0;
  const Block planted = make(recipe);
  const segment::Options options;
  const auto found =
      segment::choose(fractured(planted), planted.edges, planted.block, rays::Scene(planted.block.mesh), options)
          .value();
  const Score s = score(plan_of(planted), plan_of(found.parts));
  EXPECT_EQ(s.parts.recall, 1);
  EXPECT_EQ(s.parts.precision, 1);
  EXPECT_EQ(s.wall_recall, 1);
  EXPECT_EQ(s.false_splits, 0);
  EXPECT_GT(s.rand, 0.98);
}

}  // namespace
}  // namespace mansard::planted
