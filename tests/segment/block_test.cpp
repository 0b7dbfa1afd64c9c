// Made-up terraces through fracture and segment: noisy heights, walls found with errors, roof steps that are no walls.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <iostream>

#include "mansard/segment/segment.hpp"

namespace mansard::segment {
namespace {

using geometry::Point2;

struct MadeBlock {
  block::Block block;
  sweep::SweepEdges edges;
  std::vector<Point2> middles;  ///< of the houses
};

/// Houses in rows of different depth and height, one GIS feature per `houses_per_feature`; walls between them seen by
/// the sweep with an error of some centimetres, `clutter` more lines that are no walls.
auto made_block(int columns, int rows, int houses_per_feature, int clutter, std::uint64_t seed) -> MadeBlock {
  base::Random random(seed);
  MadeBlock made;
  made.block.name = "block-0";
  constexpr double depth = 12, step = 0.5;
  std::vector<double> at{0};
  for (int c = 0; c < columns; ++c) at.push_back(at.back() + 6 + std::floor(8 * random.uniform()) / 2);
  std::vector<std::vector<double>> height(static_cast<std::size_t>(rows));
  for (auto& row : height)
    for (int c = 0; c < columns; ++c) row.push_back(6 + 12 * random.uniform());

  // 2.5-D scan: a vertex every half metre, ground around.
  const int nx = static_cast<int>((at.back() + 10) / step), ny = static_cast<int>((rows * depth + 10) / step);
  const auto top = [&](double x, double y) {
    if (x < 0 || y < 0 || x >= at.back() || y >= rows * depth) return 0.0;
    const auto c = static_cast<std::size_t>(std::ranges::upper_bound(at, x) - at.begin() - 1);
    return height[static_cast<std::size_t>(y / depth)][c];
  };
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) {
      const double x = -5 + step * i, y = -5 + step * j;
      made.block.mesh.vertices.push_back({x, y, top(x, y) + random.uniform(-0.1, 0.1)});
    }
  const auto id = [&](int i, int j) { return static_cast<std::uint32_t>(j * (nx + 1) + i); };
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      made.block.mesh.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      made.block.mesh.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }

  int house = 0;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c, ++house) {
      if (c % houses_per_feature == 0) made.block.members.push_back({made.block.members.size(), {}, 0});
      const double x = at[static_cast<std::size_t>(c)], to = at[static_cast<std::size_t>(c) + 1], y = depth * r;
      made.block.members.back().polygons.push_back({{{x, y}, {to, y}, {to, y + depth}, {x, y + depth}}, {}});
      made.middles.push_back({(x + to) / 2, y + depth / 2});
    }

  const auto wall = [&](Point2 a, Point2 b) {
    const Point2 off = random.uniform(-0.15, 0.15) * geometry::normalised(geometry::left_of(b - a));
    made.edges.edges.push_back({{a + off, b + off}, 50, 0, 8, 0});
  };
  for (int r = 0; r <= rows; ++r) wall({at.back(), depth * r}, {0, depth * r});
  wall({0, 0}, {0, depth * rows});
  wall({at.back(), depth * rows}, {at.back(), 0});
  for (int r = 0; r < rows; ++r)
    for (std::size_t c = 1; c + 1 < at.size(); ++c) {
      const double left = height[static_cast<std::size_t>(r)][c - 1], right = height[static_cast<std::size_t>(r)][c];
      if (std::abs(left - right) < 2) continue;  // the sweep sees no wall that low
      if (left > right) wall({at[c], depth * (r + 1)}, {at[c], depth * r});
      else wall({at[c], depth * r}, {at[c], depth * (r + 1)});
    }
  for (int k = 0; k < clutter; ++k) {
    const Point2 a{random.uniform(0, at.back()), random.uniform(0, rows * depth)};
    const double quarter = std::acos(-1.0) / 2;
    const double turn = (random.uniform() < 0.7 ? std::floor(4 * random.uniform()) : 4 * random.uniform()) * quarter;
    wall(a, a + random.uniform(2, 7) * Point2{std::cos(turn), std::sin(turn)});
  }
  std::ranges::sort(made.edges.edges, [](const sweep::SweepEdge& a, const sweep::SweepEdge& b) {
    const auto l = [](const sweep::SweepEdge& e) { return geometry::length(e.segment.end - e.segment.start); };
    return std::tuple(-l(a), a.segment.start) < std::tuple(-l(b), b.segment.start);
  });
  return made;
}

