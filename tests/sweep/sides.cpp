// Alignment, weights, clusters and bases, each alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mansard/sweep/detail/alignment.hpp"
#include "mansard/sweep/detail/bases.hpp"
#include "mansard/sweep/detail/clusters.hpp"
#include "sweep/town.hpp"

namespace mansard::sweep::detail {
namespace {

auto turned(Segment2 s, double by) -> Segment2 {
  const Point2 m = 0.5 * (s.start + s.end), h = 0.5 * (s.end - s.start);
  const Point2 d{std::cos(by) * h.x - std::sin(by) * h.y, std::sin(by) * h.x + std::cos(by) * h.y};
  return {m - d, m + d};
}

auto square_block() -> block::Block {
  Town town;
  town.footprint({0, 0}, {20, 20});
  return town.block();
}

auto angle_between(Segment2 a, Segment2 b) -> double {
  const Point2 u = a.end - a.start, v = b.end - b.start;
  return std::abs(std::atan2(cross(u, v), dot(u, v)));
}

TEST(Alignment, turns_a_line_about_its_midpoint_to_the_nearest_gis_edge) {
  const GisEdges gis(square_block(), {});
  const Segment2 wall{{2, 20.5}, {7, 20.5}};
  for (const double by : {-0.3, -0.05, 0.05, 0.3}) {
    const auto line = turned(wall, by), aligned = gis.aligned(line);
    EXPECT_LT(angle_between(aligned, wall), 1e-12);
    EXPECT_LT(length(0.5 * (aligned.start + aligned.end) - 0.5 * (line.start + line.end)), 1e-12);
    EXPECT_NEAR(length(aligned.end - aligned.start), 5, 1e-12);
  }
}

TEST(Alignment, keeps_the_line_s_own_sense) {
  const GisEdges gis(square_block(), {});
  const Segment2 back{{7, 20.5}, {2, 20.5}};
  EXPECT_LT(angle_between(gis.aligned(turned(back, 0.1)), back), 1e-12);
}

TEST(Alignment, leaves_alone_what_is_far_or_oblique_or_switched_off) {
  const GisEdges gis(square_block(), {});
  const Segment2 far{{2, 24}, {7, 24.5}}, oblique = turned({{2, 20}, {7, 20}}, 0.6);
  EXPECT_EQ(gis.aligned(far), far);
  EXPECT_EQ(gis.aligned(oblique), oblique);
  const auto line = turned({{2, 20}, {7, 20}}, 0.1);
  EXPECT_EQ(GisEdges(square_block(), {.gis_angle = 0}).aligned(line), line);
  EXPECT_EQ(GisEdges(block::Block{}, {}).aligned(line), line) << "no footprints";
}

TEST(Alignment, does_not_swing_long_lines) {
  const GisEdges gis(square_block(), {});
  const auto line = turned({{1, 20}, {19, 20}}, 0.2);
  EXPECT_EQ(gis.aligned(line), line) << "its ends would move by 1.8 m";
}

TEST(Alignment, squares_a_line_to_the_gis_but_prefers_parallel_edges) {
  const GisEdges gis(square_block(), {});
  const auto step = turned({{10, 21}, {10, 18}}, 0.1);  // a party wall meeting the facade
  EXPECT_LT(angle_between(gis.aligned(step), {{0, 1}, {0, 0}}), 1e-12);

  Town town;  // a corner of 80°: by the slanted edge its own direction wins over the perpendicular to the other edge
  auto block = town.block();
  block.members.push_back({0, {{{{0, 0}, {20, 0}, {20, 10}, {1.763, 10}}, {}}}, 0});
  const GisEdges slanted(block, {});
  const Segment2 edge{{0.35, 2}, {1.4, 8}};
  EXPECT_LT(angle_between(slanted.aligned(turned(edge, 0.03)), {{0, 0}, {1.763, 10}}), 1e-9);
}

auto weighed(Segment2 s, std::size_t slice) -> WeighedLine {
  const double l = length(s.end - s.start);
  return {{s, slice}, l, l};
}

TEST(BusFilter, takes_weight_off_the_sides_of_thin_things_only) {
  std::vector<WeighedLine> lines = {
      weighed({{0, 0.3}, {10, 0.3}}, 0),   weighed({{10, 0}, {0, 0}}, 0),      // a fence
      weighed({{0, 52.5}, {12, 52.5}}, 0), weighed({{12, 50}, {0, 50}}, 0),    // a bus
      weighed({{0, 120}, {10, 120}}, 0),   weighed({{10, 110}, {0, 110}}, 0),  // a house
      weighed({{10, 123}, {0, 123}}, 0)};  // its neighbour across an alley, which faces it
  weigh_thin(lines, {.thin_distance = 4});
  EXPECT_NEAR(lines[0].good, 10 * 0.3 / 4, 1e-9);
  EXPECT_NEAR(lines[1].good, 10 * 0.3 / 4, 1e-9);
  EXPECT_NEAR(lines[2].good, 12 * 2.5 / 4, 1e-9);
  EXPECT_EQ(lines[4].good, 10);
  EXPECT_EQ(lines[5].good, 10);
  EXPECT_EQ(lines[6].good, 10);
  weigh_thin(lines, {.thin_distance = 0});
}

TEST(Clusters, follow_a_wall_into_its_roof) {
  LineStack stack(40);
  for (std::size_t i = 0; i < 40; ++i) {
    const double y = i < 20 ? 0 : -0.2 * static_cast<double>(i - 20);
    stack[i].push_back(weighed({{0, y}, {10, y}}, i));
  }
  const auto clusters = grow_clusters(stack, {}, {});
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_EQ(clusters[0].size(), 40u);
  for (std::size_t i = 1; i < 40; ++i) EXPECT_LT(clusters[0][i - 1].line.slice, clusters[0][i].line.slice);
}

TEST(Clusters, keep_walls_side_by_side_and_around_corners_apart) {
  LineStack stack(30);
  for (std::size_t i = 0; i < 30; ++i) {
    stack[i].push_back(weighed({{0, 0}, {10, 0}}, i));
    stack[i].push_back(weighed({{10.2, 0.1}, {20, 0.1}}, i));
    stack[i].push_back(weighed({{20, 0}, {20, -10}}, i));
    stack[i].push_back(weighed({{10, -0.5}, {0, -0.5}}, i));  // the other side
  }
  EXPECT_EQ(grow_clusters(stack, {}, {}).size(), 4u);
}

TEST(Clusters, end_at_a_step_wider_than_allowed) {
  LineStack stack(20);
  for (std::size_t i = 0; i < 20; ++i) {
    const double y = i < 10 ? 0 : -1.0;
    stack[i].push_back(weighed({{0, y}, {10, y}}, i));
  }
  EXPECT_EQ(grow_clusters(stack, {.cluster_step = 0.8}, {}).size(), 2u);
  EXPECT_EQ(grow_clusters(stack, {.cluster_step = 1.2}, {}).size(), 1u);
}

TEST(Clusters, bridge_one_missing_slice_but_not_three) {
  LineStack one(21), three(21);
  for (std::size_t i = 0; i < 21; ++i) {
    if (i != 10) one[i].push_back(weighed({{0, 0}, {10, 0}}, i));
    if (i < 9 || i > 11) three[i].push_back(weighed({{0, 0}, {10, 0}}, i));
  }
  EXPECT_EQ(grow_clusters(one, {}, {}).size(), 1u);
  EXPECT_EQ(grow_clusters(three, {}, {}).size(), 2u);
}

TEST(Clusters, of_a_few_lines_are_none) {
  LineStack stack(3);
  for (std::size_t i = 0; i < 3; ++i) stack[i].push_back(weighed({{0, 0}, {10, 0}}, i));
  EXPECT_TRUE(grow_clusters(stack, {}, {}).empty());
}

auto planes(std::size_t count) -> slice::SliceStack {
  slice::SliceStack stack;
  for (std::size_t i = 0; i < count; ++i) stack.slices.push_back({0.1 + 0.2 * static_cast<double>(i), {}});
  return stack;
}

TEST(Bases, stand_at_the_median_wall_foot_not_at_the_roof) {
  std::vector<WeighedLine> lines;
  base::Random random(4);
  for (std::size_t i = 0; i < 60; ++i) {
    const double y = (i < 30 ? 0 : -0.25 * static_cast<double>(i - 30)) + random.uniform(-0.1, 0.1);
    lines.push_back(weighed({{0, y}, {10, y}}, i));
  }
  const auto bases = find_bases(lines, planes(60), 0, {});
  ASSERT_EQ(bases.size(), 1u);
  EXPECT_TRUE(bases[0].wall);
  EXPECT_NEAR(bases[0].segment.start.y, 0, 0.05);
  EXPECT_NEAR(bases[0].segment.start.x, 0, 0.21);
  EXPECT_NEAR(bases[0].segment.end.x, 10, 0.21);
  EXPECT_NEAR(bases[0].low, 0.1, 0.5);
  EXPECT_NEAR(bases[0].high, 6, 0.8);
}

TEST(Bases, leave_out_the_cars_before_the_wall) {
  std::vector<WeighedLine> lines;
  for (std::size_t i = 0; i < 50; ++i) lines.push_back(weighed({{0, i < 10 ? 0.7 : 0}, {10, i < 10 ? 0.7 : 0}}, i));
  const auto bases = find_bases(lines, planes(50), 0, {});
  ASSERT_EQ(bases.size(), 1u);
  EXPECT_NEAR(bases[0].segment.start.y, 0, 1e-9);
}

TEST(Bases, of_roofs_without_walls_lie_at_the_gutter) {
  std::vector<WeighedLine> lines;
  for (std::size_t i = 20; i < 50; ++i) {
    const double y = -0.25 * static_cast<double>(i - 20);
    lines.push_back(weighed({{0, y}, {10, y}}, i));
  }
  const auto bases = find_bases(lines, planes(50), 0, {});
  ASSERT_EQ(bases.size(), 1u);
  EXPECT_FALSE(bases[0].wall);
  EXPECT_NEAR(bases[0].segment.start.y, 0, 0.5);
}

TEST(Bases, part_where_columns_stand_off_by_a_setback) {
  std::vector<WeighedLine> lines;
  for (std::size_t i = 0; i < 40; ++i) {
    lines.push_back(weighed({{0, 0}, {12, 0}}, i));
    lines.push_back(weighed({{12, 1.3}, {16, 1.3}}, i));    // outward
    lines.push_back(weighed({{16, -1.3}, {19, -1.3}}, i));  // inward
  }
  const auto bases = find_bases(lines, planes(40), 0, {});
  ASSERT_EQ(bases.size(), 3u);
  EXPECT_NEAR(bases[0].segment.start.y, 0, 1e-9);
  EXPECT_NEAR(bases[1].segment.start.y, 1.3, 1e-9);
  EXPECT_NEAR(bases[2].segment.start.y, -1.3, 1e-9);
  EXPECT_NEAR(length(bases[1].segment.end - bases[1].segment.start), 4, 0.3);
  EXPECT_EQ(find_bases(lines, planes(40), 0, {.setback = 2}).size(), 1u);
}

TEST(Bases, of_nothing_are_none) { EXPECT_TRUE(find_bases({}, planes(3), 0, {}).empty()); }

}  // namespace
}  // namespace mansard::sweep::detail
