#include "mansard/geometry/arcs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "mansard/base/run.hpp"

namespace {

using namespace mansard::geometry;
constexpr double pi = std::numbers::pi;

/// Corners of an ellipse from one angle to another, both included.
auto ellipse(Point2 centre, double a, double b, double from, double to, int chords) -> Ring {
  Ring out;
  for (int i = 0; i <= chords; ++i) {
    const double angle = from + (to - from) * i / chords;
    out.push_back({centre.x + a * std::cos(angle), centre.y + b * std::sin(angle)});
  }
  return out;
}
auto whole(double a, double b, int chords) -> Ring {
  auto out = ellipse({3, 4}, a, b, 0, 2 * pi, chords);
  out.pop_back();
  return out;
}
auto rounded(Ring ring, double to) -> Ring {
  for (auto& p : ring) p = {std::round(p.x / to) * to, std::round(p.y / to) * to};
  return ring;
}
/// The edges of all curves.
auto edges(const Ring& ring) -> std::size_t {
  std::size_t sum = 0;
  for (const auto& arc : arcs_of(ring)) sum += arc.count;
  return sum;
}

TEST(Arcs, of_circles_and_ellipses_are_the_whole_ring) {
  for (const int chords : {8, 12, 16, 24, 48, 96})
    for (const double radius : {1.5, 4.0, 8.0, 40.0})
      for (const double flat : {1.0, 0.7, 0.5}) {
        if (chords < 48 && flat < 1) continue;  // the ends of an ellipse are bent too much to be seen in fewer chords
        const auto ring = rounded(whole(radius, flat * radius, chords), 0.001);
        const auto arcs = arcs_of(ring);
        ASSERT_EQ(arcs.size(), 1U) << chords << ' ' << radius << ' ' << flat;
        EXPECT_EQ(arcs.front().count, ring.size());
      }
}

TEST(Arcs, are_found_in_corners_that_a_survey_gives_to_centimetres) {
  mansard::base::Random random(5, 0);
  for (int n = 0; n < 200; ++n) {
    auto ring = whole(2 + 20 * random.uniform(), 1, 12);
    const double radius = 2 + 20 * random.uniform();
    ring = whole(radius, radius, 12 + static_cast<int>(20 * random.uniform()));
    for (auto& p : ring) p = p + Point2{0.02 * random.uniform() - 0.01, 0.02 * random.uniform() - 0.01};
    EXPECT_EQ(edges(ring), ring.size());
  }
}

TEST(Arcs, end_where_straight_sides_begin) {
  // A nave with an apse: 12 chords; the sides touch the circle.
  auto ring = ellipse({20, 5}, 5, 5, -pi / 2, pi / 2, 12);
  ring.push_back({0, 10});
  ring.push_back({0, 0});
  const auto arcs = arcs_of(ring);
  ASSERT_EQ(arcs.size(), 1U);
  EXPECT_EQ(arcs.front().first, 0U);
  EXPECT_EQ(arcs.front().count, 12U);
  // The same from any first corner and in a hole.
  for (std::size_t k = 0; k < ring.size(); ++k) {
    std::ranges::rotate(ring, ring.begin() + 1);
    ASSERT_EQ(arcs_of(ring).size(), 1U) << k;
    EXPECT_EQ(arcs_of(ring).front().count, 12U);
    EXPECT_EQ(arcs_of(ring).front().first, (ring.size() - 1 - k) % ring.size());
  }
  std::ranges::reverse(ring);
  EXPECT_EQ(edges(ring), 12U);
}

TEST(Arcs, to_two_sides_are_two) {
  auto ring = ellipse({0, 0}, 5, 5, pi, 2 * pi, 10);  // an S in plan, which its middle chord ends on both sides
  const auto other = ellipse({12, 0}, 7, 7, pi, 0, 10);
  ring.insert(ring.end(), other.begin() + 1, other.end());
  ring.push_back({19, 30});
  ring.push_back({-5, 30});
  for (std::size_t k = 0; k < ring.size(); ++k) {
    std::ranges::rotate(ring, ring.begin() + 1);
    const auto arcs = arcs_of(ring);
    ASSERT_EQ(arcs.size(), 2U);
    EXPECT_GE(arcs[0].count + arcs[1].count, 18U);
    std::vector<int> uses(ring.size(), 0);
    for (const auto& arc : arcs)
      for (std::size_t i = 0; i < arc.count; ++i) EXPECT_EQ(++uses[(arc.first + i) % ring.size()], 1);
  }
}

TEST(Arcs, keep_corners_that_parts_put_on_their_chords) {
  const auto plain = whole(8, 8, 16);
  Ring ring;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    ring.push_back(plain[i]);
    if (i % 3 == 0) ring.push_back(plain[i] + 0.3 * (plain[(i + 1) % plain.size()] - plain[i]));
  }
  EXPECT_EQ(edges(ring), ring.size());
}

TEST(Arcs, are_not_in_what_has_corners) {
  EXPECT_EQ(edges({{0, 0}, {10, 0}, {10, 8}, {0, 8}}), 0U);                                             // a house
  EXPECT_EQ(edges({{1, 0}, {9, 0}, {10, 1}, {10, 7}, {9, 8}, {1, 8}, {0, 7}, {0, 1}}), 0U);             // chamfered
  EXPECT_EQ(edges({{0, 0}, {10, 0}, {11, 1}, {13, 1}, {14, 0}, {20, 0}, {20, 9}, {0, 9}}), 0U);         // a bay
  EXPECT_EQ(edges({{0, 0}, {20, 0.5}, {40, 0}, {60, -1}, {60, 10}, {40, 12}, {20, 11}, {0, 10}}), 0U);  // a row, bent
  EXPECT_EQ(edges({}), 0U);
}

}  // namespace
