#include "mansard/align/align.hpp"

#include <gtest/gtest.h>
#include <cmath>

#include "mansard/base/run.hpp"

namespace mansard {
namespace {

using geometry::Point2;
using geometry::Point3;
using geometry::Polygon;

void add_quad(geometry::Mesh& mesh, Point3 a, Point3 b, Point3 c, Point3 d) {
  const auto at = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const auto& p : {a, b, c, d}) mesh.vertices.push_back(p);
  mesh.triangles.push_back({at, at + 1, at + 2});
  mesh.triangles.push_back({at, at + 2, at + 3});
}

Polygon box(double x, double y, double width, double depth) {
  return {{{x, y}, {x + width, y}, {x + width, y + depth}, {x, y + depth}}, {}};
}

/// A street of houses at irregular places, on ground that rises, with a tree beside them.
struct Street {
  geometry::Mesh mesh;
  std::vector<Polygon> footprints;
  explicit Street(std::uint64_t seed, std::size_t houses = 12) {
    base::Random random(seed);
    const auto ground = [](double x, double y) { return 0.15 * x - 0.1 * y; };
    const double length = 25 * static_cast<double>(houses) / 2;
    add_quad(mesh, {-20, -20, ground(-20, -20)}, {length, -20, ground(length, -20)}, {length, 80, ground(length, 80)},
             {-20, 80, ground(-20, 80)});
    for (std::size_t i = 0; i < houses; ++i) {
      const double x = 25.0 * static_cast<double>(i / 2) + random.uniform(0, 8),
                   y = (i % 2 == 0 ? 0.0 : 40.0) + random.uniform(0, 9), width = random.uniform(7, 14),
                   depth = random.uniform(8, 16), z = ground(x, y) + random.uniform(4, 12);
      footprints.push_back(box(x, y, width, depth));
      add_quad(mesh, {x, y, z}, {x + width, y, z}, {x + width, y + depth, z}, {x, y + depth, z});
    }
    add_quad(mesh, {60, 22, 9}, {66, 22, 9}, {66, 28, 9}, {60, 28, 9});
  }
  void move(double x, double y) {
    for (auto& p : mesh.vertices) p.x += x, p.y += y;
  }
};

TEST(BestMatch, finds_the_move_of_a_mesh) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Street street(seed);
    street.move(-84837, -447413);
    const auto match = align::best_match(street.mesh, street.footprints);
    ASSERT_TRUE(match);
    EXPECT_NEAR(match->x, 84837, 1);
    EXPECT_NEAR(match->y, 447413, 1);
    EXPECT_FALSE(match->round);
    EXPECT_GT(match->correlation, 0.8);
    EXPECT_LT(match->next, 0.9 * match->correlation);
    EXPECT_GT(match->inside, 0.8);
  }
}

TEST(BestMatch, takes_the_round_number_that_was_meant) {
  Street street(3);
  street.move(-84800.6, -447399.5);  // a survey that is half a metre off
  const auto match = align::best_match(street.mesh, street.footprints);
  ASSERT_TRUE(match);
  EXPECT_TRUE(match->round);
  EXPECT_EQ(match->x, 84800);
  EXPECT_EQ(match->y, 447400);
}

TEST(BestMatch, finds_a_few_footprints_in_a_large_mesh_and_a_small_mesh_among_many_footprints) {
  Street street(5, 60);
  const std::vector<Polygon> few(street.footprints.begin() + 20, street.footprints.begin() + 32);
  street.move(-1234, 567);
  auto match = align::best_match(street.mesh, few);
  ASSERT_TRUE(match);
  EXPECT_NEAR(match->x, 1234, 1);
  EXPECT_NEAR(match->y, -567, 1);

  Street part(5, 60);
  std::erase_if(part.mesh.triangles, [&](const auto& t) { return part.mesh.vertices[t[0]].x > 300; });
  geometry::Mesh mesh;
  for (const auto& t : part.mesh.triangles) {
    const auto at = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto v : t) {
      auto p = part.mesh.vertices[v];
      if (p.x > 300) p.z -= 0.15 * (p.x - 300);  // along the slope
      p.x = std::min(p.x, 300.0) + 10;
      p.y -= 20;
      mesh.vertices.push_back(p);
    }
    mesh.triangles.push_back({at, at + 1, at + 2});
  }
  match = align::best_match(mesh, part.footprints);
  ASSERT_TRUE(match);
  EXPECT_NEAR(match->x, -10, 1);
  EXPECT_NEAR(match->y, 20, 1);
}

TEST(BestMatch, has_nothing_to_say_without_mesh_or_footprints_or_anything_high) {
  const Street street(1);
  EXPECT_FALSE(align::best_match({}, street.footprints));
  EXPECT_FALSE(align::best_match(street.mesh, {}));
  geometry::Mesh flat;
  add_quad(flat, {0, 0, 0}, {100, 0, 0}, {100, 100, 0}, {0, 100, 0});
  EXPECT_FALSE(align::best_match(flat, street.footprints));
}

TEST(BestMatch, is_the_same_with_any_number_of_threads) {
  Street street(2);
  street.move(77, -300);
  base::limit_threads(1);
  const auto one = align::best_match(street.mesh, street.footprints);
  base::limit_threads(4);
  const auto four = align::best_match(street.mesh, street.footprints);
  base::limit_threads(0);
  ASSERT_TRUE(one && four);
  EXPECT_EQ(one->x, four->x);
  EXPECT_EQ(one->y, four->y);
  EXPECT_EQ(one->correlation, four->correlation);
  EXPECT_EQ(one->next, four->next);
}

TEST(MatchAt, is_high_in_place_and_low_elsewhere) {
  const Street street(4);
  const auto here = align::match_at(street.mesh, street.footprints, 0, 0),
             there = align::match_at(street.mesh, street.footprints, 13, 9);
  ASSERT_TRUE(here && there);
  EXPECT_GT(here->correlation, 0.8);
  EXPECT_LT(there->correlation, 0.4);
  EXPECT_FALSE(align::match_at(street.mesh, street.footprints, 1e6, 0));
}

}  // namespace
}  // namespace mansard
