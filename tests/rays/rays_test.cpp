#include "mansard/rays/rays.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "mansard/base/run.hpp"

namespace mansard::rays {
namespace {

/// Two level squares of 10 m, at z = 3 and z = 7 (the upper one smaller), far from the origin.
auto two_storeys(geometry::Point3 shift) -> geometry::Mesh {
  geometry::Mesh mesh;
  const auto square = [&](double size, double z) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {size, 0.0}, {size, size}, {0.0, size}})
      mesh.vertices.push_back(shift + geometry::Point3{x, y, z});
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  };
  square(10, 3);
  square(5, 7);
  return mesh;
}

TEST(Scene, sees_the_topmost_surface) {
  const geometry::Point3 shift{500, -300, 20};
  const Scene scene(two_storeys(shift));
  EXPECT_NEAR(*scene.top({502, -298}), 27, 1e-4);
  EXPECT_NEAR(*scene.top({508, -292}), 23, 1e-4);
  EXPECT_FALSE(scene.top({511, -298}).has_value());
  EXPECT_GE(scene.seen_from_above({502, -298})->triangle, 2U);
}

TEST(Scene, has_the_points_in_a_box_but_not_where_a_triangle_hides_them) {
  auto mesh = two_storeys({0, 0, 0});
  EXPECT_FALSE(Scene(mesh).has_points());
  EXPECT_TRUE(Scene(mesh).points_in({{-1, -1}, {20, 20}}).empty());
  mesh.points = {{8, 8, 3.1}, {1, 1, 7.2}, {5, 9, 2.9}, {8, 2, 3}, {12, 12, 0}};
  const Scene scene(mesh), hiding(mesh, {2, 3});  // the upper square
  EXPECT_TRUE(scene.has_points());
  using Points = std::vector<geometry::Point3>;
  EXPECT_EQ(scene.points_in({{-1, -1}, {20, 20}}),
            (Points{{1, 1, 7.2}, {5, 9, 2.9}, {8, 2, 3}, {8, 8, 3.1}, {12, 12, 0}}));
  EXPECT_EQ(scene.points_in({{5, 2}, {8, 8}}), (Points{{8, 2, 3}, {8, 8, 3.1}})) << "its border counts";
  EXPECT_TRUE(scene.points_in({{6, 6}, {7, 7}}).empty());
  EXPECT_EQ(hiding.points_in({{-1, -1}, {20, 20}}), (Points{{5, 9, 2.9}, {8, 2, 3}, {8, 8, 3.1}, {12, 12, 0}}));
}

TEST(Scene, sees_nothing_from_above_where_a_triangle_is_left_out) {
  const geometry::Point3 shift{500, -300, 20};
  const auto mesh = two_storeys(shift);
  const Scene scene(mesh, {2, 3});  // the upper square
  EXPECT_FALSE(scene.top({502, -298}));
  EXPECT_FALSE(scene.seen_from_above({502, -298}));
  EXPECT_NEAR(*scene.top({508, -292}), 23, 1e-4);
  // Only from above: other rays and distances pass it.
  const auto hit = scene.cast({502, -298, 40}, {0, 0, -1});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance, 17, 1e-4);
  EXPECT_FALSE(scene.nearest({502, -298, 27}, 1));
  EXPECT_FALSE(Scene(mesh, {0, 1, 2, 3}).top({508, -292}));
  EXPECT_FALSE(Scene(mesh, {0, 1, 2, 3}).cast({502, -298, 40}, {0, 0, -1}));
}

/// What a line of places (x, z) sweeps along 20 m of y; from left to right its front is above.
auto swept(const std::vector<geometry::Point2>& line) -> geometry::Mesh {
  geometry::Mesh mesh;
  for (const auto at : line)
    for (const double y : {-10.0, 10.0}) mesh.vertices.push_back({at.x, y, at.y});
  for (std::uint32_t i = 0; i + 2 < mesh.vertices.size(); i += 2) {
    mesh.triangles.push_back({i, i + 2, i + 3});
    mesh.triangles.push_back({i, i + 3, i + 1});
  }
  return mesh;
}

/// A tower from x = 5 to 15, 24 m high, whose right wall waves by 0.15 m about x = 15.05, on a roof at z = 6.
auto waving_tower() -> geometry::Mesh {
  return swept({{-5, 0},
                {0, 0},
                {0, 6},
                {5, 6},
                {5, 24},
                {14.9, 24},
                {15.2, 18},
                {14.9, 14},
                {15.2, 10},
                {15, 6},
                {20, 6},
                {20, 0},
                {25, 0}});
}