auto fractured(const MadeBlock& made, const Options& options) -> fracture::Arrangement {
  geometry::Box2 region;
  for (const auto& m : made.block.members)
    for (const auto& p : m.polygons)
      for (const Point2 q : p.outer) region.add(q);
  return fracture::arrange(cuts_of(made.edges, made.block, options), region, {}).value();
}

TEST(MadeBlock, gives_every_house_its_feature_and_every_guarantee) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const MadeBlock made = made_block(5, 2, 1, 12, seed);
    const Options options;
    const auto arrangement = fractured(made, options);
    const auto s = choose(arrangement, made.edges, made.block, rays::Scene(made.block.mesh), options);
    ASSERT_TRUE(s) << base::to_string(s.error());
    EXPECT_EQ(s->status, "optimal");
    EXPECT_EQ(s->bound, s->objective);
    for (std::size_t house = 0; house < made.middles.size(); ++house) {
      bool found = false;
      for (const Part& part : s->parts)
        if (part.feature == house && geometry::contains(part.polygon, made.middles[house])) found = true;
      EXPECT_TRUE(found) << "house " << house << " of seed " << seed;
    }
    for (const Part& part : s->parts) EXPECT_TRUE(geometry::is_simple(part.polygon));
    for (const Candidate& c : s->candidates) EXPECT_EQ(c.chosen, s->part_of_face[c.left] != s->part_of_face[c.right]);
    // Straightening may let neighbours overlap by a centimetre along a wall.
    for (std::size_t a = 0; a < s->parts.size(); ++a)
      for (std::size_t b = a + 1; b < s->parts.size(); ++b) {
        const auto common = geometry::intersect(s->parts[a].polygon, s->parts[b].polygon);
        ASSERT_TRUE(common);
        for (const auto& piece : *common) EXPECT_LT(geometry::area(piece), 0.01 * geometry::perimeter(piece.outer));
      }
  }
}

TEST(MadeBlock, is_the_same_by_both_presets_of_the_thin_rule_at_any_thread_count) {
  const MadeBlock made = made_block(4, 2, 2, 10, 9);
  for (const ThinRule rule : {ThinRule::all, ThinRule::unsupported}) {
    Options options;
    options.thin_rule = rule;
    const auto arrangement = fractured(made, options);
    const rays::Scene mesh(made.block.mesh);
    const auto one = choose(arrangement, made.edges, made.block, mesh, options).value();
    base::limit_threads(1);
    const auto two = choose(arrangement, made.edges, made.block, mesh, options).value();
    base::limit_threads(0);
    EXPECT_EQ(one.objective, two.objective);
    EXPECT_EQ(one.part_of_face, two.part_of_face);
    ASSERT_EQ(one.parts.size(), two.parts.size());
    for (std::size_t p = 0; p < one.parts.size(); ++p) EXPECT_EQ(one.parts[p].polygon, two.parts[p].polygon);
  }
}

/// The table of docs/segment.md:
/// test_segment --gtest_also_run_disabled_tests --gtest_filter='*measures_time*'
TEST(MadeBlock, DISABLED_measures_time_by_size) {
  struct Size {
    int columns, rows, per_feature, clutter;
  };
  std::cout << "features rule     | inside faces | variables | conflicts | rounds | nodes | status  | gap | seconds\n";
  for (const Size size : {Size{4, 2, 4, 14}, {6, 3, 6, 40}, {8, 4, 8, 75}, {12, 5, 12, 220}})
    for (const bool one : {true, false})
      for (const ThinRule rule : {ThinRule::unsupported, ThinRule::all})
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
          const MadeBlock made = made_block(size.columns, size.rows, one ? size.per_feature : 1, size.clutter, seed);
          Options options;
          options.thin_rule = rule;
          options.gis_edges = one ? GisEdges::ignore : GisEdges::hard;
          options.seconds = 60;
          const auto arrangement = fractured(made, options);
          const rays::Scene mesh(made.block.mesh);
          const auto start = std::chrono::steady_clock::now();
          const auto s = choose(arrangement, made.edges, made.block, mesh, options).value();
          const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
          const auto inside = std::ranges::count_if(s.faces, &FaceEvidence::inside);
          std::cout << (one ? "ignored " : "hard    ") << (rule == ThinRule::all ? "all         " : "unsupported ")
                    << inside << " | " << s.variables << " | " << s.conflicts.size() << " | " << s.rounds << " | " << s.nodes << " | "
                    << s.status << " | " << s.objective - s.bound << " | " << taken.count() << "\n";
        }
}

}  // namespace
}  // namespace mansard::segment
