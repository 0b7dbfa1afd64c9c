// What refinement sees of the scan.
#include "mansard/refine/detail/site.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mansard/rays/rays.hpp"

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

}  // namespace
