// Roof steps: lines along which the top surface jumps inside the footprints.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "mansard/rays/rays.hpp"
#include "mansard/sweep/detail/selection.hpp"
#include "mansard/sweep/sweep.hpp"
#include "sweep/town.hpp"

namespace mansard::sweep {
namespace {

auto steps_of(const block::Block& block, const Options& options = {}) -> std::vector<SweepEdge> {
  auto found = with_roof_steps({}, block, rays::Scene(block.mesh), options);
  return found.edges;
}

/// A terrace of two in one feature: the roofs meet at x = 9, neither mesh nor GIS has a wall between them.
auto flats(double step) -> Town {
  Town town(0.05);
  town.ground({-6, -6}, {24, 16});
  town.box({0, 0}, {9, 10}, 0, 6);
  town.box({9, 0}, {18, 10}, 0, 6 + step);
  town.footprint({0, 0}, {18, 10});
  return town;
}

struct Turned {
  double turn = 0;
  [[nodiscard]] auto operator()(Point2 p) const -> Point2 {
    return {std::cos(turn) * p.x - std::sin(turn) * p.y, std::sin(turn) * p.x + std::cos(turn) * p.y};
  }
};

TEST(RoofSteps, are_found_between_flat_roofs_at_any_angle) {
  for (const double turn : {0.0, 0.3, std::numbers::pi / 4, 1.4, 2.5}) {
    const auto steps = steps_of(flats(0.7).block(turn));
    ASSERT_EQ(steps.size(), 1U) << turn;
    const Turned at{turn};
    const Segment2 wall{at({9, 0}), at({9, 10})};
    EXPECT_LT(geometry::distance(wall, steps[0].segment.start), 0.25) << turn;
    EXPECT_LT(geometry::distance(wall, steps[0].segment.end), 0.25) << turn;
    EXPECT_GT(length(steps[0].segment.end - steps[0].segment.start), 9.0) << "it runs up to the outline; " << turn;
    const Point2 outside = geometry::left_of(steps[0].segment.end - steps[0].segment.start);
    EXPECT_GT(dot(outside, at({-1, 0})), 0) << "the lower side is on the left; " << turn;
    EXPECT_EQ(steps[0].evidence, Evidence::roof_step);
    EXPECT_NEAR(steps[0].step, 0.7, 0.2);
    EXPECT_NEAR(steps[0].area, steps[0].step * 10, 3);
  }
}

TEST(RoofSteps, are_found_where_one_roof_changes_to_another) {
  Town town(0.04);
  town.ground({-6, -6}, {24, 16});
  town.gabled({0, 0}, {9, 10}, 5, 7);
  town.gabled({9, 0}, {18, 10}, 5, 9);
  town.footprint({0, 0}, {18, 10});
  const auto steps = steps_of(town.block(0.2));
  const Turned at{0.2};
  const auto is_party_wall = [&](const SweepEdge& e) {
    const Segment2 wall{at({9, 0}), at({9, 10})};
    return geometry::distance(wall, e.segment.start) < 0.3 && geometry::distance(wall, e.segment.end) < 0.3;
  };
  EXPECT_EQ(std::ranges::count_if(steps, is_party_wall), 1);
}

TEST(RoofSteps, are_not_seen_in_one_roof) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    for (const double rise : {0.0, 3.0, 6.0}) {
      Town town(0.06, seed);
      town.ground({-6, -6}, {24, 16});
      town.gabled({0, 0}, {18, 10}, 5, 5 + rise);
      town.footprint({0.2, 0.1}, {18.2, 10.1});
      EXPECT_TRUE(steps_of(town.block(0.1)).empty()) << "seed " << seed << ", rise " << rise;
    }
}

TEST(RoofSteps, are_not_made_of_chimneys_and_small_dormers) {
  Town town(0.05);
  town.ground({-6, -6}, {24, 16});
  town.box({0, 0}, {18, 10}, 0, 6);
  town.box({4, 4}, {5, 5}, 6, 7.5);
  for (const double x : {2.0, 8.0, 14.0}) town.box({x, 7}, {x + 1.5, 8.5}, 6, 7.2);
  town.footprint({0, 0}, {18, 10});
  EXPECT_TRUE(steps_of(town.block(0.4)).empty());
}

TEST(RoofSteps, surround_a_plant_room) {
  Town town(0.05);
  town.ground({-6, -6}, {30, 22});
  town.box({0, 0}, {24, 16}, 0, 9);
  town.box({8, 5}, {14, 10}, 9, 11.5);
  town.footprint({0, 0}, {24, 16});
  const auto steps = steps_of(town.block());
  EXPECT_EQ(steps.size(), 4U);
  for (const auto& e : steps) EXPECT_GT(length(e.segment.end - e.segment.start), 3.9);
}

TEST(RoofSteps, leave_what_a_wall_or_a_footprint_says_already) {
  const auto block = flats(0.7).block();
  SweepEdges walls;
  walls.edges.push_back({{{9.2, 0}, {9.2, 10}}, 20, 6, 8, 0});
  walls.clusters.push_back({{}, 20});
  const auto found = with_roof_steps(walls, block, rays::Scene(block.mesh), {});
  ASSERT_EQ(found.edges.size(), 1U);
  EXPECT_EQ(found.edges[0].evidence, Evidence::wall);

  Town two = flats(0.7);
  two.footprint({9, 0}, {9.1, 10});
  EXPECT_TRUE(steps_of(two.block()).empty());
}

TEST(RoofSteps, have_the_height_and_length_asked_for) {
  const auto block = flats(0.7).block();
  EXPECT_TRUE(steps_of(block, {.step_height = 0}).empty());
  EXPECT_TRUE(steps_of(block, {.step_height = 1.2}).empty());
  EXPECT_EQ(steps_of(block, {.step_height = 0.4}).size(), 1U);
  EXPECT_TRUE(steps_of(block, {.step_length = 12}).empty());
}

/// Steps are whole cells of 0.25 m long, so that many have the least length exactly: rounding must not choose.
TEST(RoofSteps, of_the_least_length_are_found_at_any_angle) {
  for (int turn = 0; turn < 24; ++turn) {
    const auto block = flats(0.7).block(0.1 * turn);
    for (const double length : {9.5, 9.75, 10.0})
      EXPECT_EQ(steps_of(block, {.step_length = length}).size(), steps_of(block, {.step_length = length - 1e-6}).size())
          << length << " m, turned by " << 0.1 * turn;
  }
}

TEST(RoofSteps, stand_among_the_walls_longest_first) {
  const auto block = flats(0.7).block();
  SweepEdges walls;
  walls.edges.push_back({{{0, 10}, {18, 10}}, 100, 0, 6, 0});
  walls.edges.push_back({{{0, 0}, {0, 3}}, 18, 0, 6, 1});
  walls.clusters = {{{}, 100}, {{}, 18}};
  const auto found = with_roof_steps(walls, block, rays::Scene(block.mesh), {});
  ASSERT_EQ(found.edges.size(), 3U);
  EXPECT_EQ(found.edges[1].evidence, Evidence::roof_step);
  EXPECT_EQ(found.clusters.size(), 3U);
  EXPECT_EQ(found.edges[1].cluster, 2U);
  EXPECT_TRUE(found.clusters[2].lines.empty());
}

TEST(RoofSteps, are_the_same_at_any_thread_count) {
  const auto block = flats(0.7).block(0.3);
  const auto all = steps_of(block);
  base::limit_threads(1);
  const auto one = steps_of(block);
  base::limit_threads(0);
  ASSERT_EQ(all.size(), one.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].segment, one[i].segment);
    EXPECT_EQ(all[i].step, one[i].step);
  }
}

