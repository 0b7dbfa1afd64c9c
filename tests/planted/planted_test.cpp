// The planted blocks are what their recipes say.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "planted.hpp"

namespace mansard::planted {
namespace {

using geometry::Point2;
using ::testing::AllOf;
using ::testing::Ge;
using ::testing::Le;

auto length(const geometry::Segment2& s) -> double { return geometry::length(s.end - s.start); }

auto inside_faces(const Block& planted) -> std::size_t {
  segment::Options options;
  options.seconds = 0;  // the faces are measured; how they are joined does not matter here
  options.nodes = 0;
  const auto arrangement = fractured(planted, options);
  const auto s = segment::choose(arrangement, planted.edges, planted.block, rays::Scene(planted.block.mesh), options);
  return static_cast<std::size_t>(std::ranges::count_if(s.value().faces, &segment::FaceEvidence::inside));
}

/// A terrace that is seen without an error.
auto flawless() -> Recipe {
  Recipe r;
  r.houses = 6;
  r.height_sigma = r.melt = r.lateral = r.angle = r.missing = r.twice = r.broken = r.shorter = r.clutter = r.gis = 0;
  return r;
}

TEST(Presets, have_the_sizes_of_the_papers_blocks) {
  struct Size {
    std::string name;
    std::size_t edges_least, edges_most, faces_least, faces_most;
  };
  // Sweep-edges as in table 1; faces from its numbers of variables, 46 a face, and more where GIS edges cut too.
  for (const Size& size :
       {Size{"glasgow_small", 7, 13, 4, 25}, Size{"madrid", 22, 36, 45, 95}, Size{"copenhagen", 28, 46, 35, 90},
        Size{"glasgow", 37, 56, 60, 160}, Size{"london", 56, 84, 150, 270}, Size{"new_york", 28, 46, 230, 430}})
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const Block planted = make(preset(size.name, seed));
      EXPECT_THAT(planted.edges.edges.size(), AllOf(Ge(size.edges_least), Le(size.edges_most)))
          << size.name << " of seed " << seed;
      EXPECT_THAT(inside_faces(planted), AllOf(Ge(size.faces_least), Le(size.faces_most)))
          << size.name << " of seed " << seed;
    }
}

TEST(Large, has_about_as_many_faces_as_asked_for_in_one_feature) {
  for (const std::size_t faces : {500U, 1000U, 2000U, 3000U}) {
    const Block planted = make(large(faces, 1));
    EXPECT_EQ(planted.block.members.size(), 1U);
    EXPECT_NEAR(static_cast<double>(inside_faces(planted)) / static_cast<double>(faces), 1, 0.15) << faces;
  }
}

TEST(Planted, is_the_same_again_and_another_with_another_seed) {
  const Block one = make(preset("madrid", 3)), again = make(preset("madrid", 3)), other = make(preset("madrid", 4));
  EXPECT_EQ(one.block.mesh.vertices, again.block.mesh.vertices);
  ASSERT_EQ(one.edges.edges.size(), again.edges.edges.size());
  for (std::size_t k = 0; k < one.edges.edges.size(); ++k)
    EXPECT_EQ(one.edges.edges[k].segment, again.edges.edges[k].segment);
  EXPECT_NE(one.block.mesh.vertices, other.block.mesh.vertices);
}

TEST(Planted, has_simple_houses_that_do_not_overlap_in_every_kind) {
  for (const Kind kind : {Kind::terrace, Kind::perimeter, Kind::courtyard, Kind::towers, Kind::detached, Kind::grid}) {
    Recipe recipe;
    recipe.kind = kind;
    recipe.houses = 13;
    recipe.wings = 1;
    const Block planted = make(recipe);
    EXPECT_GE(planted.houses.size(), recipe.houses - 1);
    std::vector<geometry::Polygon> polygons;
    double sum = 0;
    for (const House& h : planted.houses) {
      EXPECT_TRUE(geometry::is_simple(h.polygon));
      EXPECT_GT(geometry::area(h.polygon), 5);
      sum += geometry::area(h.polygon);
      polygons.push_back(h.polygon);
    }
    const auto together = geometry::unite(polygons).value();
    double covered = 0;
    for (const auto& p : together) covered += geometry::area(p);
    EXPECT_NEAR(covered, sum, 1e-6 * sum) << "kind " << static_cast<int>(kind);
  }
}

TEST(Planted, knows_every_wall_between_two_houses_once_with_its_step) {
  const Block planted = make(flawless());
  for (const Wall& w : planted.walls) {
    const Point2 middle = 0.5 * (w.segment.start + w.segment.end);
    const Point2 left = 0.01 * geometry::normalised(geometry::left_of(w.segment.end - w.segment.start));
    EXPECT_TRUE(geometry::contains(planted.houses[w.left].polygon, middle + left));
    EXPECT_TRUE(geometry::contains(planted.houses[w.right].polygon, middle - left));
  }
  // Six houses in a row: five party walls, and one to every wing.
  EXPECT_EQ(planted.walls.size(), planted.houses.size() - 1);
}

TEST(Planted, without_an_error_every_wall_that_can_be_seen_has_a_sweep_edge_on_it_facing_the_lower_side) {
  const Recipe recipe = flawless();
  const Block planted = make(recipe);
  std::size_t seen = 0;
  for (const Wall& w : planted.walls) {
    const Point2 middle = 0.5 * (w.segment.start + w.segment.end);
    const Point2 up = (w.step > 0 ? 1 : -1) * geometry::left_of(w.segment.end - w.segment.start);
    const bool on_one = std::ranges::any_of(planted.edges.edges, [&](const sweep::SweepEdge& e) {
      const Point2 along = e.segment.end - e.segment.start;
      return geometry::distance(e.segment, middle) < 0.3 && geometry::dot(geometry::left_of(along), up) < 0 &&
             std::abs(geometry::cross(geometry::normalised(along), geometry::normalised(up))) > 0.99;
    });
    const bool visible = std::abs(w.step) >= recipe.seen_step && std::abs(w.step) * length(w.segment) >= recipe.gamma;
    EXPECT_EQ(on_one, visible) << "wall between " << w.left << " and " << w.right;
    seen += visible ? 1U : 0U;
  }
  EXPECT_GT(seen, 0U);
  EXPECT_LT(seen, planted.walls.size());
}

TEST(Planted, sees_walls_not_at_all_or_twice_or_in_two_pieces_as_often_as_asked) {
  const Recipe recipe = flawless();
  const std::size_t walls = make(recipe).edges.edges.size();
  const auto edges_with = [&](double Recipe::*probability) {
    Recipe worse = recipe;
    worse.*probability = 1;
    return make(worse).edges.edges;
  };
  EXPECT_EQ(edges_with(&Recipe::missing).size(), 0U);
  EXPECT_GT(edges_with(&Recipe::twice).size(), walls + walls / 2) << "all but those that gamma drops";
  EXPECT_GT(edges_with(&Recipe::broken).size(), walls + walls / 2);
  double whole = 0, shorter = 0;
  for (const auto& e : make(recipe).edges.edges) whole += length(e.segment);
  for (const auto& e : edges_with(&Recipe::shorter)) shorter += length(e.segment);
  EXPECT_LT(shorter, whole - 0.3 * static_cast<double>(walls));
  EXPECT_GT(shorter, whole - 1.5 * static_cast<double>(walls) - 3);
  Recipe cluttered = recipe;
  cluttered.clutter = 2;
  EXPECT_NEAR(static_cast<double>(make(cluttered).edges.edges.size()), static_cast<double>(walls + 12), 2);
}

TEST(Planted, gives_neighbours_equal_heights_as_often_as_asked) {
  Recipe recipe = flawless();
  recipe.houses = 200;
  recipe.wings = 0;
  for (const double equal : {0.0, 0.4, 1.0}) {
    recipe.equal = equal;
    const auto walls = make(recipe).walls;
    const auto level = std::ranges::count_if(walls, [](const Wall& w) { return std::abs(w.step) < 0.2; });
    // Roofs of different kinds may happen to balance each other, and setbacks shift a pitched roof.
    EXPECT_NEAR(static_cast<double>(level) / static_cast<double>(walls.size()), equal, 0.15) << equal;
  }
}

TEST(Planted, displaces_footprints_as_far_as_asked) {
  Recipe recipe = flawless();
  recipe.wings = 0;
  const auto off = [](const Block& planted) {
    double most = 0;
    for (const House& h : planted.houses)
      for (const Point2 p : h.polygon.outer)
        most = std::max(most, geometry::boundary_distance(planted.block.members[h.feature].polygons[0], p));
    return most;
  };
  EXPECT_LT(off(make(recipe)), 1e-9);
  recipe.gis = 0.2;
  EXPECT_GT(off(make(recipe)), 0.02);
  EXPECT_LT(off(make(recipe)), 1.2);
}

TEST(Planted, gives_sweep_edges_longest_first_and_none_under_gamma) {
  const Block planted = make(preset("london", 1));
  for (std::size_t k = 1; k < planted.edges.edges.size(); ++k)
    EXPECT_GE(length(planted.edges.edges[k - 1].segment), length(planted.edges.edges[k].segment));
  for (const auto& e : planted.edges.edges) EXPECT_GE(e.area, Recipe{}.gamma);
}

TEST(Planted, scans_the_roofs_it_planted) {
  Recipe recipe = flawless();
  const auto worst = [](const Block& planted) {
    const rays::Scene mesh(planted.block.mesh);
    double error = 0;
    for (const House& h : planted.houses) {
      Point2 middle{0, 0};
      for (const Point2 p : h.polygon.outer) middle = middle + 0.25 * p;
      if (std::abs(geometry::dot(h.across, middle) - (h.least + h.most) / 2) < 1) middle = middle + 1.5 * h.across;
      error = std::max(error, std::abs(mesh.top(middle).value() - top(h, middle)));
    }
    return error;
  };
  EXPECT_LT(worst(make(recipe)), 0.01);
  recipe.height_sigma = 0.3;
  EXPECT_GT(worst(make(recipe)), 0.05);
}

}  // namespace
}  // namespace mansard::planted
