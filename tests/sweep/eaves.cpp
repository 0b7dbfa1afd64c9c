// Walls under eaves that end inside of a footprint.
#include "mansard/sweep/detail/eaves.hpp"

#include <gtest/gtest.h>

#include "mansard/geometry/points.hpp"

namespace mansard::sweep::detail {
namespace {

using geometry::Point2;

/// The southern wall of a house of 12 × 8 m whose footprint begins at y = 0, as a sweep-edge `inside` of it.
auto southern_wall(double inside) -> std::vector<SweepEdge> { return {{{{12, inside}, {0, inside}}, 60, 0, 5, 0}}; }

auto block_of_a_house() -> block::Block {
  const geometry::Ring house{{0, 0}, {12, 0}, {12, 8}, {0, 8}};
  block::Block block;
  block.members.push_back({0, {{house, {}}}, 0});
  block.outline.push_back({house, {}});
  return block;
}

/// Level ground, and a roof 6 m above it that begins at y = `eaves`.
auto scan(double eaves) -> rays::Scene {
  geometry::Mesh mesh;
  const auto add = [&mesh](double south, double north, double z) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Point2 p : {Point2{-5, south}, {17, south}, {17, north}, {-5, north}})
      mesh.vertices.push_back({p.x, p.y, z});
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  };
  add(-5, 15, 0);
  add(eaves, 10, 6);
  return rays::Scene(mesh);
}

auto moved_to(double wall, double eaves, const Options& options = {}) -> double {
  const auto edges = moved_under_eaves(southern_wall(wall), block_of_a_house(), {}, scan(eaves), options);
  EXPECT_EQ(edges.size(), 1);
  EXPECT_EQ(edges[0].segment.start.y, edges[0].segment.end.y);
  return edges[0].segment.start.y;
}

TEST(UnderEaves, a_wall_is_where_they_end_as_seen_from_above) {
  EXPECT_NEAR(moved_to(0.8, 0.45), 0.45, 0.05);
  EXPECT_NEAR(moved_to(1.3, 0.3), 0.3, 0.05);
  EXPECT_NEAR(moved_to(0.8, 0.8), 0.8, 0.05) << "no eaves";
}

TEST(UnderEaves, a_wall_near_its_footprint_stays) {
  EXPECT_EQ(moved_to(0.2, 0.1), 0.2);
  EXPECT_EQ(moved_to(1.6, 0.5), 1.6) << "another building's wall";
}

TEST(UnderEaves, a_wall_whose_eaves_end_at_the_footprint_stays) {
  EXPECT_EQ(moved_to(0.8, 0.1), 0.8);
  EXPECT_EQ(moved_to(0.8, -0.5), 0.8);
}

TEST(UnderEaves, nothing_moves_where_walls_are_not_put_on_footprints) {
  EXPECT_EQ(moved_to(0.8, 0.45, {.gis_offset = 0}), 0.8);
  EXPECT_EQ(moved_to(0.8, 0.45, {.eaves_reach = 0}), 0.8);
}

TEST(UnderEaves, footprints_are_where_their_registration_puts_them) {
  const Registration south{{0, -0.7}, 0};
  const auto edges = moved_under_eaves(southern_wall(-0.1), block_of_a_house(), south, scan(-0.4), {});
  EXPECT_NEAR(edges[0].segment.start.y, -0.4, 0.05);
}

}  // namespace
}  // namespace mansard::sweep::detail
