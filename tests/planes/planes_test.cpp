// Planes of points that were planted: how many, which points, and how well their errors are known.
#include "mansard/planes/planes.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "mansard/base/run.hpp"

namespace mansard::planes {
namespace {

using geometry::Point2;
using geometry::Point3;

constexpr double noise = 0.03;

/// Of the normal distribution (Box and Muller 1958).
auto normal(base::Random& random) -> double {
  return std::sqrt(-2 * std::log(random.uniform(1e-12, 1))) * std::cos(2 * 3.14159265358979 * random.uniform(0, 1));
}

/// So many points/m² at random places of a rectangle, at a height that is given, with noise; in order.
template <class Height>
auto scattered(Point2 least, Point2 most, double density, std::uint64_t seed, Height height, double sigma = noise)
    -> std::vector<Point3> {
  base::Random random(seed);
  std::vector<Point3> out;
  const auto count = static_cast<std::size_t>(density * (most.x - least.x) * (most.y - least.y));
  for (std::size_t i = 0; i < count; ++i) {
    const Point2 at{random.uniform(least.x, most.x), random.uniform(least.y, most.y)};
    out.push_back({at.x, at.y, height(at) + sigma * normal(random)});
  }
  std::ranges::sort(out);
  return out;
}

auto with(double density, double sigma = noise) -> Options { return {sigma, 1 / density, 1}; }

/// A gable of 45° over 12 m by 8 m, its ridge along x.
auto gable(Point2 at) -> double { return 9 - std::abs(at.y - 4); }

TEST(Planes, of_a_gable_and_a_flat_roof_beside_it_are_three_at_any_density) {
  for (const double density : {3.0, 8.0, 20.0, 40.0}) {
    const auto points = scattered({0, 0}, {20, 8}, density, 7, [](Point2 at) { return at.x < 12 ? gable(at) : 3.0; });
    const auto found = find(points, with(density));
    ASSERT_EQ(found.planes.size(), 3U) << density << " points/m²";
    std::multiset<double> slopes;
    std::size_t on = 0;
    for (const auto& plane : found.planes) {
      slopes.insert(std::round(10 * plane.slope.y) / 10);
      EXPECT_NEAR(plane.slope.x, 0, 0.05);
      EXPECT_NEAR(plane.rms, noise, 0.005);
      on += plane.points.size();
      EXPECT_TRUE(std::ranges::is_sorted(plane.points));
      for (const auto i : plane.points) EXPECT_EQ(&found.planes[found.plane_of[i]], &plane);
    }
    EXPECT_THAT(slopes, testing::ElementsAre(-1, 0, 1));
    EXPECT_GT(on, points.size() * 95 / 100) << density << " points/m²";
  }
}

TEST(Planes, without_noise_are_exact) {
  const auto points = scattered({0, 0}, {12, 8}, 10, 3, gable, 0);
  const auto found = find(points, with(10, 0));
  ASSERT_EQ(found.planes.size(), 2U);
  for (const auto& plane : found.planes)
    EXPECT_LT(plane.rms, 0.001) << "points within millimetres of the ridge are on both";
}

TEST(Planes, know_the_error_of_their_heights) {
  // Of 100 scans of a level roof: the truth is within one standard error in 68 ± 14, within two in 95 ± 6.
  int within_one = 0, within_two = 0;
  constexpr int scans = 100;
  const Point2 corner{9, 5};  // outside of the middle, where the slopes count
  for (int k = 0; k < scans; ++k) {
    const auto points = scattered({0, 0}, {10, 6}, 5, 100 + static_cast<std::uint64_t>(k), [](Point2) { return 6.0; });
    const auto found = find(points, with(5));
    ASSERT_EQ(found.planes.size(), 1U);
    const double off = std::abs(found.planes[0].at(corner) - 6) / found.planes[0].error_at(corner);
    within_one += off < 1 ? 1 : 0;
    within_two += off < 2 ? 1 : 0;
  }
  EXPECT_NEAR(within_one, 68, 14);
  EXPECT_NEAR(within_two, 95, 6);
}

TEST(Planes, do_not_take_steps_walls_and_strays_for_roofs) {
  auto points = scattered({0, 0}, {10, 8}, 12, 5, [](Point2 at) { return at.x < 5 ? 6.0 : 6.6; });
  const auto roof = points.size();
  base::Random random(9);
  for (int i = 0; i < 200; ++i) points.push_back({0.01 * normal(random), random.uniform(0, 8), random.uniform(0, 6)});
  for (int i = 0; i < 6; ++i) points.push_back({random.uniform(1, 9), random.uniform(1, 7), random.uniform(8, 14)});
  const auto found = find(points, with(12));
  ASSERT_EQ(found.planes.size(), 2U);
  for (const auto& plane : found.planes) EXPECT_NEAR(length(plane.slope), 0, 0.02);
  EXPECT_GT(std::count(found.plane_of.begin() + static_cast<std::ptrdiff_t>(roof), found.plane_of.end(), Found::wall),
            150);
  EXPECT_EQ(std::count(found.plane_of.end() - 6, found.plane_of.end(), Found::none), 6);
}

TEST(Planes, smaller_than_what_is_of_interest_are_none) {
  const auto points = scattered({0, 0}, {0.8, 0.8}, 40, 5, [](Point2) { return 6.0; });
  EXPECT_TRUE(find(points, with(40)).planes.empty());
  auto options = with(40);
  options.least_area = 0.5;
  EXPECT_EQ(find(points, options).planes.size(), 1U);
}

TEST(Planes, are_the_same_in_any_order_and_at_any_number_of_threads) {
  const auto points = scattered({0, 0}, {20, 8}, 15, 11, [](Point2 at) { return at.x < 12 ? gable(at) : 3.0; });
  const auto found = find(points, with(15));
  base::limit_threads(1);
  EXPECT_EQ(find(points, with(15)).plane_of, found.plane_of);
  base::limit_threads(0);
  auto turned = points;
  std::ranges::reverse(turned);
  const auto other = find(turned, with(15));
  ASSERT_EQ(other.planes.size(), found.planes.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_EQ(other.plane_of[points.size() - 1 - i], found.plane_of[i]) << i;
}

TEST(Planes, of_hardly_any_points_are_none) {
  EXPECT_TRUE(find({}, with(10)).planes.empty());
  const std::vector<Point3> few(5, Point3{1, 2, 3});
  EXPECT_TRUE(find(few, with(10)).planes.empty());
  const std::vector<Point3> same(50, Point3{1, 2, 3});
  EXPECT_TRUE(find(same, with(10)).planes.empty()) << "at one place";
}

}  // namespace
}  // namespace mansard::planes
