#include "mansard/evaluate/distances.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "evaluate/models.hpp"

namespace {

using namespace mansard::evaluate;
using mansard::geometry::Mesh;
using mansard::rays::Scene;
using models::model_of;
using models::Point3;
using solids::box;

auto square(double z, double size = 10) -> Mesh {
  return {{{0, 0, z}, {size, 0, z}, {size, size, z}, {0, size, z}}, {{0, 1, 2}, {0, 2, 3}}};
}

TEST(Samples, are_as_many_as_the_area_asks_for_and_spread_evenly) {
  const auto samples = samples_of(square(3), {4, 100'000}, 1);
  EXPECT_NEAR(static_cast<double>(samples.size()), 400, 1);
  std::size_t west = 0, south = 0, lower = 0;
  for (const auto& s : samples) {
    EXPECT_DOUBLE_EQ(s.point.z, 3);
    EXPECT_EQ(s.triangle, s.point.y > s.point.x ? 1U : 0U);
    west += s.point.x < 5 ? 1 : 0;
    south += s.point.y < 5 ? 1 : 0;
    lower += s.point.x + s.point.y < 10 ? 1 : 0;
  }
  for (const auto half : {west, south, lower}) EXPECT_NEAR(static_cast<double>(half), 200, 40);  // four sigma
  EXPECT_NEAR(static_cast<double>(samples_of(square(3), {4, 50}, 1).size()), 50, 1);
  EXPECT_NEAR(area_per_sample(square(3), {4, 50}), 2, 1e-12);
}

TEST(Samples, are_the_same_for_one_seed_and_others_for_another) {
  const auto first = samples_of(square(0), {}, 5), again = samples_of(square(0), {}, 5),
             other = samples_of(square(0), {}, 6);
  EXPECT_EQ(first[7].point, again[7].point);
  EXPECT_NE(first[7].point, other[7].point);
}

TEST(Spread, is_what_a_hand_computes) {
  const auto spread = spread_of({3, 4, 0, 1, 2});
  EXPECT_EQ(spread.samples, 5U);
  EXPECT_DOUBLE_EQ(spread.mean, 2);
  EXPECT_DOUBLE_EQ(spread.rms, std::sqrt(6.0));
  EXPECT_DOUBLE_EQ(spread.p95, 4);
  EXPECT_DOUBLE_EQ(spread.most, 4);
  EXPECT_EQ(spread_of({}).samples, 0U);
}

TEST(From_model, is_one_metre_for_the_roof_of_a_box_a_metre_too_high) {
  // Only the roof is a metre off: the walls lie on the scan's walls but for their topmost metre.
  const auto model = mansard::model::surface_of(model_of({{box({0, 0}, {10, 8}, 0, 7)}}));
  const auto scan = mansard::model::surface_of(model_of({{box({0, 0}, {10, 8}, 0, 6)}}));
  const auto distances = from_model(model, Scene(scan.mesh), {100, 1'000'000}, 1);
  const auto spread = spread_of(distances);
  const double walls = 36 * 7, roof = 80;
  EXPECT_NEAR(spread.mean, (roof * 1 + 36 * 1 * 0.5) / (walls + roof), 0.01);
  EXPECT_NEAR(spread.most, 1, 1e-3);
  EXPECT_NEAR(static_cast<double>(spread.samples), 100 * (walls + roof), 300);  // the ground does not count
}

TEST(From_model, leaves_out_walls_that_another_part_stands_against) {
  // Two boxes wall to wall, 8 × 6 m² from either side; the scan is their hull.
  const auto together =
      mansard::model::surface_of(model_of({{box({0, 0}, {10, 8}, 0, 6)}, {box({10, 0}, {20, 8}, 0, 9)}}));
  const auto hull = mansard::model::surface_of(model_of({{box({0, 0}, {20, 8}, 0, 6)}}));
  const auto counted = from_model(together, Scene(hull.mesh), {25, 1'000'000}, 1).size();
  const double open = 80 + (10 + 8 + 10) * 6 + 80 + (10 + 8 + 10) * 9 + 8 * 3;
  EXPECT_NEAR(static_cast<double>(counted), 25 * open, 60);
}

TEST(From_scan, sees_a_missing_building_by_its_distance_and_leaves_the_street_out) {
  auto scan = mansard::model::surface_of(model_of({{box({0, 0}, {10, 8}, 0, 6)}, {box({30, 0}, {40, 8}, 0, 6)}})).mesh;
  const auto street = square(0, 60);
  const auto first = static_cast<std::uint32_t>(scan.vertices.size());
  scan.vertices.insert(scan.vertices.end(), street.vertices.begin(), street.vertices.end());
  for (const auto& t : street.triangles) scan.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  const auto model = mansard::model::surface_of(model_of({{box({0, 0}, {10, 8}, 0, 6)}}));
  const auto rectangle = [](double x0, double x1) {
    return mansard::geometry::Polygon{{{x0, 0}, {x1, 0}, {x1, 8}, {x0, 8}}, {}};
  };
  const std::vector<Site> here{{{rectangle(0, 10)}, 0}}, both{{{rectangle(0, 10)}, 0}, {{rectangle(30, 40)}, 0}};
  EXPECT_NEAR(spread_of(from_scan(scan, here, model, {}, 1)).most, 0, 1e-4);
  const auto spread = spread_of(from_scan(scan, both, model, {}, 1));
  EXPECT_NEAR(spread.most, 30, 0.5);  // the far wall, from the model's near one
  EXPECT_GT(spread.mean, 10);
}

TEST(From_scan, does_not_take_the_ground_face_for_a_surface) {
  // A level piece of scan half-way up a box lies 3 m from its walls' tops and bottoms, and 1 m above the ground face.
  const auto model = mansard::model::surface_of(model_of({{box({0, 0}, {40, 40}, 0, 10)}}));
  const Mesh scan{{{19, 19, 1.5}, {21, 19, 1.5}, {20, 21, 1.5}}, {{0, 1, 2}}};
  const std::vector<Site> sites{{{{{{0, 0}, {40, 0}, {40, 40}, {0, 40}}, {}}}, 0}};
  EXPECT_NEAR(spread_of(from_scan(scan, sites, model, {50, 1000}, 1)).mean, 8.5, 1e-3);  // the roof
}

}  // namespace
