// Planted blocks through fracture and segment: noisy heights, walls found with errors, lines that are no walls.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <iostream>

#include "mansard/segment/segment.hpp"
#include "planted.hpp"

namespace mansard::segment {
namespace {

using geometry::Point2;

/// Houses back to back in rows, seen with errors, and as many sweep-edges that are no walls.
auto back_to_back(std::size_t houses, std::uint64_t seed) -> planted::Block {
  planted::Recipe recipe;
  recipe.kind = planted::Kind::grid;
  recipe.houses = houses;
  recipe.clutter = 1.2;
  recipe.seed = seed;
  return planted::make(recipe);
}

/// Of a rectangular house.
auto middle(const planted::House& house) -> Point2 { return 0.5 * (house.polygon.outer[0] + house.polygon.outer[2]); }

TEST(MadeBlock, gives_every_house_its_feature_and_every_guarantee) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const planted::Block made = back_to_back(10, seed);
    const Options options;
    const auto arrangement = planted::fractured(made, options);
    const auto s = choose(arrangement, made.edges, made.block, rays::Scene(made.block.mesh), options);
    ASSERT_TRUE(s) << base::to_string(s.error());
    EXPECT_EQ(s->status, "optimal");
    EXPECT_EQ(s->bound, s->objective);
    for (const planted::House& house : made.houses)
      EXPECT_TRUE(std::ranges::any_of(s->parts,
                                      [&](const Part& part) {
                                        return part.feature == house.feature &&
                                               geometry::contains(part.polygon, middle(house));
                                      }))
          << "house " << house.feature << " of seed " << seed;
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
  const planted::Block made = back_to_back(8, 9);
  for (const ThinRule rule : {ThinRule::all, ThinRule::unsupported}) {
    Options options;
    options.thin_rule = rule;
    const auto arrangement = planted::fractured(made, options);
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
  std::cout << "features rule     | inside faces | variables | conflicts | rounds | nodes | status  | gap | seconds\n";
  for (const std::size_t faces : {40U, 150U, 300U, 800U})
    for (const bool one : {true, false})
      for (const ThinRule rule : {ThinRule::unsupported, ThinRule::all})
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
          planted::Recipe recipe = planted::large(faces, seed);
          recipe.features = one ? planted::Features::per_block : planted::Features::per_house;
          const planted::Block made = planted::make(recipe);
          Options options;
          options.thin_rule = rule;
          options.gis_edges = one ? GisEdges::ignore : GisEdges::hard;
          options.seconds = 60;
          const auto arrangement = planted::fractured(made, options);
          const rays::Scene mesh(made.block.mesh);
          const auto start = std::chrono::steady_clock::now();
          const auto s = choose(arrangement, made.edges, made.block, mesh, options).value();
          const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
          const auto inside = std::ranges::count_if(s.faces, &FaceEvidence::inside);
          std::cout << (one ? "ignored " : "hard    ") << (rule == ThinRule::all ? "all         " : "unsupported ")
                    << inside << " | " << s.variables << " | " << s.conflicts.size() << " | " << s.rounds << " | "
                    << s.nodes << " | " << s.status << " | " << s.objective - s.bound << " | " << taken.count() << "\n";
        }
}

}  // namespace
}  // namespace mansard::segment
