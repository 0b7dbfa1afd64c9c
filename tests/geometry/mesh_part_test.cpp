// Some triangles of a mesh.
#include "mansard/geometry/mesh_part.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mansard/base/run.hpp"

namespace mansard::geometry {
namespace {

using testing::ElementsAre;

/// Four triangles around the middle of a square; vertex 5 is of none.
auto square() -> Mesh {
  return {{{0, 0, 1}, {2, 0, 2}, {2, 2, 3}, {0, 2, 4}, {1, 1, 5}, {9, 9, 9}},
          {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
}

TEST(MeshPart, has_the_triangles_in_their_order_and_the_vertices_they_use_in_the_meshs) {
  const auto mesh = square();
  const std::uint32_t some[]{2, 1};
  const auto part = part_of(mesh, some);
  EXPECT_THAT(part.vertices, ElementsAre(mesh.vertices[1], mesh.vertices[2], mesh.vertices[3], mesh.vertices[4]));
  EXPECT_THAT(part.triangles, ElementsAre(Triangle{1, 2, 3}, Triangle{0, 1, 3}));
  EXPECT_TRUE(part_of(mesh, {}).vertices.empty());
}

TEST(MeshPart, without_some_keeps_the_others_and_all_vertices) {
  const auto mesh = square();
  const std::uint32_t some[]{0, 3};
  const auto rest = without(mesh, some);
  EXPECT_EQ(rest.vertices, mesh.vertices);
  EXPECT_THAT(rest.triangles, ElementsAre(mesh.triangles[1], mesh.triangles[2]));
  EXPECT_EQ(without(mesh, {}).triangles, mesh.triangles);
}

TEST(MeshPart, triangles_near_boxes_are_those_that_a_look_at_each_finds) {
  base::Random random(3);
  Mesh mesh;
  mesh.vertices.resize(std::size_t{3} * 40'000);  // more than one piece of those that are looked at together
  for (std::uint32_t i = 0; i < mesh.vertices.size(); i += 3) {
    const double y = random.uniform(-50, 250), x = random.uniform(-50, 350);
    for (std::uint32_t k = 0; k < 3; ++k)
      mesh.vertices[i + k] = {x + random.uniform(0, 3), y + random.uniform(0, 3), random.uniform(0, 9)};
    mesh.triangles.push_back({i, i + 1, i + 2});
  }
  std::vector<Box2> boxes(1);  // the first is empty
  for (int k = 0; k < 30; ++k) {
    const Point2 least{random.uniform(0, 300), random.uniform(0, 200)};
    boxes.push_back({least, least + Point2{random.uniform(0, k == 3 ? 200 : 9), random.uniform(0, 9)}});
  }
  const auto near = triangles_near(mesh, boxes);
  ASSERT_EQ(near.size(), boxes.size());
  EXPECT_TRUE(near.front().empty());
  std::size_t all = 0;
  for (std::size_t b = 1; b < boxes.size(); ++b) {
    std::vector<std::uint32_t> slow;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      Box2 box;
      for (const auto v : mesh.triangles[t]) box.add(xy(mesh.vertices[v]));
      if (box.overlaps(boxes[b])) slow.push_back(t);
    }
    EXPECT_EQ(near[b], slow) << b;
    all += slow.size();
  }
  EXPECT_GT(all, 300U);
  const auto points = points_near(mesh.vertices, boxes);
  ASSERT_EQ(points.size(), boxes.size());
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    std::vector<std::uint32_t> slow;
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
      if (!boxes[b].empty() && boxes[b].contains(xy(mesh.vertices[v]))) slow.push_back(v);
    EXPECT_EQ(points[b], slow) << b;
  }
  EXPECT_TRUE(triangles_near({}, boxes)[1].empty());
  EXPECT_TRUE(triangles_near(mesh, {}).empty());
}

}  // namespace
}  // namespace mansard::geometry
