#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mansard/segment/detail/gis_cuts.hpp"
#include "mansard/segment/segment.hpp"

namespace mansard::segment {
namespace {

using geometry::Point2, geometry::Segment2;

auto member(std::size_t feature, geometry::Ring ring) -> block::Member {
  block::Member m;
  m.feature = feature;
  m.polygons.push_back({std::move(ring), {}});
  return m;
}

auto rectangle(double x, double y, double width, double depth) -> geometry::Ring {
  return {{x, y}, {x + width, y}, {x + width, y + depth}, {x, y + depth}};
}

auto length_of(const Segment2& s) -> double { return geometry::length(s.end - s.start); }

TEST(Cuts, are_the_sweep_edges_in_their_order_and_then_the_party_walls) {
  sweep::SweepEdges edges;
  for (const double l : {9.0, 5.0, 2.0}) edges.edges.push_back({{{0, l}, {l, l}}, 20, 0, 5, 0});
  block::Block block;
  block.members = {member(0, rectangle(0, 0, 6, 10)), member(1, rectangle(6, 0, 5, 8)),
                   member(2, rectangle(11, 0, 5, 10))};
  const auto cuts = cuts_of(edges, block, {});
  ASSERT_GE(cuts.size(), 5U);
  for (std::uint32_t i = 0; i < 3; ++i) {
    EXPECT_EQ(cuts[i].source, i);
    EXPECT_EQ(cuts[i].segment, edges.edges[i].segment);
  }
  EXPECT_EQ(cuts[3].source, gis_source);
  EXPECT_EQ(cuts[4].source, gis_source + 1);
  for (const std::size_t i : {3U, 4U}) EXPECT_NEAR(length_of(cuts[i].segment), 8, 1e-9) << "only what both walls share";
  Options paper;
  paper.gis_edges = GisEdges::ignore;
  EXPECT_EQ(cuts_of(edges, block, paper).size(), 3U);
}

TEST(PartyLines, find_party_walls_that_do_not_quite_touch_once) {
  block::Block block;
  block.members = {member(0, rectangle(0, 0, 6, 10)), member(1, rectangle(6.15, -2, 5, 20))};
  const auto lines = detail::party_lines(block, {});
  ASSERT_EQ(lines.size(), 1U) << "one of the twins";
  EXPECT_EQ(lines[0], (Segment2{{6, 0}, {6, 10}}));
  block.members[1] = member(1, rectangle(6.25, -2, 5, 20));
  EXPECT_TRUE(detail::party_lines(block, {}).empty()) << "0.25 m apart";
}

TEST(PartyLines, join_the_stretches_of_one_wall_along_several_neighbours) {
  block::Block block;
  block.members = {member(0, rectangle(0, 0, 30, 5)), member(1, rectangle(0, 5, 10, 8)),
                   member(2, rectangle(10, 5, 10, 8)), member(3, rectangle(20, 5, 10, 8))};
  const auto lines = detail::party_lines(block, {});
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_NEAR(length_of(lines[0]), 30, 1e-9);
  EXPECT_NEAR(length_of(lines[1]), 8, 1e-9);
  EXPECT_NEAR(length_of(lines[2]), 8, 1e-9);
}

TEST(PartyLines, leave_out_walls_that_only_cross_or_run_within_one_feature) {
  block::Block block;
  block.members = {member(0, rectangle(0, 0, 10, 10)), member(1, {{10, 5}, {20, 0}, {20, 10}})};
  EXPECT_TRUE(detail::party_lines(block, {}).empty()) << "a corner against a wall";
  block::Member both = member(0, rectangle(0, 0, 10, 10));
  both.polygons.push_back({rectangle(10, 0, 10, 10), {}});
  block.members = {both};
  EXPECT_TRUE(detail::party_lines(block, {}).empty()) << "two polygons of one feature";
}

TEST(PartyLines, know_walls_of_courtyards) {
  block::Block block;
  block::Member around = member(0, rectangle(0, 0, 30, 30));
  around.polygons[0].holes.push_back({{10, 10}, {10, 20}, {20, 20}, {20, 10}});
  block.members = {around, member(1, rectangle(10, 10, 10, 10))};
  const auto lines = detail::party_lines(block, {});
  ASSERT_EQ(lines.size(), 4U);
  for (const auto& line : lines) EXPECT_NEAR(length_of(line), 10, 1e-9);
}

auto walls(const std::vector<Segment2>& segments) -> sweep::SweepEdges {
  sweep::SweepEdges edges;
  for (const auto& segment : segments) edges.edges.push_back({segment, 20, 0, 5, 0});
  return edges;
}

TEST(TornLines, are_the_whole_outline_where_the_mesh_shows_no_wall) {
  block::Block block;
  block.members = {member(0, rectangle(0, 0, 12, 8))};
  const auto lines = detail::torn_lines(block, {}, {});
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_NEAR(length_of(lines[0]), 12, 1e-9);
  EXPECT_NEAR(length_of(lines[3]), 8, 1e-9);
}

TEST(TornLines, are_only_the_stretches_that_no_sweep_edge_stands_on) {
  block::Block block;
  block.members = {member(0, rectangle(0, 0, 12, 8))};
  const auto lines = detail::torn_lines(
      block, walls({{{0, 0.1}, {7, 0.1}}, {{12, 8}, {0, 8}}, {{0, 8}, {0, 0}}, {{14, 0}, {14, 8}}}), {});
  ASSERT_EQ(lines.size(), 2U) << "what is left of the south wall, and the east wall, which was seen 2 m off";
  EXPECT_EQ(lines[0], (Segment2{{12, 0}, {12, 8}}));
  EXPECT_EQ(lines[1], (Segment2{{7, 0}, {12, 0}}));
}

TEST(TornLines, run_beside_walls_that_were_found_elsewhere) {
  block::Block block;
  block.members = {member(0, rectangle(0, 0, 12, 8))};
  const auto lines = detail::torn_lines(
      block, walls({{{0, 0.6}, {12, 0.6}}, {{12, 8}, {0, 8}}, {{0, 8}, {0, 0}}, {{12, 0}, {12, 8}}}), {});
  ASSERT_EQ(lines.size(), 1U) << "what lies between the two is for the mesh's heights to say";
  EXPECT_EQ(lines[0], (Segment2{{0, 0}, {12, 0}}));
}

TEST(TornLines, go_where_the_footprints_were_moved) {
  block::Block block;
  block.members = {member(0, rectangle(0, 0, 12, 8))};
  sweep::SweepEdges none;
  none.registration.shift = {0.5, -0.25};
  const auto cuts = cuts_of(none, block, {});
  ASSERT_EQ(cuts.size(), 4U);
  for (const auto& cut : cuts)
    for (const Point2 p : {cut.segment.start, cut.segment.end}) {
      EXPECT_TRUE(p.x == 0.5 || p.x == 12.5) << p.x;
      EXPECT_TRUE(p.y == -0.25 || p.y == 7.75) << p.y;
    }
}

TEST(TornLines, leave_party_walls_to_the_party_lines) {
  block::Block block;
  block.members = {member(0, rectangle(0, 0, 6, 8)), member(1, rectangle(6, 0, 6, 8))};
  for (const auto& line : detail::torn_lines(block, {}, {}))
    EXPECT_FALSE(line.start.x == 6 && line.end.x == 6) << line.start.y << " " << line.end.y;
  EXPECT_EQ(detail::party_lines(block, {}).size(), 1U);
}

TEST(Cuts, add_what_the_mesh_does_not_show_unless_footprints_are_ignored) {
  block::Block block;
  block.members = {member(0, rectangle(0, 0, 12, 8))};
  const auto edges = walls({{{0, 0}, {12, 0}}, {{12, 8}, {0, 8}}});
  const auto cuts = cuts_of(edges, block, {});
  ASSERT_EQ(cuts.size(), 4U);
  EXPECT_EQ(cuts[2].source, gis_source);
  Options paper;
  paper.gis_edges = GisEdges::ignore;
  EXPECT_EQ(cuts_of(edges, block, paper).size(), 2U);
}

}  // namespace
}  // namespace mansard::segment
