#include "mansard/sweep/detail/lines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "mansard/sweep/detail/chains.hpp"
#include "sweep/town.hpp"

namespace mansard::sweep::detail {
namespace {

/// A closed polyline through corners in steps of about 0.4 m, each point off by noise.
auto noisy(const std::vector<Point2>& corners, double noise, std::uint64_t seed) -> std::vector<Segment2> {
  base::Random random(seed);
  std::vector<Point2> points;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point2 a = corners[i], b = corners[(i + 1) % corners.size()];
    const int n = std::max(1, static_cast<int>(length(b - a) / 0.4));
    for (int k = 0; k < n; ++k) {
      const double dx = random.uniform(-1, 1), dy = random.uniform(-1, 1);
      points.push_back(a + (static_cast<double>(k) / n) * (b - a) + (1.7 * noise) * Point2{dx, dy});
    }
  }
  std::vector<Segment2> segments;
  for (std::size_t i = 0; i < points.size(); ++i) segments.push_back({points[i], points[(i + 1) % points.size()]});
  return segments;
}

const std::vector<Point2> rectangle = {{0, 0}, {0, 16}, {24, 16}, {24, 0}};  // clockwise: outside on the left

void shuffle(std::vector<Segment2>& segments, std::uint64_t seed) {
  base::Random random(seed);
  for (std::size_t i = segments.size(); i > 1; --i) std::swap(segments[i - 1], segments[random.index(i)]);
}

TEST(Lines, of_a_noisy_rectangle_are_its_four_sides) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const auto lines = find_lines(noisy(rectangle, 0.1, seed), {});
    ASSERT_EQ(lines.size(), 4u) << "seed " << seed;
    for (std::size_t i = 0; i < 4; ++i) {
      const Point2 a = rectangle[i], b = rectangle[(i + 1) % 4], d = normalised(b - a);
      const auto line = std::find_if(lines.begin(), lines.end(),
                                     [&](const Segment2& s) { return dot(normalised(s.end - s.start), d) > 0.9; });
      ASSERT_NE(line, lines.end());
      const double degree = std::numbers::pi / 180;
      EXPECT_LT(std::abs(cross(d, normalised(line->end - line->start))), std::sin(degree)) << "seed " << seed;
      EXPECT_LT(std::abs(cross(d, 0.5 * (line->start + line->end) - a)), 0.05) << "seed " << seed;
      EXPECT_NEAR(length(line->end - line->start), length(b - a), 0.8) << "seed " << seed;
    }
  }
}

TEST(Lines, do_not_depend_on_the_order_of_segments) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    auto segments = noisy({{0, 0}, {0, 8}, {5, 8}, {5, 6}, {12, 6}, {12, 0}}, 0.2, seed);
    const auto before = find_lines(segments, {});
    shuffle(segments, seed);
    EXPECT_EQ(before, find_lines(segments, {})) << "seed " << seed;
  }
}

TEST(Lines, keep_both_levels_of_a_facade_that_steps_back) {
  //   6─────────.
  //             │        .
  //             └──────  5    (12 m long)
  const auto lines = find_lines(noisy({{0, 0}, {0, 6}, {6, 6}, {6, 5}, {12, 5}, {12, 0}}, 0.1, 3), {});
  const auto at = [&](double y) {
    return std::count_if(lines.begin(), lines.end(), [&](const Segment2& s) {
      return s.end.x - s.start.x > 4.5 && std::abs(0.5 * (s.start.y + s.end.y) - y) < 0.12;
    });
  };
  EXPECT_EQ(at(6), 1);
  EXPECT_EQ(at(5), 1);
}

TEST(Lines, close_gaps_up_to_line_gap_and_no_wider) {
  std::vector<Segment2> segments;
  for (int i = 0; i < 10; ++i) segments.push_back({{0.5 * i, 0}, {0.5 * i + 0.5, 0}});
  for (int i = 0; i < 10; ++i) segments.push_back({{5.5 + 0.5 * i, 0.02}, {6 + 0.5 * i, 0.02}});
  EXPECT_EQ(find_lines(segments, {.line_gap = 0.6}).size(), 1u);
  EXPECT_EQ(find_lines(segments, {.line_gap = 0.4}).size(), 2u);
}

