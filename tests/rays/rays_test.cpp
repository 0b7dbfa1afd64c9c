#include "mansard/rays/rays.hpp"

#include <gtest/gtest.h>

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
  EXPECT_FALSE(scene.cast({0, 0, 0}, {1, 0, 0}));
}

}  // namespace
}  // namespace mansard::rays
