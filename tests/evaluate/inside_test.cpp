// What is measured inside the footprints, and what prisms score.
#include <gtest/gtest.h>

#include "evaluate/models.hpp"
#include "mansard/evaluate/detail/sums.hpp"
#include "mansard/evaluate/evaluate.hpp"

namespace {

using mansard::evaluate::combined;
using mansard::evaluate::compare;
using mansard::evaluate::Options;
using mansard::evaluate::prism_over;
using mansard::evaluate::Scores;
using mansard::evaluate::scores_over;
using mansard::evaluate::detail::Grid;
using mansard::evaluate::detail::grid_over;
using mansard::evaluate::detail::Plan;
using mansard::geometry::Polygon;
using mansard::rays::Scene;
using models::mesh_of;
using models::rectangle;
using solids::box;
using solids::gable;

// Of 10 × 8 m, the cells of 0.25 m whose centres are more than 0.75 m inside: 8.5 × 6.5 m.
constexpr std::size_t deep = 34 * 26;

TEST(Inside, leaves_out_what_is_near_the_boundary) {
  const Scene scan(mesh_of({{box({0, 0}, {10, 8}, 0, 6)}}));
  const auto narrow = mesh_of({{box({0.5, 0.5}, {9.5, 7.5}, 0, 7)}});
  const std::vector<Polygon> footprints{rectangle(0, 10)};
  const auto scores = compare(narrow, scan, footprints, 0, {}).scores;
  const double around = 80 - 9 * 7;  // m², missed: 6 m too low
  EXPECT_NEAR(scores.footprint_mse, (63 * 1 + around * 36) / 80, 1e-4);
  EXPECT_EQ(scores.inside.cells, deep);
  EXPECT_NEAR(scores.inside.mse, 1, 1e-5);
  EXPECT_NEAR(scores.inside.median_absolute, 1, 1e-5);
  EXPECT_EQ(scores.inside_each.cells, deep);
  EXPECT_NEAR(scores_over(Scene(narrow), scan, footprints, 0, {}).inside.mse, 1, 1e-5);
}

TEST(Inside, counts_misses_as_ground) {
  const Scene scan(mesh_of({{box({0, 0}, {10, 8}, 0, 6)}}));
  const std::vector<Polygon> footprints{rectangle(0, 10)};
  const auto half = compare(mesh_of({{box({0, 0}, {5, 8}, 0, 6)}}), scan, footprints, 1, {}).scores;
  EXPECT_EQ(half.inside.cells, deep);
  EXPECT_NEAR(half.inside.mse, 25.0 / 2, 1e-4);
  EXPECT_NEAR(half.footprint_mse, 25.0 / 2, 1e-4);
  const auto less = compare(mesh_of({{box({0, 0}, {4, 8}, 0, 6)}}), scan, footprints, 1, {}).scores;
  EXPECT_NEAR(less.footprint_median_absolute, 5, 1e-5);
  EXPECT_NEAR(less.inside.median_absolute, 5, 1e-5);
  EXPECT_NEAR(less.median_absolute, 0, 1e-5);  // where both are
}

TEST(Inside, knows_party_walls_even_with_a_gap) {
  const auto town = mesh_of({{box({0, 0}, {20, 8}, 0, 6)}});
  for (const double gap : {0.0, 0.05, 0.09}) {
    const std::vector<Polygon> footprints{rectangle(0, 10), rectangle(10 + gap, 20)};
    const auto scores = compare(town, Scene(town), footprints, 0, {}).scores;
    EXPECT_EQ(scores.inside.cells, 74U * 26U) << gap;
    EXPECT_EQ(scores.inside_each.cells, 2 * deep) << gap;
  }
  const std::vector<Polygon> apart{rectangle(0, 10), rectangle(10.25, 20.25)};
  EXPECT_EQ(compare(town, Scene(town), apart, 0, {}).scores.inside.cells, 2 * deep);
}

TEST(Inside, keeps_off_courtyards) {
  const auto town = mesh_of({{box({0, 0}, {10, 8}, 0, 6)}});
  auto polygon = rectangle(0, 10);
  polygon.holes.push_back({{4, 3}, {4, 5}, {6, 5}, {6, 3}});
  const auto scores = compare(town, Scene(town), std::vector{polygon}, 0, {}).scores;
  // The courtyard takes 2 × 2 m and a strip around it with round corners: centres no farther than 0.75 m.
  std::size_t near = 0;
  for (double x = 0.875; x < 9.25; x += 0.25)
    for (double y = 0.875; y < 7.25; y += 0.25) {
      const double dx = std::max({4 - x, x - 6, 0.0}), dy = std::max({3 - y, y - 5, 0.0});
      near += std::hypot(dx, dy) <= 0.75 ? 1 : 0;
    }
  EXPECT_EQ(scores.inside.cells, deep - near);
}

TEST(Inside, is_not_measured_without_inset) {
  const auto town = mesh_of({{box({0, 0}, {10, 8}, 0, 6)}});
  Options options;
  options.inset = 0;
  const auto scores = compare(town, Scene(town), std::vector{rectangle(0, 10)}, 0, options).scores;
  EXPECT_EQ(scores.inside.cells, 0U);
  EXPECT_EQ(scores.inside_each.cells, 0U);
  EXPECT_EQ(scores.footprint_cells, 1280U);
}

TEST(Prism, stands_at_the_median_height) {
  const std::vector<Polygon> footprints{rectangle(0, 10)};
  const auto flat = prism_over(Scene(mesh_of({{box({0, 0}, {10, 8}, 0, 6)}})), footprints, {});
  EXPECT_NEAR(flat.height, 6, 1e-5);
  EXPECT_NEAR(flat.scores.footprint_mse, 0, 1e-8);
  // Heights spread evenly over 5.5 … 6.5.
  const Scene pitched(mesh_of({{gable({0, 0}, {10, 8}, 0, 5.5, 6.5)}}));
  const auto prism = prism_over(pitched, footprints, {0.05});
  EXPECT_NEAR(prism.height, 6, 0.01);
  EXPECT_NEAR(prism.scores.footprint_mse, 1.0 / 12, 1e-3);
  EXPECT_NEAR(prism.scores.footprint_median_absolute, 0.25, 0.01);
  EXPECT_NEAR(prism_over(pitched, footprints, 7, {0.05}).scores.footprint_mse, 1 + 1.0 / 12, 1e-2);
  EXPECT_EQ(prism_over(pitched, std::vector{rectangle(50, 60)}, {}).scores.footprint_cells, 0U);
}

TEST(Combined, weighs_by_cells) {
  Scores one, two;
  one.cells = one.footprint_cells = one.inside.cells = 1;
  two.cells = two.footprint_cells = two.inside.cells = 3;
  one.mse = one.footprint_mse = one.inside.mse = one.inside.median_absolute = 8;
  one.missed = 2;
  const auto sum = combined(std::vector{one, two});
  EXPECT_EQ(sum.mse, 2);
  EXPECT_EQ(sum.footprint_mse, 2);
  EXPECT_EQ(sum.inside.mse, 2);
  EXPECT_EQ(sum.inside.median_absolute, 2);
  EXPECT_EQ(sum.inside.cells, 4U);
  EXPECT_EQ(sum.missed, 2);
  EXPECT_EQ(combined({}).footprint_mse, 0);
}

TEST(Inside, says_where_the_union_of_the_footprints_cannot_be_computed) {
  // Beyond what can be multiplied: the union fails.
  const std::vector<Polygon> footprints{rectangle(0, 10), {{{1e200, 0}, {2e200, 0}, {2e200, 1}}, {}}};
  const Plan plan(footprints, 0.75);
  EXPECT_TRUE(plan.union_unknown);
  const Grid grid = grid_over(mansard::geometry::bounds(footprints[0].outer), 0.25);
  for (const auto& depth : plan.depths(grid, 10)) EXPECT_EQ(depth.inside, depth.inside_each);
  EXPECT_FALSE(Plan(std::span(footprints).first(1), 0.75).union_unknown);

  Scores one, two;
  two.union_unknown = true;
  EXPECT_TRUE(combined(std::vector{one, two}).union_unknown);
}

}  // namespace
