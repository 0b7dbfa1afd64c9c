// Footprints brought to the mesh, and sweep-edges put on them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mansard/base/run.hpp"
#include "mansard/sweep/detail/registration.hpp"
#include "sweep/town.hpp"

namespace mansard::sweep::detail {
namespace {

using testing::Each;
using testing::Field;

auto rectangle(Point2 low, Point2 high) -> geometry::Ring { return {low, {high.x, low.y}, high, {low.x, high.y}}; }

auto block_of(std::vector<geometry::Ring> footprints) -> block::Block {
  block::Block block;
  block.name = "made";
  for (std::size_t i = 0; i < footprints.size(); ++i) {
    block.members.push_back({i, {{footprints[i], {}}}, 0});
    block.outline.push_back({footprints[i], {}});
  }
  return block;
}

/// The walls of a ring, each `out` metres outside of it, outside on the left, 5 m high.
auto walls_of(const geometry::Ring& ring, double out = 0) -> std::vector<SweepEdge> {
  std::vector<SweepEdge> walls;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point2 a = ring[(i + 1) % ring.size()], b = ring[i];
    const Point2 normal = geometry::left_of(normalised(b - a));
    walls.push_back({{a + out * normal, b + out * normal}, 5 * length(b - a), 0, 5, i});
  }
  return walls;
}

auto farthest_from(const std::vector<SweepEdge>& edges, const std::vector<SweepEdge>& walls) -> double {
  double most = 0;
  for (const auto& e : edges)
    for (const Point2 p : {e.segment.start, e.segment.end}) {
      double least = 1e9;
      for (const auto& w : walls) least = std::min(least, geometry::distance(w.segment, p));
      most = std::max(most, least);
    }
  return most;
}

const geometry::Ring house = rectangle({0, 0}, {12, 8});

TEST(Registration, finds_by_how_much_all_footprints_are_displaced) {
  const Point2 off{0.21, -0.13};
  geometry::Ring drawn = house;
  for (auto& p : drawn) p = p + off;
  const auto found = register_footprints(walls_of(house), block_of({drawn}), {});
  EXPECT_LT(length(found.shift + off), 0.01);
  EXPECT_LT(found.spread, 0.01);
}

/// 24 chords around a middle.
auto round_house(double radius) -> geometry::Ring {
  geometry::Ring out;
  for (int i = 0; i < 24; ++i)
    out.push_back({10 + radius * std::cos(i * 0.2617993877991494), 10 + radius * std::sin(i * 0.2617993877991494)});
  return out;
}

TEST(Registration, puts_walls_on_all_chords_of_a_curve_or_on_none) {
  const auto ring = round_house(8);
  const auto block = block_of({ring});
  // Straight pieces over two chords each, as slices give them, along two thirds of the curve.
  std::vector<SweepEdge> walls;
  for (std::size_t i = 0; i < 16; i += 2)
    walls.push_back({{ring[i + 2], ring[i]}, 5 * length(ring[i + 2] - ring[i]), 0, 5, i});
  const auto placed = put_on_footprints(walls, block, {}, {});
  ASSERT_EQ(placed.size(), 24U);
  const auto chords = edges_of_footprints(block, {});
  for (const auto& edge : placed)
    EXPECT_TRUE(std::ranges::any_of(chords, [&](const Segment2& c) { return c == edge.segment; }));
  double before = 0, after = 0;
  for (const auto& edge : walls) before += edge.area;
  for (const auto& edge : placed) after += edge.area;
  EXPECT_NEAR(after, before, 0.1 * before);  // pieces do not reach all corners
  // What was seen along a quarter only stays what it is.
  walls.resize(2);
  EXPECT_LT(put_on_footprints(walls, block, {}, {}).size(), 10U);
}

TEST(Registration, is_not_led_astray_by_one_wall_that_is_elsewhere) {
  const Point2 off{0.21, -0.13};
  geometry::Ring drawn = house;
  for (auto& p : drawn) p = p + off;
  auto walls = walls_of(rectangle({0, 0}, {12, 8}));
  const auto other = walls_of(rectangle({20, 0}, {30, 8}));
  walls.insert(walls.end(), other.begin(), other.end());
  walls.back().segment.start.x -= 0.6, walls.back().segment.end.x -= 0.6;  // a conservatory, unknown to the footprints
  const auto found =
      register_footprints(walls, block_of({drawn, rectangle(Point2{20, 0} + off, Point2{30, 8} + off)}), {});
  EXPECT_LT(length(found.shift + off), 0.02);
}

auto moved(geometry::Ring ring, Point2 by) -> geometry::Ring {
  for (auto& p : ring) p = p + by;
  return ring;
}

/// Eight houses in a row, gaps between them, and their walls, each up to `scatter` off, in or out.
struct Row {
  std::vector<geometry::Ring> drawn;
  std::vector<SweepEdge> walls;
};
auto row(Point2 off, double scatter) -> Row {
  Row out;
  base::Random random(7);
  for (int i = 0; i < 8; ++i) {
    const auto ring = moved(house, {20.0 * i, 0});
    out.drawn.push_back(moved(ring, off));
    for (auto wall : walls_of(ring)) {
      const Point2 normal = geometry::left_of(normalised(wall.segment.end - wall.segment.start));
      const double by = random.uniform(-scatter, scatter);
      wall.segment = {wall.segment.start + by * normal, wall.segment.end + by * normal};
      out.walls.push_back(wall);
    }
  }
  return out;
}

TEST(Registration, believes_many_walls_although_each_is_off_by_more_than_half_the_shift) {
  const Point2 off{0.06, 0.19};
  const auto many = row(off, 0.3);
  const auto found = register_footprints(many.walls, block_of(many.drawn), {});
  EXPECT_LT(length(found.shift + off), 0.1);
  EXPECT_GT(found.spread, length(found.shift) / 2) << "each wall alone says nothing";
}

TEST(Registration, takes_scatter_for_no_displacement) {
  const auto straight = row({0, 0}, 0.25);
  EXPECT_EQ(register_footprints(straight.walls, block_of(straight.drawn), {}).shift, (Point2{0, 0}));
}

TEST(Registration, finds_footprints_that_are_a_metre_off) {
  const Point2 off{-0.8, 0.6};
  const auto exact = row(off, 0.05);
  EXPECT_LT(length(register_footprints(exact.walls, block_of(exact.drawn), {}).shift + off), 0.05);
  const auto far = row(1.7 * off, 0.05);
  EXPECT_EQ(register_footprints(far.walls, block_of(far.drawn), {}).shift, (Point2{0, 0})) << "not by two";
}

TEST(Registration, is_none_where_two_shifts_fit_alike) {
  // Drawn between the walls of the house and those of its bays, on both of its long sides.
  const auto wall = [](Point2 from, Point2 to) { return SweepEdge{{from, to}, 5 * length(to - from), 0, 5, 0}; };
  std::vector<SweepEdge> walls{wall({0, 5}, {0, 8}), wall({12, 8}, {12, 5}), wall({6.5, 0.6}, {0, 0.6}),
                               wall({0, 8.6}, {6.5, 8.6})};
  EXPECT_NEAR(register_footprints(walls, block_of({house}), {}).shift.y, 0.6, 0.05) << "southern wall, northern bay";
  walls.push_back(wall({12, -0.6}, {6.5, -0.6}));
  walls.push_back(wall({6.5, 7.4}, {12, 7.4}));
  EXPECT_EQ(register_footprints(walls, block_of({house}), {}).shift, (Point2{0, 0}))
      << "southern bay, northern wall, too";
}

TEST(Registration, finds_the_displacement_of_footprints_that_are_drawn_too_large) {
  // Everywhere as much too large as they are displaced: one wall is where it is drawn.
  const auto shift_of = [](double out) {
    return register_footprints(walls_of(house, out), block_of({moved(house, {0.15, 0})}), {}).shift;
  };
  EXPECT_LT(length(shift_of(-0.15) - Point2{-0.15, 0}), 0.01);
  EXPECT_EQ(shift_of(0.15), (Point2{0, 0})) << "eaves on all sides but one, as likely";
  EXPECT_EQ(shift_of(-0.3), (Point2{0, 0})) << "such walls do not stand on their footprints";
}

TEST(Registration, takes_eaves_for_eaves) {
  const auto found = register_footprints(walls_of(house, 0.4), block_of({house}), {});
  EXPECT_EQ(found.shift, (Point2{0, 0}));
  EXPECT_NEAR(found.spread, 0.4, 1e-9);
}

TEST(Registration, says_nothing_of_a_shift_where_walls_face_one_way) {
  const auto walls = walls_of(house, 0.3);
  const auto found = register_footprints({walls.front()}, block_of({house}), {});
  EXPECT_EQ(found.shift, (Point2{0, 0})) << "eaves, or a displacement: one wall cannot tell";
  EXPECT_NEAR(found.spread, 0.3, 1e-9);
}

TEST(Registration, of_nothing_is_nothing) {
  geometry::Ring drawn = house;
  for (auto& p : drawn) p = p + Point2{0.2, 0.1};
  const auto none = Point2{0, 0};
  EXPECT_EQ(register_footprints({}, block_of({drawn}), {}).shift, none);
  EXPECT_EQ(register_footprints(walls_of(house), block::Block{}, {}).shift, none);
  EXPECT_EQ(register_footprints(walls_of(house), block_of({drawn}), {.gis_offset = 0}).shift, none);
}

TEST(OnFootprints, walls_seen_outside_stand_on_them) {
  const auto block = block_of({house});
  const auto edges = put_on_footprints(walls_of(house, 0.5), block, {}, {});
  ASSERT_EQ(edges.size(), 4U);
  EXPECT_LT(farthest_from(edges, walls_of(house)), 1e-9);
}

TEST(OnFootprints, walls_seen_inside_stay_there_but_for_noise) {
  const auto walls = walls_of(house, -0.5);
  EXPECT_EQ(farthest_from(put_on_footprints(walls, block_of({house}), {}, {}), walls), 0)
      << "a scan sees the outermost surface: nothing stands out there";
  EXPECT_LT(farthest_from(put_on_footprints(walls_of(house, -0.2), block_of({house}), {}, {}), walls_of(house)), 1e-9);
}

TEST(OnFootprints, nothing_moves_when_it_is_switched_off) {
  const auto walls = walls_of(house, 0.1);
  EXPECT_EQ(farthest_from(put_on_footprints(walls, block_of({house}), {}, {.gis_offset = 0}), walls), 0);
}

TEST(OnFootprints, they_are_displaced_first) {
  geometry::Ring drawn = house;
  for (auto& p : drawn) p = p + Point2{0.5, 0.5};
  const auto edges = put_on_footprints(walls_of(house, 0.03), block_of({drawn}), {.shift = {-0.5, -0.5}}, {});
  EXPECT_LT(farthest_from(edges, walls_of(house)), 1e-9);
}

TEST(OnFootprints, a_wall_far_off_or_turned_or_inside_out_stays) {
  const std::vector<SweepEdge> walls{{{{1, -3}, {9, -3}}, 40, 0, 5, 0},  // inside out, as seen from the south wall
                                     {{{9, -1}, {1, -1}}, 40, 0, 5, 1},  // a metre outside
                                     {{{2, 1}, {5, 7}}, 30, 0, 5, 2}};   // oblique, in the middle
  const auto edges = put_on_footprints(walls, block_of({house}), {}, {});
  ASSERT_EQ(edges.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(edges[i].segment, walls[i].segment);
}

TEST(OnFootprints, a_wall_bends_with_them_and_keeps_its_area) {
  // The south wall is drawn with a flat bay, 0.3 m deep; it was seen as one line.
  const geometry::Ring bay{{0, 0}, {4, 0}, {4.3, -0.3}, {7.7, -0.3}, {8, 0}, {12, 0}, {12, 8}, {0, 8}};
  const SweepEdge wall{{{12, -0.1}, {0, -0.1}}, 60, 0, 5, 0};
  const auto edges = put_on_footprints({wall}, block_of({bay}), {}, {});
  EXPECT_EQ(edges.size(), 5U);
  EXPECT_LT(farthest_from(edges, walls_of(bay)), 1e-9);
  double area = 0;
  for (const auto& e : edges) area += e.area;
  EXPECT_NEAR(area, 60, 2) << "slanted pieces are a little longer than the line was there";
  EXPECT_THAT(edges, Each(Field(&SweepEdge::cluster, 0U)));
}

TEST(OnFootprints, what_goes_beyond_them_stays_where_it_was) {
  const SweepEdge wall{{{18, -0.2}, {0, -0.2}}, 90, 0, 5, 0};  // 6 m beyond the house
  const auto edges = put_on_footprints({wall}, block_of({house}), {}, {});
  ASSERT_EQ(edges.size(), 2U);
  EXPECT_EQ(edges[0].segment.start, (Point2{18, -0.2}));
  EXPECT_NEAR(length(edges[0].segment.end - edges[0].segment.start), 6, 1e-9);
  EXPECT_NEAR(edges[0].area, 30, 1e-9);
  EXPECT_NEAR(edges[1].area, 60, 1e-9);
}

TEST(OnFootprints, the_facade_of_a_row_stays_one) {
  std::vector<geometry::Ring> row;
  for (int i = 0; i < 5; ++i) row.push_back(rectangle({6.0 * i, 0}, {6.0 * i + 6, 9}));
  const SweepEdge facade{{{30, -0.1}, {0, -0.1}}, 150, 0, 5, 0};
  const auto edges = put_on_footprints({facade}, block_of(row), {}, {});
  ASSERT_EQ(edges.size(), 1U);
  EXPECT_LT(length(edges[0].segment.start - Point2{30, 0}) + length(edges[0].segment.end), 1e-9);
}

TEST(OnFootprints, the_facade_of_a_row_is_the_line_through_all_of_its_corners) {
  // A straight facade, surveyed with errors of 1 and 2 cm, which are largest at the two ends.
  const std::vector<double> off{0.02, -0.01, -0.01, -0.01, -0.01, 0.02};
  std::vector<geometry::Ring> row;
  for (std::size_t i = 0; i + 1 < off.size(); ++i) {
    const double x = 6.0 * static_cast<double>(i);
    row.push_back({{x, off[i]}, {x + 6, off[i + 1]}, {x + 6, 9}, {x, 9}});
  }
  const SweepEdge facade{{{30, -0.1}, {0, -0.1}}, 150, 0, 5, 0};
  const auto edges = put_on_footprints({facade}, block_of(row), {}, {});
  ASSERT_EQ(edges.size(), 1U);
  EXPECT_NEAR(edges[0].segment.start.y, 0, 0.005);
  EXPECT_NEAR(edges[0].segment.end.y, 0, 0.005);
  EXPECT_NEAR(edges[0].segment.start.x, 30, 0.001);
  EXPECT_NEAR(edges[0].segment.end.x, 0, 0.001);
}

TEST(OnFootprints, a_house_set_back_by_more_than_a_survey_is_off_is_not_in_the_line) {
  const std::vector<geometry::Ring> row{rectangle({0, 0}, {6, 9}), rectangle({6, 0.1}, {12, 9}),
                                        rectangle({12, 0}, {18, 9})};
  const SweepEdge facade{{{18, -0.1}, {0, -0.1}}, 90, 0, 5, 0};
  const auto edges = put_on_footprints({facade}, block_of(row), {}, {});
  ASSERT_EQ(edges.size(), 3U);
  EXPECT_NEAR(edges[1].segment.start.y, 0.1, 1e-9);
  EXPECT_NEAR(edges[1].segment.end.y, 0.1, 1e-9);
}

TEST(OnFootprints, a_whole_scan_is_put_on_its_displaced_footprints) {
  Town town(0.05);
  town.gabled({0, 0}, {14, 9}, 6, 9);
  town.ground({-12, -12}, {26, 21});
  town.footprint({0.2, -0.15}, {14.2, 8.85});
  const auto found = edges_of(town.block());
  EXPECT_LT(length(found.registration.shift - Point2{-0.2, 0.15}), 0.06);
  EXPECT_LT(found.registration.spread, 0.05);
  const auto truth = walls_of(rectangle({0, 0}, {14, 9}));
  for (const auto& w : truth) EXPECT_EQ(followers(found, w.segment.start, w.segment.end, 0.06), 1);
}

}  // namespace
}  // namespace mansard::sweep::detail