TEST(Scene, sees_the_roof_below_a_wall_that_only_bulges_over_it) {
  auto mesh = waving_tower();
  for (const bool turned : {false, true}) {
    if (turned)
      for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
    const Scene scene(mesh);
    EXPECT_NEAR(*scene.top({15.1, 0.3}), 20, 1e-9);
    EXPECT_NEAR(*scene.top_inside_walls({15.1, 0.3}, 0), 6, 1e-9);  // hollow over 7.3 of 14 m
    EXPECT_NEAR(*scene.top_inside_walls({14.95, 0.3}, 0), 23, 1e-9);
    EXPECT_NEAR(*scene.top_inside_walls({10, 0.3}, 0), 24, 1e-9);
    EXPECT_NEAR(*scene.top_inside_walls({17, 0.3}, 0), 6, 1e-9);
    EXPECT_FALSE(scene.top_inside_walls({30, 0.3}, 0));
    // What is less than 2 m above the ground is no roof.
    EXPECT_NEAR(*scene.top_inside_walls({15.1, 0.3}, 4.5), 20, 1e-9);
  }
}

TEST(Scene, sees_what_juts_out_farther_than_walls_bulge) {
  // A slab of 0.3 m, 1.2 m wide, and the same 0.3 m wide.
  const auto with_slab = [](double width) {
    return Scene(swept({{-5, 0},
                        {0, 0},
                        {0, 6},
                        {5, 6},
                        {5, 24},
                        {15 + width, 24},
                        {15 + width, 23.7},
                        {15, 23.7},
                        {15, 6},
                        {20, 6},
                        {20, 0},
                        {25, 0}}));
  };
  EXPECT_NEAR(*with_slab(1.2).top_inside_walls({15.5, 0.3}, 0), 24, 1e-9);
  EXPECT_NEAR(*with_slab(0.3).top_inside_walls({15.2, 0.3}, 0), 6, 1e-9);
}

TEST(Scene, sees_no_roof_below_a_wall_whose_fronts_do_not_alternate_or_that_is_left_out) {
  auto mesh = waving_tower();
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  for (const auto& t : std::vector(mesh.triangles)) mesh.triangles.push_back(t);  // all of it 0.1 m higher, too
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const auto& v : std::vector(mesh.vertices)) mesh.vertices.push_back({v.x, v.y, v.z + 0.1});
  for (std::uint32_t t = count; t < 2 * count; ++t)
    for (auto& corner : mesh.triangles[t]) corner += first;
  EXPECT_NEAR(*Scene(mesh).top_inside_walls({15.1, 0.3}, 0), 20.1, 1e-9);

  mesh = waving_tower();
  EXPECT_FALSE(Scene(mesh, {10, 11}).top_inside_walls({15.1, 0.3}, 0));            // the topmost
  EXPECT_NEAR(*Scene(mesh, {14, 15}).top_inside_walls({15.1, 0.3}, 0), 20, 1e-9);  // one below
}

TEST(Scene, casts_in_metres_whatever_the_length_of_the_direction) {
  const Scene scene(two_storeys({}));
  const auto hit = scene.cast({2, 2, 0}, {0, 0, 100});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance, 3, 1e-5);
  EXPECT_FALSE(scene.cast({2, 2, 8}, {0, 0, 1}));
}

TEST(Scene, of_nothing_sees_nothing) {
  const Scene scene(geometry::Mesh{});
  EXPECT_FALSE(scene.top({0, 0}));
  EXPECT_FALSE(scene.top_inside_walls({0, 0}, 0));
  EXPECT_FALSE(scene.cast({0, 0, 0}, {1, 0, 0}));
}

TEST(Scene, casts_many_rays_as_one_by_one) {
  const Scene scene(two_storeys({500, -300, 20}));
  std::vector<Ray> rays;  // 13 × 13: no multiple of a packet
  for (int i = 0; i < 13; ++i)
    for (int j = 0; j < 13; ++j) rays.push_back({{499 + i + 0.31, -301 + j + 0.17, 40}, {0.1, 0.05, -2.0 - i}});
  std::vector<std::optional<Hit>> hits(rays.size());
  std::vector<char> blocked(rays.size());
  scene.cast_all(rays, hits);
  scene.cast_any(rays, blocked);
  std::size_t met = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const auto one = scene.cast(rays[k].origin, rays[k].direction);
    ASSERT_EQ(hits[k].has_value(), one.has_value()) << k;
    EXPECT_EQ(blocked[k] != 0, one.has_value()) << k;
    if (!one) continue;
    ++met;
    EXPECT_NEAR(hits[k]->distance, one->distance, 1e-4) << k;
    EXPECT_EQ(hits[k]->triangle, one->triangle) << k;
  }
  EXPECT_GT(met, 50U);
  EXPECT_LT(met, rays.size());
  scene.cast_all({}, {});
  Scene(geometry::Mesh{}).cast_all(rays, hits);
  for (const auto& hit : hits) EXPECT_FALSE(hit);
  Scene(geometry::Mesh{}).cast_any(rays, blocked);
  EXPECT_THAT(blocked, testing::Each(0));
}

