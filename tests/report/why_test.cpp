// The sentences that say why an edge was cut or not.
#include "mansard/report/detail/why.hpp"

#include <gmock/gmock.h>
#include <array>

namespace mansard::report {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

/// In the order: unsupported, conflicts with the outline, unused sweep-edge, height, unused GIS edge.
auto candidate(bool solved, std::array<double, 5> costs) -> segment::Candidate {
  using enum segment::Term;
  segment::Candidate c;
  c.length = 12;
  c.amounts.values.fill(12);
  c.amounts[height] = 8;
  c.solved = c.chosen = solved;
  c.costs[unsupported] = costs[0], c.costs[thin] = costs[1], c.costs[sweep_unused] = costs[2];
  c.costs[height] = costs[3], c.costs[gis_unused] = costs[4];
  return c;
}

TEST(Why, weighs_what_was_done_against_what_was_not) {
  EXPECT_EQ(detail::why(candidate(true, {0, 0, 480, 0, 0}), {0, 100}),
            "cut: joining costs 480 for leaving 12.0 m of sweep-edge unused; cutting costs nothing");
  EXPECT_EQ(
      detail::why(candidate(false, {720, 0, 0, 96, 0}), {0, 100}),
      "not cut: cutting costs 720 for 12.0 m without a sweep-edge; joining costs 96 for the height step of 8.0 m");
  EXPECT_EQ(detail::why(candidate(false, {0, 0, 0, 0, 0}), {0, 100}),
            "not cut: cutting costs nothing; joining costs nothing");
  EXPECT_EQ(detail::why(candidate(true, {0, 0, 0, 0.01, 0}), {0, 100}),
            "cut: joining costs under 0.1 for the height step of 8.0 m; cutting costs nothing");
}

TEST(Why, adds_up_several_costs) {
  EXPECT_EQ(detail::why(candidate(true, {0, 0, 0, 4.26, 120}), {0, 100}),
            "cut: joining costs 124 = 4.3 for the height step of 8.0 m + 120 for leaving 12.0 m of GIS edge unused; "
            "cutting costs nothing");
}

TEST(Why, says_when_other_edges_decided) {
  EXPECT_EQ(detail::why(candidate(true, {720, 0, 0, 96, 0}), {0, 100}),
            "cut though dearer by itself: cutting costs 720 for 12.0 m without a sweep-edge; joining costs 96 for the "
            "height step of 8.0 m; its ends need a wall");
  EXPECT_EQ(detail::why(candidate(false, {0, 0, 480, 0, 0}), {0, 100}),
            "not cut though cheaper by itself: cutting costs nothing; joining costs 480 for leaving 12.0 m of "
            "sweep-edge unused; the walls that its ends need cost more");
}

TEST(Why, names_a_sweep_edge_beside_the_edge_and_what_became_of_it) {
  EXPECT_THAT(detail::why(candidate(false, {720, 0, 0, 96, 0}), {0, 100, 0.324, {}}),
              EndsWith("; a sweep-edge runs parallel to it, 0.32 m away"));
  const auto later = [](detail::Later what) {
    return detail::why(candidate(true, {0, 0, 480, 0, 0}), {0, 100, {}, what});
  };
  EXPECT_THAT(later({12, 0, 0, 0}), EndsWith("; refinement kept it"));
  EXPECT_THAT(later({0, 12, 0, 0.4}), EndsWith("; refinement moved it by 0.40 m"));
  EXPECT_THAT(later({0, 0, 12, 0}), EndsWith("; refinement dropped it"));
  EXPECT_THAT(later({4, 6, 2, 0.25}), EndsWith("; refinement kept 4.0 m, moved 6.0 m by 0.25 m, dropped 2.0 m"));
}

TEST(ParallelSweepEdge, is_beside_most_of_the_edge) {
  const std::vector<geometry::Segment2> edge{{{0, 0}, {10, 0}}};
  const auto beside = [&](geometry::Segment2 sweep_edge) {
    sweep::SweepEdge one;
    one.segment = sweep_edge;
    return detail::parallel_sweep_edge(edge, std::vector{one});
  };
  EXPECT_NEAR(beside({{10, 0.3}, {0, 0.3}}).value(), 0.3, 1e-9);
  EXPECT_FALSE(beside({{10, 0.6}, {0, 0.6}})) << "too far";
  EXPECT_FALSE(beside({{0, 0.3}, {4, 0.3}})) << "along less than half of it";
  EXPECT_FALSE(beside({{5, -5}, {5, 5}})) << "across";
}

/// A building with a part over each rectangle.
auto building(const std::vector<geometry::Box2>& boxes) -> model::Building {
  model::Building out;
  for (const auto& box : boxes) {
    model::Part part;
    part.plan.outer.points = {box.least, {box.most.x, box.least.y}, box.most, {box.least.x, box.most.y}};
    part.plan.outer.profile_of_edge = {0, 0, 0, 0};
    out.parts.push_back(std::move(part));
  }
  return out;
}

TEST(FinalWalls, tell_what_became_of_a_wall) {
  const std::vector<geometry::Segment2> wall{{{5, 0}, {5, 8}}};
  const auto later = [&](const std::vector<geometry::Box2>& boxes) {
    const std::vector<model::Building> all{building(boxes)};
    return detail::FinalWalls(all).later(wall);
  };
  const auto kept = later({{{0, 0}, {5.03, 8}}, {{5.03, 0}, {12, 8}}});
  EXPECT_NEAR(kept.kept, 8, 1e-9);
  const auto moved = later({{{0, 0}, {5.7, 8}}, {{5.7, 0}, {12, 8}}});
  EXPECT_NEAR(moved.moved, 8, 1e-9);
  EXPECT_NEAR(moved.by, 0.7, 1e-9);
  const auto dropped = later({{{0, 0}, {6, 8}}});
  EXPECT_NEAR(dropped.dropped, 8, 1e-9) << "the outer wall a metre beside it is another one";
  const auto half = later({{{0, 0}, {5, 4}}, {{5, 0}, {12, 4}}, {{0, 4}, {12, 8}}});
  EXPECT_NEAR(half.kept, 4, 1e-9);
  EXPECT_NEAR(half.dropped + half.moved, 4, 1e-9);
  EXPECT_NEAR(later({}).dropped, 8, 1e-9);
}

TEST(Why, counts_conflicts_with_the_outline_and_with_other_walls) {
  EXPECT_EQ(detail::why(candidate(false, {0, 500, 480, 0, 0}), {0, 100}),
            "not cut: cutting costs 500 for its conflict with the outline; joining costs 480 for leaving 12.0 m of "
            "sweep-edge unused");
  EXPECT_EQ(detail::why(candidate(false, {0, 0, 480, 0, 0}), {1, 500}),
            "not cut: cutting costs 500 for its conflict with another wall; joining costs 480 for leaving 12.0 m of "
            "sweep-edge unused");
  EXPECT_THAT(
      detail::why(candidate(true, {0, 0, 480, 0, 0}), {3, 500}),
      HasSubstr("dearer by itself: cutting costs 1500 for its conflicts with 3 other walls; joining costs 480"));
  segment::Segmentation s;
  s.candidates = {candidate(true, {}), candidate(false, {}), candidate(true, {})};
  s.conflicts = {{0, std::nullopt}, {0, 1}, {1, 2}};
  EXPECT_THAT(detail::walls_in_conflict(s), testing::ElementsAre(0, 2, 0));
}

TEST(Why, says_when_features_or_small_parts_decided) {
  auto c = candidate(true, {720, 0, 0, 0, 0});
  c.forced = true;
  EXPECT_EQ(detail::why(c, {0, 100}), "cut: between two features");
  c.chosen = false;
  EXPECT_EQ(detail::why(c, {0, 100}),
            "cut by the program, but one side is too small or narrow for a part: joined or left out");
}

}  // namespace
}  // namespace mansard::report