TEST(RoofSteps, stop_when_cancelled) {
  const auto block = flats(0.7).block();
  base::Cancel cancel;
  cancel.request();
  base::Run run;
  run.cancel = &cancel;
  EXPECT_TRUE(with_roof_steps({}, block, rays::Scene(block.mesh), {}, run).edges.empty());
}

/// Lengths that a nanometre parts are one length: then the places decide, in centimetres too.
TEST(SweepEdges, are_ordered_by_length_and_place_whatever_a_nanometre_says) {
  std::vector<Segment2> places;
  for (const double x : {3.0, 1.0, 2.0})
    for (const double y : {7.0, 5.0}) places.push_back({{x, y}, {x, y + 10}});
  places.push_back({{9, 0}, {9, 10.1}});
  std::mt19937 chance(7);  // NOLINT(cert-msc51-cpp): the same numbers in every run
  std::uniform_real_distribution<double> off(-1e-9, 1e-9);
  for (int round = 0; round < 50; ++round) {
    std::ranges::shuffle(places, chance);
    std::vector<SweepEdge> edges;
    for (const Segment2& s : places) {
      auto& segment = edges.emplace_back().segment;
      segment = {{s.start.x + off(chance), s.start.y + off(chance)}, {s.end.x + off(chance), s.end.y + off(chance)}};
    }
    detail::sort_longest_first(edges);
    EXPECT_NEAR(edges[0].segment.start.x, 9, 1e-6);
    for (std::size_t i = 1; i < edges.size(); ++i) {
      EXPECT_NEAR(edges[i].segment.start.x, 1.0 + static_cast<double>((i - 1) / 2), 1e-6);
      EXPECT_NEAR(edges[i].segment.start.y, i % 2 == 1 ? 5 : 7, 1e-6);
    }
  }
}

}  // namespace
}  // namespace mansard::sweep