/// The slow way: the least distance over many places of the triangle.
auto sampled_distance(geometry::Point3 p, geometry::Point3 a, geometry::Point3 b, geometry::Point3 c) -> double {
  constexpr int n = 200;
  double least = 1e9;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; i + j <= n; ++j)
      least = std::min(least, length(p - (a + (i / double{n}) * (b - a) + (j / double{n}) * (c - a))));
  return least;
}

TEST(Nearest, is_on_a_corner_an_edge_or_inside_as_a_search_over_many_places_says) {
  base::Random random(7);
  const auto any = [&] {
    return geometry::Point3{random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5)};
  };
  for (int round = 0; round < 40; ++round) {
    const geometry::Point3 shift{80000, 400000, 12};
    const geometry::Point3 a = any(), b = any(), c = any(), p = any();
    const Scene scene(geometry::Mesh{{shift + a, shift + b, shift + c}, {{0, 1, 2}}});
    const auto near = scene.nearest(shift + p);
    ASSERT_TRUE(near);
    EXPECT_NEAR(near->distance, sampled_distance(p, a, b, c), 0.06) << round;  // the samples lie up to 8 cm apart
    EXPECT_LE(near->distance, sampled_distance(p, a, b, c) + 1e-3) << round;
    EXPECT_NEAR(length(near->point - (shift + p)), near->distance, 1e-3) << round;
  }
}

TEST(Nearest, searches_within_the_given_distance_only) {
  const Scene scene(two_storeys({}));
  EXPECT_FALSE(scene.nearest({2, 2, 9.5}, 2.4));
  const auto near = scene.nearest({2, 2, 9.5}, 2.6);
  ASSERT_TRUE(near);
  EXPECT_NEAR(near->distance, 2.5, 1e-5);
  EXPECT_NEAR(near->point.z, 7, 1e-5);
}

TEST(Nearest, weighs_triangles_by_what_they_cost_beside_their_distance) {
  const Scene scene(two_storeys({}));
  const auto upper_costs = [](double metres) {
    return [metres](std::uint32_t triangle) { return triangle >= 2 ? metres : 0; };
  };
  EXPECT_GE(scene.nearest({2, 2, 6}, 10, upper_costs(1.9))->triangle, 2U);  // 1 + 1.9 against 3
  EXPECT_LT(scene.nearest({2, 2, 6}, 10, upper_costs(2.1))->triangle, 2U);
  EXPECT_NEAR(scene.nearest({2, 2, 6}, 10, upper_costs(2.1))->distance, 3, 1e-5);
  EXPECT_FALSE(scene.nearest({2, 2, 6.5}, 1, upper_costs(std::numeric_limits<double>::infinity())));
}

TEST(Nearest, takes_the_lower_of_two_triangles_that_are_as_near) {
  // The two triangles of a square share their diagonal.
  const Scene scene(two_storeys({}));
  EXPECT_EQ(scene.nearest({8, 8, 1})->triangle, 0U);
  EXPECT_FALSE(Scene(geometry::Mesh{}).nearest({0, 0, 0}));
}

// A kilometre from the centre floats are 6e-5 m apart: the place is rounded away from the nearer wall.
TEST(Nearest, is_of_the_nearer_triangle_where_floats_have_it_farther) {
  const double far = 1000;
  geometry::Mesh mesh;
  const auto add = [&](geometry::Point3 a, geometry::Point3 b, geometry::Point3 c) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
    mesh.triangles.push_back({first, first + 1, first + 2});
  };
  add({far + 0.5, -9, -9}, {far + 0.5, 9, -9}, {far + 0.5, 0, 9});         // 0.4999696 m off; 0.5 m in floats
  add({far - 9, 0.49998, -9}, {far + 9, 0.49998, -9}, {far, 0.49998, 9});  // 0.49998 m off, in floats too
  add({-far - 9, 0, -9}, {-far - 9, 1, -9}, {-far - 9, 0, 9});             // so that 0 is the centre
  const Scene scene(mesh);
  const auto near = scene.nearest({far + 3.04e-5, 0, 0});
  ASSERT_TRUE(near);
  EXPECT_EQ(near->triangle, 0U);
  EXPECT_TRUE(scene.nearest({far + 3.04e-5, 0, 0}, 0.499975));
}

}  // namespace
}  // namespace mansard::rays
