// What refinement sees of the scan.
#include "mansard/refine/detail/site.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mansard/rays/rays.hpp"
#include "mansard/refine/detail/view.hpp"

namespace {

using namespace mansard;

/// 20 m along y of a tower from x = 5 to 15, 24 m high, on a roof of 6 m up to x = 20; its right wall waves by 0.15 m
/// about x = 15.05.
auto waving_tower() -> rays::Scene {
  geometry::Mesh mesh;
  for (const auto& [x, z] : {std::pair{-5.0, 0.0},
                             {0.0, 0.0},
                             {0.0, 6.0},
                             {5.0, 6.0},
                             {5.0, 24.0},
                             {14.9, 24.0},
                             {15.2, 18.0},
                             {14.9, 14.0},
                             {15.2, 10.0},
                             {15.0, 6.0},
                             {20.0, 6.0},
                             {20.0, 0.0},
                             {25.0, 0.0}})
    for (const double y : {-10.0, 10.0}) mesh.vertices.push_back({x, y, z});
  for (std::uint32_t i = 0; i + 2 < mesh.vertices.size(); i += 2) {
    mesh.triangles.push_back({i, i + 2, i + 3});
    mesh.triangles.push_back({i, i + 3, i + 1});
  }
  return rays::Scene(mesh);
}

TEST(Look, takes_the_wall_of_a_tower_where_it_is_on_average) {
  const auto mesh = waving_tower();
  const auto height_at = [](const refine::detail::Site& site, double x, double y) {
    for (std::size_t cell = 0; cell < site.measured.z.size(); ++cell)
      if (const auto at = site.measured.centre(cell); std::abs(at.x - x) < 0.13 && std::abs(at.y - y) < 0.13)
        return site.measured.z[cell];
    return std::nan("");
  };
  refine::Options options;
  const geometry::Polygon west{{{0, -8}, {15.5, -8}, {15.5, 8}, {0, 8}}, {}},
      east{{{15.5, -8}, {20, -8}, {20, 8}, {15.5, 8}}, {}};
  const auto left = refine::detail::look(west, 0, mesh, options), right = refine::detail::look(east, 0, mesh, options);
  for (const auto& site :
       {left, refine::detail::merged(left, right, {{{0, -8}, {20, -8}, {20, 8}, {0, 8}}, {}}, mesh, options)}) {
    EXPECT_NEAR(*mesh.top({15.125, 0.125}), 19.5, 1e-6);
    EXPECT_NEAR(height_at(site, 15.125, 0.125), 6, 1e-9);
    EXPECT_NEAR(height_at(site, 14.875, 0.125), 24, 1e-9);
    EXPECT_NEAR(height_at(site, 15.375, 0.125), 6, 1e-9);
  }
}

TEST(Look, pieces_keep_the_planes_that_the_building_has) {
  const auto mesh = waving_tower();
  const refine::Options options;
  const geometry::Polygon west{{{0, -8}, {10, -8}, {10, 8}, {0, 8}}, {}},
      east{{{10, -8}, {20, -8}, {20, 8}, {10, 8}}, {}}, all{{{0, -8}, {20, -8}, {20, 8}, {0, 8}}, {}};
  refine::detail::Site both[]{refine::detail::look(west, 0, mesh, options),
                              refine::detail::look(east, 0, mesh, options)};
  refine::detail::put_on_planes(both, options);
  const auto& [left, right] = both;
  const auto plane_at = [](const refine::detail::Site& site, double x) {
    for (std::size_t i = 0; i < site.cells.size(); ++i)
      if (std::abs(site.places[i].x - x) < 0.13 && std::abs(site.places[i].y - 0.125) < 0.01) return site.plane_of[i];
    return planes::Found::none;
  };
  const auto tower = plane_at(left, 8), low = plane_at(left, 2), behind = plane_at(right, 18);
  EXPECT_NE(tower, planes::Found::none);
  EXPECT_NE(tower, low);
  EXPECT_NE(tower, behind);
  EXPECT_EQ(plane_at(right, 12), tower) << "it goes on past the line between them";
  const auto whole = refine::detail::merged(left, right, all, mesh, options);
  EXPECT_EQ(whole.plane_of.size(), whole.cells.size());
  EXPECT_EQ(plane_at(whole, 2), low);
  EXPECT_EQ(plane_at(whole, 12), tower);
  EXPECT_EQ(plane_at(whole, 18), behind);
  const auto piece = refine::detail::crop(whole, {{{7, -3}, {13, -3}, {13, 3}, {7, 3}}, {}}, options);
  EXPECT_EQ(plane_at(piece, 8), tower);
  EXPECT_EQ(plane_at(piece, 12), tower);
}

TEST(Look, pieces_know_which_of_their_margins_are_the_building_s) {
  const auto mesh = waving_tower();
  const refine::Options options;
  const geometry::Polygon all{{{0, -8}, {20, -8}, {20, 8}, {0, 8}}, {}}, west{{{0, -8}, {15, -8}, {15, 8}, {0, 8}}, {}},
      east{{{15, -8}, {20, -8}, {20, 8}, {15, 8}}, {}};
  const auto limited = [&](const refine::detail::Site& site, const geometry::Polygon& by) {
    std::size_t count = 0;
    for (std::size_t cell = 0; cell < site.limits.size(); ++cell) {
      if (std::isnan(site.measured.z[cell])) continue;
      const bool near = geometry::boundary_distance(by, site.measured.centre(cell)) < options.margin - 1e-6;
      EXPECT_EQ(std::isfinite(site.limits[cell]), near) << site.measured.centre(cell).x;
      count += near ? 1 : 0;
    }
    return count;
  };
  const auto whole = refine::detail::look(all, 0, mesh, options);
  const auto left = crop(whole, west, options), right = crop(whole, east, options);
  EXPECT_EQ(limited(left, all) + limited(right, all), limited(whole, all));
  EXPECT_GT(limited(right, all), 0U);
  EXPECT_EQ(limited(merged(left, right, all, mesh, options), all), limited(whole, all));
  limited(refine::detail::without(
              left, [](geometry::Point2 at) { return at.x < 3; }, options),
          all);
}

/// A scan of points over 20 m by 12 m: a flat roof of 9 m up to x = 8.1, one of 6 m beside it, the ground around them;
/// between the points of a line 0.3 m apart no wall is seen.
auto two_roofs(double apart = 0.3) -> rays::Scene {
  geometry::Mesh mesh;
  const auto z_at = [](double x, double y) { return x < 0 || x > 20 || y < 0 || y > 12 ? 0.0 : x < 8.1 ? 9.0 : 6.0; };
  for (double x = -4 + apart / 6; x < 24; x += apart)
    for (double y = -4 + apart / 4; y < 16; y += apart) mesh.points.push_back({x, y, z_at(x, y)});
  // The surface that was drawn between them, of coarse cells: its step is 0.6 m beside the roofs'.
  for (const auto& [x, z] :
       {std::pair{-4.0, 0.0}, {0.0, 0.0}, {0.0, 9.0}, {8.7, 9.0}, {8.7, 6.0}, {20.0, 6.0}, {20.0, 0.0}, {24.0, 0.0}})
    for (const double y : {0.0, 12.0}) mesh.vertices.push_back({x, y, z});
  for (std::uint32_t i = 0; i + 2 < mesh.vertices.size(); i += 2) {
    mesh.triangles.push_back({i, i + 2, i + 3});
    mesh.triangles.push_back({i, i + 3, i + 1});
  }
  return rays::Scene(mesh);
}

auto of_points(double apart = 0.3) -> refine::Options {
  refine::Options options;
  options.samples.point_area = apart * apart;
  options.samples.noise = 0.01;
  options.samples.blur = 0;
  options.margin = apart / 2;
  options.samples.margin_weight = 0.05;
  return options;
}

const geometry::Polygon house{{{0, 0}, {20, 0}, {20, 12}, {0, 12}}, {}};

TEST(Points, are_the_samples_where_a_scan_consists_of_them) {
  const auto mesh = two_roofs();
  const auto options = of_points();
  const refine::detail::Evidence points(mesh, options);
  const auto site = refine::detail::look(house, 0, mesh, options, &points);
  ASSERT_TRUE(site.of_points);
  std::size_t inside = 0;
  for (const auto& p : mesh.points_in({{-9, -9}, {99, 99}})) inside += geometry::contains(house, xy(p)) ? 1 : 0;
  EXPECT_EQ(site.z.size(), inside);
  EXPECT_NEAR(static_cast<double>(site.z.size()) * site.sample_area, 240, 240 * 0.03);
  for (std::size_t i = 0; i < site.z.size(); ++i) {
    EXPECT_EQ(site.z[i], site.places[i].x < 8.1 ? 9 : 6);
    EXPECT_EQ(site.weight[i] < 1, geometry::boundary_distance(house, site.places[i]) < 0.15);
  }
  // The step is between the points beside it, not where the surface has it.
  std::size_t compared = 0;
  for (std::size_t cell = 0; cell < site.measured.z.size(); ++cell) {
    const auto at = site.measured.centre(cell);
    if (!geometry::contains(house, at) || geometry::boundary_distance(house, at) < 0.3 || std::abs(at.x - 8.1) < 0.3)
      continue;
    ++compared;
    EXPECT_NEAR(site.measured.z[cell], at.x < 8.1 ? 9 : 6, 1e-6) << at.x;
  }
  EXPECT_GT(compared, 3000U);
}

TEST(Points, of_pieces_are_those_of_the_whole) {
  const auto mesh = two_roofs();
  const auto options = of_points();
  const refine::detail::Evidence points(mesh, options);
  const geometry::Polygon west{{{0, 0}, {8.1, 0}, {8.1, 12}, {0, 12}}, {}},
      east{{{8.1, 0}, {20, 0}, {20, 12}, {8.1, 12}}, {}};
  const auto whole = refine::detail::look(house, 0, mesh, options, &points);
  const auto a = crop(whole, west, options), b = crop(whole, east, options);
  EXPECT_EQ(a.z.size() + b.z.size(), whole.z.size());
  EXPECT_EQ(std::ranges::max(b.z), 6);
  EXPECT_EQ(std::ranges::min(a.z), 9);
  const auto again = merged(a, b, house, mesh, options, &points);
  EXPECT_EQ(again.z.size(), whole.z.size());
  const auto without = refine::detail::without(
      whole, [](geometry::Point2 at) { return at.x < 8.1; }, options);
  EXPECT_EQ(without.z.size(), b.z.size());
  EXPECT_LT(without.seen_area(), 0.62 * whole.seen_area());
}

TEST(Points, on_walls_are_no_samples) {
  geometry::Mesh mesh;
  for (double x = 0.1; x < 10; x += 0.3)
    for (double y = 0.1; y < 10; y += 0.3) mesh.points.push_back({x, y, y < 5 ? 8.0 : 3.0});
  const auto roofs = mesh.points.size();
  for (double x = 0.05; x < 10; x += 0.7)
    for (double z = 3.6; z < 7.5; z += 0.5) mesh.points.push_back({x, 5.0, z});
  mesh.vertices = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}};
  mesh.triangles = {{0, 1, 2}};
  const refine::detail::Evidence points(rays::Scene(mesh), of_points());
  EXPECT_EQ(points.in({{-1, -1}, {11, 11}}).size(), roofs);
}

TEST(Points, beside_a_step_are_over_the_face_that_they_lie_on) {
  const auto mesh = two_roofs();
  const auto options = of_points();
  const refine::detail::Evidence points(mesh, options);
  const auto site = refine::detail::look(house, 0, mesh, options, &points);
  // The same two roofs as a solid seen from above.
  model::Solid solid;
  solid.vertices = {{0, 0, 9},   {8.1, 0, 9}, {8.1, 12, 9}, {0, 12, 9},
                    {8.1, 0, 6}, {20, 0, 6},  {20, 12, 6},  {8.1, 12, 6}};
  for (const std::uint32_t first : {0U, 4U}) {
    model::Face face;
    face.loops = {{first, first + 1, first + 2, first + 3}};
    face.normal = {0, 0, 1};
    solid.faces.push_back(face);
  }
  const auto view = refine::detail::view_of(solid, site);
  ASSERT_EQ(view.z_at.size(), site.z.size());
  for (std::size_t i = 0; i < site.z.size(); ++i) {
    EXPECT_EQ(view.z_of(site, i), site.z[i]);
    EXPECT_EQ(view.face_of(site, i), site.z[i] == 9 ? 0U : 1U);
  }
}

}  // namespace
