// Cases that a hand computes: a box off by a metre, a missing building, a tilted plane.
#include <gtest/gtest.h>

#include "evaluate/models.hpp"
#include "mansard/evaluate/evaluate.hpp"

namespace {

using mansard::evaluate::compare;
using mansard::evaluate::ErrorMap;
using mansard::evaluate::scores_over;
using mansard::geometry::Polygon;
using mansard::rays::Scene;
using models::mesh_of;
using models::rectangle;
using solids::box;
using solids::gable;

TEST(Scores_over, of_a_box_off_by_a_metre_are_one) {
  const Scene model(mesh_of({{box({0, 0}, {10, 8}, 0, 7)}})), scan(mesh_of({{box({0, 0}, {10, 8}, 0, 6)}}));
  const std::vector<Polygon> footprints{rectangle(0, 10)};
  const auto scores = scores_over(model, scan, footprints, 0, {0.25});
  EXPECT_NEAR(scores.mse, 1, 1e-5);
  EXPECT_NEAR(scores.footprint_mse, 1, 1e-5);
  EXPECT_NEAR(scores.median, 1, 1e-5);
  EXPECT_NEAR(scores.p95_absolute, 1, 1e-5);
  EXPECT_EQ(scores.cells, 1280U);
  EXPECT_EQ(scores.missed, 0);
}

TEST(Scores_over, of_a_missing_building_are_the_square_of_its_height) {
  const Scene model(mesh_of({{box({20, 0}, {30, 8}, 0, 6)}})), scan(mesh_of({{box({0, 0}, {10, 8}, 0, 6)}}));
  const std::vector<Polygon> footprints{rectangle(0, 10)};
  const auto scores = scores_over(model, scan, footprints, 0.5, {0.25});
  EXPECT_EQ(scores.cells, 0U);
  EXPECT_EQ(scores.mse, 0);
  EXPECT_NEAR(scores.footprint_mse, 5.5 * 5.5, 1e-4);
  EXPECT_NEAR(scores.missed, 80, 1e-9);
}

TEST(Scores_over, of_a_tilted_plane_are_those_of_evenly_spread_heights) {
  // Flat at 6 against 5.5 … 6.5: spread evenly over ± ½ m, so the mean square is 1/12, and 95 % lie within 0.475.
  const Scene model(mesh_of({{gable({0, 0}, {10, 8}, 0, 5.5, 6.5)}})), scan(mesh_of({{box({0, 0}, {10, 8}, 0, 6)}}));
  const std::vector<Polygon> footprints{rectangle(0, 10)};
  const auto scores = scores_over(model, scan, footprints, 0, {0.05});
  EXPECT_NEAR(scores.mse, 1.0 / 12, 1e-4);
  EXPECT_NEAR(scores.median, 0, 0.01);
  EXPECT_NEAR(scores.median_absolute, 0.25, 0.01);
  EXPECT_NEAR(scores.p95_absolute, 0.475, 0.01);
}

TEST(Scores_over, do_not_look_beyond_the_footprint) {
  const Scene model(mesh_of({{box({0, 0}, {10, 8}, 0, 6)}, {box({10, 0}, {20, 8}, 0, 16)}})),
      scan(mesh_of({{box({0, 0}, {20, 8}, 0, 6)}}));
  const std::vector<Polygon> west{rectangle(0, 10)}, both{rectangle(0, 20)};
  EXPECT_NEAR(scores_over(model, scan, west, 0, {0.25}).mse, 0, 1e-6);
  EXPECT_NEAR(scores_over(model, scan, both, 0, {0.25}).mse, 50, 1e-3);
}

TEST(Compare, gives_any_surface_the_numbers_it_gives_a_solid) {
  const std::vector<solids::Solid> town{gable({0, 0}, {10, 8}, 0, 6, 9), box({10, 0}, {20, 8}, 0, 5)};
  const Scene scan(mesh_of({{box({0, 0}, {20, 8}, 0, 6.5)}}));
  const std::vector<Polygon> footprints{rectangle(0, 21)};
  const auto labelled = mansard::label::classify(town, {});
  const auto solids = compare(labelled, scan, footprints, 1, {});
  const auto surface = compare(mesh_of({town}), scan, footprints, 1, {});
  EXPECT_NEAR(solids.scores.mse, surface.scores.mse, 1e-6);
  EXPECT_NEAR(solids.scores.footprint_mse, surface.scores.footprint_mse, 1e-6);
  EXPECT_EQ(solids.scores.cells, surface.scores.cells);
  EXPECT_EQ(solids.scores.missed, surface.scores.missed);
  EXPECT_GT(surface.scores.mse, 1);
}

TEST(Merged, puts_maps_where_they_lie) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  const std::vector<ErrorMap> maps{{{0.5, 0.5}, 1, 2, 1, {1, none}}, {{}, 1, 0, 0, {}}, {{3.5, 1.5}, 1, 1, 2, {3, 4}}};
  const auto all = mansard::evaluate::merged(maps);
  EXPECT_EQ(all.columns, 4U);
  EXPECT_EQ(all.rows, 3U);
  EXPECT_EQ(all.at(0, 0), 1);
  EXPECT_TRUE(std::isnan(all.at(1, 0)));
  EXPECT_EQ(all.at(3, 1), 3);
  EXPECT_EQ(all.at(3, 2), 4);
  EXPECT_EQ(mansard::evaluate::merged({}).columns, 0U);
}

TEST(Merged, takes_means_over_larger_cells_where_there_would_be_too_many) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  const std::vector<ErrorMap> maps{{{0.5, 0.5}, 1, 4, 2, {1, 2, none, none, 3, none, none, none}}};
  const auto all = mansard::evaluate::merged(maps, 2);
  EXPECT_EQ(all.grid, 2);
  EXPECT_EQ(all.origin, (mansard::geometry::Point2{1, 1}));
  EXPECT_EQ(all.columns, 2U);
  EXPECT_EQ(all.rows, 1U);
  EXPECT_EQ(all.at(0, 0), 2);
  EXPECT_TRUE(std::isnan(all.at(1, 0)));
}

}  // namespace
