#include <gtest/gtest.h>

#include <cmath>

#include "label/solids.hpp"
#include "mansard/base/run.hpp"
#include "mansard/evaluate/evaluate.hpp"
#include "mansard/label/label.hpp"
#include "mansard/solid/solid.hpp"

namespace {

using mansard::evaluate::compare;
using mansard::evaluate::error_over;
using mansard::evaluate::Options;
using mansard::geometry::Mesh;
using mansard::geometry::Point2;
using mansard::geometry::Polygon;
using mansard::model::LabelledSolid;
using mansard::rays::Scene;
using solids::box;
using solids::gable;
using solids::Solid;

auto rectangle(Point2 least, Point2 most) -> Polygon {
  return {{least, {most.x, least.y}, most, {least.x, most.y}}, {}};
}

auto mesh_of(const std::vector<Solid>& parts) -> Mesh {
  Mesh mesh;
  for (const auto& solid : parts) {
    const auto pieces = mansard::solid::triangulate(solid);
    EXPECT_TRUE(pieces.has_value());
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), solid.vertices.begin(), solid.vertices.end());
    for (const auto& t : pieces->triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return mesh;
}

auto plain(double z) -> Mesh {
  return {{{-50, -50, z}, {50, -50, z}, {50, 50, z}, {-50, 50, z}}, {{0, 1, 2}, {0, 2, 3}}};
}

auto labelled(std::vector<Solid> parts) -> std::vector<LabelledSolid> {
  return mansard::label::classify(std::move(parts), {});
}

auto lifted(Solid solid, double by) -> Solid { return solids::moved(std::move(solid), 0, {0, 0, by}); }

TEST(Compare, scores_zero_for_a_model_against_itself) {
  const std::vector<Solid> town{gable({0, 0}, {10, 8}, 0, 6, 9), box({10, 0}, {20, 8}, 0, 5)};
  const std::vector<Polygon> footprints{rectangle({0, 0}, {10, 8}), rectangle({10, 0}, {20, 8})};
  const auto result = compare(labelled(town), Scene(mesh_of(town)), footprints, 0, {});
  EXPECT_EQ(result.scores.cells, 80U * 32U);
  EXPECT_EQ(result.scores.footprint_cells, 80U * 32U);
  EXPECT_NEAR(result.scores.mse, 0, 1e-10);
  EXPECT_NEAR(result.scores.footprint_mse, 0, 1e-10);
  EXPECT_NEAR(result.scores.p95_absolute, 0, 1e-5);
  EXPECT_EQ(result.scores.missed, 0);
  EXPECT_EQ(result.scores.invented, 0);
}

TEST(Compare, scores_h_squared_for_a_lift_by_h) {
  for (const double h : {-1.5, 0.25, 2.0}) {
    const auto house = gable({0, 0}, {10, 8}, 0, 6, 9);
    const std::vector<Polygon> footprints{rectangle({0, 0}, {10, 8})};
    const auto result = compare(labelled({lifted(house, h)}), Scene(mesh_of({house})), footprints, 0, {});
    EXPECT_NEAR(result.scores.mse, h * h, 1e-4);
    EXPECT_NEAR(result.scores.footprint_mse, h * h, 1e-4);
    EXPECT_NEAR(result.scores.median, h, 1e-4);
    EXPECT_NEAR(result.scores.median_absolute, std::abs(h), 1e-4);
    EXPECT_NEAR(result.scores.p95_absolute, std::abs(h), 1e-4);
  }
}

TEST(Compare, aligns_the_grid_to_whole_multiples_so_that_equal_areas_get_equal_samples) {
  for (const double shift : {0.0, 0.25, -3.75, 1000.5}) {
    const auto house = box({shift, shift}, {shift + 10, shift + 8}, 0, 6);
    const auto result = compare(labelled({house}), Scene(mesh_of({house})),
                                std::vector{rectangle({shift, shift}, {shift + 10, shift + 8})}, 0, {});
    EXPECT_EQ(result.scores.cells, 40U * 32U) << shift;
    EXPECT_EQ(result.map.columns, 40U) << shift;
    EXPECT_EQ(result.map.rows, 32U) << shift;
    EXPECT_EQ(result.map.origin, (Point2{shift + 0.125, shift + 0.125})) << shift;
  }
}

TEST(Compare, counts_missed_ground_and_takes_it_for_the_error_of_footprints) {
  const auto scan = plain(7);
  const std::vector<Polygon> footprints{rectangle({0, 0}, {10, 8}), rectangle({10, 0}, {20, 8})};
  const auto result = compare(labelled({box({0, 0}, {10, 8}, 0, 6)}), Scene(scan), footprints, 3, {});
  EXPECT_NEAR(result.scores.missed, 80, 1e-9);
  EXPECT_EQ(result.scores.invented, 0);
  EXPECT_NEAR(result.scores.mse, 1, 1e-4);                         // the paper's error does not see what is missing
  EXPECT_NEAR(result.scores.footprint_mse, (1 + 16) / 2.0, 1e-4);  // ground at 3 under a scan at 7
  EXPECT_EQ(result.scores.cells, 40U * 32U);
  EXPECT_TRUE(std::isnan(result.map.at(60, 4)));
  EXPECT_NEAR(result.map.at(4, 4), -1, 1e-4);
}

TEST(Compare, counts_what_is_invented_even_outside_the_bounding_box) {
  const auto result =
      compare(labelled({box({-5, 0}, {15, 8}, 0, 6)}), Scene(plain(6)), std::vector{rectangle({0, 0}, {10, 8})}, 0, {});
  EXPECT_NEAR(result.scores.invented, 10 * 8, 1e-9);
  EXPECT_EQ(result.map.columns, 40U);
  EXPECT_EQ(result.scores.cells, 40U * 32U);
}

TEST(Compare, leaves_courtyards_out_of_the_footprints) {
  auto polygon = rectangle({0, 0}, {10, 8});
  polygon.holes.push_back({{4, 2}, {4, 6}, {8, 6}, {8, 2}});
  const auto result = compare(labelled({box({0, 0}, {10, 8}, 0, 6)}), Scene(plain(6)), std::vector{polygon}, 0, {});
  EXPECT_EQ(result.scores.footprint_cells, 1280U - 256U);
  EXPECT_NEAR(result.scores.invented, 16, 1e-9);
}

TEST(Compare, does_not_count_where_the_scan_has_no_surface) {
  const auto half = box({0, 0}, {5, 8}, 0, 6);
  const auto result = compare(labelled({box({0, 0}, {10, 8}, 0, 7)}), Scene(mesh_of({half})),
                              std::vector{rectangle({0, 0}, {10, 8})}, 0, {});
  EXPECT_EQ(result.scores.cells, 20U * 32U);
  EXPECT_NEAR(result.scores.mse, 1, 1e-4);
  EXPECT_TRUE(std::isnan(result.map.at(30, 10)));
}

TEST(Compare, grows_the_map_by_the_margin) {
  Options options;
  options.grid = 0.5;
  options.margin = 2;
  const auto result = compare(labelled({box({-5, 0}, {15, 8}, 0, 6)}), Scene(plain(6)),
                              std::vector{rectangle({0, 0}, {10, 8})}, 0, options);
  EXPECT_EQ(result.map.columns, 28U);
  EXPECT_EQ(result.map.rows, 24U);
  EXPECT_EQ(result.scores.cells, 28U * 16U);
}

TEST(Compare, of_nothing_scores_nothing) {
  const auto result = compare(labelled({}), Scene(Mesh{}), {}, 0, {});
  EXPECT_EQ(result.scores.cells, 0U);
  EXPECT_EQ(result.scores.mse, 0);
  EXPECT_TRUE(result.map.difference.empty());
}

TEST(Compare, takes_quantiles_over_all_cells) {
  // A quarter of the model is 4 m too high, the rest 1 m too low.
  const std::vector<Solid> model{box({0, 0}, {4, 8}, 0, 10), box({4, 0}, {16, 8}, 0, 5)};
  const auto result = compare(labelled(model), Scene(plain(6)), std::vector{rectangle({0, 0}, {16, 8})}, 0, {});
  EXPECT_NEAR(result.scores.mse, (16 + 3 * 1) / 4.0, 1e-3);
  EXPECT_NEAR(result.scores.median, -1, 1e-4);
  EXPECT_NEAR(result.scores.median_absolute, 1, 1e-4);
  EXPECT_NEAR(result.scores.p95_absolute, 4, 1e-4);
}

TEST(Compare, is_the_same_at_one_and_two_threads) {
  const auto house = solids::moved(gable({0, 0}, {31, 17}, 0, 6, 9), 0.3, {0, 0, 0});
  const auto run = [&](std::size_t threads) {
    mansard::base::limit_threads(threads);
    auto result = compare(labelled({house}), Scene(plain(4)), std::vector{rectangle({-5, 0}, {30, 25})}, 0, {});
    mansard::base::limit_threads(0);
    return result;
  };
  const auto one = run(1), two = run(2);
  EXPECT_EQ(one.scores.mse, two.scores.mse);
  EXPECT_EQ(one.scores.footprint_mse, two.scores.footprint_mse);
  EXPECT_EQ(one.scores.p95_absolute, two.scores.p95_absolute);
}

/// Every cell, also beside walls.
constexpr Options whole{0.25, 0, 0};

TEST(Error_over, is_the_mean_square_over_the_polygon) {
  const auto house = gable({0, 0}, {10, 8}, 0, 6, 9);
  const Scene scan(mesh_of({house}));
  const auto polygon = rectangle({0, 0}, {10, 8});
  EXPECT_NEAR(error_over(house, polygon, scan, whole), 0, 1e-10);
  EXPECT_NEAR(error_over(lifted(house, 0.5), polygon, scan, whole), 0.25, 1e-4);
  // A flat top at mid-height: heights spread evenly over ± 1.5 m.
  EXPECT_NEAR(error_over(box({0, 0}, {10, 8}, 0, 7.5), polygon, scan, {0.05, 0, 0}), 1.5 * 1.5 / 3, 1e-3);
}

TEST(Error_over, counts_only_cells_that_the_scan_shows) {
  const Scene scan(mesh_of({box({0, 0}, {5, 8}, 0, 6)}));
  EXPECT_NEAR(error_over(box({0, 0}, {10, 8}, 0, 8), rectangle({0, 0}, {10, 8}), scan, whole), 4, 1e-4);
  EXPECT_EQ(error_over(box({20, 0}, {30, 8}, 0, 8), rectangle({20, 0}, {30, 8}), scan, whole),
            std::numeric_limits<double>::infinity());
}

TEST(Error_over, takes_the_base_where_the_solid_leaves_the_polygon_bare) {
  const Scene scan(plain(5));
  EXPECT_NEAR(error_over(box({0, 0}, {5, 8}, 2, 5), rectangle({0, 0}, {10, 8}), scan, whole), 9 / 2.0, 1e-4);
}

TEST(Error_over, leaves_out_what_is_beside_walls) {
  const auto tower = box({0, 0}, {10, 8}, 0, 30);
  // The scan shows it 0.3 m farther east: at one wall its height is not seen, at the other more than it.
  const Scene scan(mesh_of({box({-20, -20}, {30, 30}, -1, 0), box({0.3, 0}, {10.3, 8}, 0, 30)}));
  EXPECT_GT(error_over(tower, rectangle({0, 0}, {10, 8}), scan, whole), 10);
  EXPECT_NEAR(error_over(tower, rectangle({0, 0}, {10, 8}), scan, {}), 0, 1e-9);
}

TEST(Options, are_all_listed) {
  Options options;
  const auto list = mansard::evaluate::option_list(options);
  EXPECT_EQ(list.options().size(), 3U);
  EXPECT_TRUE(list.find("inset")->set("0").has_value());
  EXPECT_FALSE(list.find("grid")->set("0").has_value());
}

TEST(Compare, counts_solids_that_cannot_be_cut_into_triangles) {
  auto town = labelled({box({0, 0}, {10, 8}, 0, 6), box({20, 0}, {30, 8}, 0, 6)});
  const Scene scan(mesh_of({town[0].solid, town[1].solid}));
  const std::vector<Polygon> footprints{rectangle({0, 0}, {10, 8}), rectangle({20, 0}, {30, 8})};
  EXPECT_EQ(compare(town, scan, footprints, 0, {}).lost, 0U);
  auto& loop = town[1].solid.faces[0].loops[0];
  std::swap(loop[0], loop[1]);  // crosses itself
  const auto result = compare(town, scan, footprints, 0, {});
  EXPECT_EQ(result.lost, 1U);
  EXPECT_NEAR(result.scores.missed, 80, 1e-9);
}

}  // namespace