TEST(Lines, tell_the_two_sides_of_a_wall_apart) {
  const std::vector<Segment2> segments = {{{0, 0}, {5, 0}}, {{5, -0.2}, {0, -0.2}}};
  const auto lines = find_lines(segments, {});
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_LT(dot(lines[0].end - lines[0].start, lines[1].end - lines[1].start), 0);
}

TEST(Lines, shorter_than_half_a_metre_are_dropped) {
  EXPECT_TRUE(find_lines({{{0, 0}, {0.3, 0}}}, {}).empty());
  EXPECT_EQ(find_lines({{{0, 0}, {0.7, 0}}}, {}).size(), 1u);
}

TEST(Lines, of_nothing_or_of_rubbish_are_none) {
  EXPECT_TRUE(find_lines({}, {}).empty());
  EXPECT_TRUE(find_lines({{{1, 1}, {1, 1}}}, {}).empty());
  EXPECT_TRUE(find_lines({{{0, 0}, {std::nan(""), 1}}}, {}).empty());
}

TEST(Lines, far_from_the_origin_are_as_good) {
  auto segments = noisy(rectangle, 0.1, 5);
  const auto here = find_lines(segments, {});
  for (auto& s : segments) s = {s.start + Point2{1 << 19, -(1 << 20)}, s.end + Point2{1 << 19, -(1 << 20)}};
  const auto there = find_lines(segments, {});
  ASSERT_EQ(here.size(), there.size());
  for (std::size_t i = 0; i < here.size(); ++i)
    EXPECT_LT(length(here[i].start + Point2{1 << 19, -(1 << 20)} - there[i].start), 1e-6);
}

TEST(Lines, survive_a_soup_of_segments) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    base::Random random(seed);
    std::vector<Segment2> segments;
    const auto coordinate = [&] { return std::round(random.uniform(0, 40)) / 4; };
    for (int i = 0; i < 400; ++i) {
      const double a = coordinate(), b = coordinate(), c = coordinate(), d = coordinate();
      segments.push_back({{a, b}, {c, d}});
      if (i % 7 == 0) segments.push_back(segments.back());
      if (i % 5 == 0) segments.push_back({{c, d}, {a, b}});
    }
    const auto lines = find_lines(segments, {});
    shuffle(segments, seed);
    EXPECT_EQ(lines, find_lines(segments, {})) << "seed " << seed;
    for (const auto& l : lines) EXPECT_GE(length(l.end - l.start), 0.5 - 1e-9);
  }
}

TEST(Chains, hold_every_segment_once) {
  auto segments = noisy(rectangle, 0.1, 1);
  const auto count = segments.size();
  segments.push_back(segments.front());             // a duplicate
  segments.push_back({segments[3].end, {99, 99}});  // a branch
  const auto chains = join(segments);
  std::size_t found = 0;
  for (const auto& chain : chains) found += chain.size() - 1;
  EXPECT_EQ(found, count + 1);
  EXPECT_EQ(join(noisy(rectangle, 0.1, 1)).size(), 1u) << "a ring is one chain";
}

TEST(Chains, that_are_closed_begin_at_one_point_of_several_that_are_as_far_west) {
  const std::vector<Point2> ring{{0, 0.3}, {1, 0}, {2, 1}, {1, 3}, {0, 2.2}, {0.4, 1.1}};
  const auto first_of = [&](double west, std::size_t moved) {
    auto points = ring;
    points[moved].x -= west;
    std::vector<Segment2> segments;
    for (std::size_t i = 0; i < points.size(); ++i) segments.push_back({points[i], points[(i + 1) % points.size()]});
    return join(segments).at(0).front().y;
  };
  EXPECT_EQ(first_of(1e-6, 0), 0.3);
  EXPECT_EQ(first_of(1e-6, 4), 0.3) << "the northern one is a micrometre farther west";
  EXPECT_EQ(first_of(0.5, 4), 2.2);
}

}  // namespace
}  // namespace mansard::sweep::detail
