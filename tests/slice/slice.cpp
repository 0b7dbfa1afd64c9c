#include "mansard/slice/slice.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace {

using namespace mansard;
using geometry::Point2;
using geometry::Point3;
using geometry::Segment2;
using slice::cut;

/// Twelve outward triangles.
auto box(Point3 low, Point3 high) -> geometry::Mesh {
  geometry::Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(
        {(i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y, (i & 4) != 0 ? high.z : low.z});
  mesh.triangles = {{0, 1, 5}, {0, 5, 4}, {1, 3, 7}, {1, 7, 5}, {3, 2, 6}, {3, 6, 7},
                    {2, 0, 4}, {2, 4, 6}, {4, 5, 7}, {4, 7, 6}, {0, 2, 3}, {0, 3, 1}};
  return mesh;
}

/// A closed, bumpy ball whose vertices lie on a grid of tenths, so that many fall on planes.
auto ball(base::Random& random, std::uint32_t rings, std::uint32_t sectors) -> geometry::Mesh {
  geometry::Mesh mesh;
  const auto snapped = [](double v) { return std::round(v * 10) / 10; };
  mesh.vertices.push_back({0, 0, -4});
  for (std::uint32_t r = 1; r < rings; ++r)
    for (std::uint32_t s = 0; s < sectors; ++s) {
      const double a = std::numbers::pi * r / rings, b = 2 * std::numbers::pi * s / sectors, l = random.uniform(3, 5);
      const double x = l * std::sin(a) * std::cos(b), y = l * std::sin(a) * std::sin(b), z = -l * std::cos(a);
      mesh.vertices.push_back({snapped(x), snapped(y), snapped(z)});
    }
  mesh.vertices.push_back({0, 0, 4});
  const auto at = [&](std::uint32_t r, std::uint32_t s) { return 1 + (r - 1) * sectors + s % sectors; };
  const auto top = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  for (std::uint32_t s = 0; s < sectors; ++s) {
    mesh.triangles.push_back({0, at(1, s + 1), at(1, s)});
    mesh.triangles.push_back({top, at(rings - 1, s), at(rings - 1, s + 1)});
    for (std::uint32_t r = 1; r + 1 < rings; ++r) {
      mesh.triangles.push_back({at(r, s), at(r, s + 1), at(r + 1, s)});
      mesh.triangles.push_back({at(r + 1, s), at(r, s + 1), at(r + 1, s + 1)});
    }
  }
  return mesh;
}

auto block_of(geometry::Mesh mesh, double ground) -> block::Block {
  block::Block block;
  block.mesh = std::move(mesh);
  block.ground = ground;
  return block;
}

/// Starts minus ends at each point, where that is not zero.
auto imbalance(const std::vector<Segment2>& segments) -> std::map<Point2, int> {
  std::map<Point2, int> sum;
  for (const auto& s : segments) ++sum[s.start], --sum[s.end];
  std::erase_if(sum, [](const auto& entry) { return entry.second == 0; });
  return sum;
}

auto enclosed(const std::vector<Segment2>& segments) -> double {
  double twice = 0;
  for (const auto& s : segments) twice += cross(s.start, s.end);
  return twice / 2;
}

auto segments_of(const slice::SliceStack& stack) -> std::vector<std::vector<Segment2>> {
  std::vector<std::vector<Segment2>> all;
  for (const auto& s : stack.slices) all.push_back(s.segments);
  return all;
}

TEST(Cut, lays_planes_half_an_interval_above_the_ground_and_up_to_the_top) {
  const auto stack = cut(block_of(box({0, 0, 10}, {4, 3, 12}), 10), {});
  EXPECT_EQ(stack.interval, 0.2);
  ASSERT_EQ(stack.slices.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_NEAR(stack.slices[i].height, 10.1 + 0.2 * static_cast<double>(i), 1e-9);
}

TEST(Cut, puts_outside_on_the_left) {
  const auto stack = cut(block_of(box({0, 0, 0}, {4, 3, 2}), 0), {});
  for (const auto& s : stack.slices)
    EXPECT_NEAR(enclosed(s.segments), -12, 1e-9) << "a clockwise curve has its outside on the left";
}

TEST(Cut, gives_segments_that_lie_on_their_triangle) {  // guarantee 1
  const auto stack = cut(block_of(box({0, 0, 0}, {4, 3, 2}), 0), {.interval = 0.3});
  for (const auto& s : stack.slices) {
    EXPECT_EQ(s.segments.size(), 8u);
    for (const auto& [a, b] : s.segments) {
      const auto on_wall = [](Point2 p) { return p.x == 0 || p.x == 4 || p.y == 0 || p.y == 3; };
      EXPECT_TRUE(on_wall(a) && on_wall(b));
      EXPECT_TRUE(a.x == b.x || a.y == b.y) << "two walls in one segment";
    }
  }
}

TEST(Cut, gives_a_closed_curve_for_a_closed_mesh) {  // guarantee 3
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    base::Random random(seed);
    const auto mesh = ball(random, 9, 14);
    for (const double ground : {-5.0, -5.1, -4.97}) {  // planes through many vertices, as many others, none
      const auto stack = cut(block_of(mesh, ground), {.interval = 0.2});
      ASSERT_GT(stack.slices.size(), 40u);
      for (const auto& s : stack.slices)
        EXPECT_TRUE(imbalance(s.segments).empty()) << "seed " << seed << " height " << s.height;
    }
  }
}

TEST(Cut, counts_a_vertex_on_a_plane_as_above_it) {
  geometry::Mesh mesh;  // planes at 0.5 and 1.5; one triangle stands on the lower plane, one hangs from it
  mesh.vertices = {{0, 0, 0.5}, {1, 0, 0.5}, {0, 0, 1},   {5, 0, 0},  {6, 0, 0},
                   {5, 0, 0.5}, {8, 0, 0},   {9, 0, 0.5}, {8, 0, 0.5}};
  mesh.triangles = {{0, 1, 2}};
  const auto standing = cut(block_of(mesh, 0), {.interval = 1});
  ASSERT_EQ(standing.slices.size(), 1u);
  EXPECT_TRUE(standing.slices[0].segments.empty());
  mesh.triangles = {{3, 4, 5}};
  EXPECT_TRUE(cut(block_of(mesh, 0), {.interval = 1}).slices[0].segments.empty()) << "a touch is no segment";
  mesh.triangles = {{6, 7, 8}};
  EXPECT_THAT(cut(block_of(mesh, 0), {.interval = 1}).slices[0].segments, testing::SizeIs(1)) << "an edge in the plane";
}

TEST(Cut, keeps_the_order_of_triangles) {  // guarantee 2
  base::Random random(7);
  auto mesh = ball(random, 8, 12);
  const auto before = segments_of(cut(block_of(mesh, -5), {}));
  std::reverse(mesh.triangles.begin(), mesh.triangles.end());
  auto after = segments_of(cut(block_of(mesh, -5), {}));
  for (auto& s : after) std::reverse(s.begin(), s.end());
  EXPECT_EQ(before, after);
}

TEST(Cut, gives_the_same_at_any_number_of_threads) {  // guarantee 2
  base::Random random(11);
  const auto block = block_of(ball(random, 20, 30), -5);
  base::limit_threads(1);
  const auto one = segments_of(cut(block, {}));
  base::limit_threads(4);
  const auto four = segments_of(cut(block, {}));
  base::limit_threads(0);
  EXPECT_EQ(one, four);
}

TEST(Cut, of_whole_metre_shifts_is_the_shifted_cut) {
  base::Random random(3);
  auto mesh = ball(random, 9, 14);
  const auto here = cut(block_of(mesh, -5.03), {});  // planes between the vertices, so that rounding decides nothing
  for (auto& v : mesh.vertices) v = v + Point3{1024, -4096, 64};
  const auto there = cut(block_of(mesh, 58.97), {});
  ASSERT_EQ(here.slices.size(), there.slices.size());
  for (std::size_t i = 0; i < here.slices.size(); ++i) {
    ASSERT_EQ(here.slices[i].segments.size(), there.slices[i].segments.size());
    for (std::size_t k = 0; k < here.slices[i].segments.size(); ++k) {
      const auto& a = here.slices[i].segments[k];
      const auto& b = there.slices[i].segments[k];
      EXPECT_LT(length(a.start + Point2{1024, -4096} - b.start), 1e-8);
      EXPECT_LT(length(a.end + Point2{1024, -4096} - b.end), 1e-8);
    }
  }
}

TEST(Cut, ignores_what_lies_below_the_ground) {
  const auto stack = cut(block_of(box({0, 0, -50}, {1, 1, 1}), 0), {});
  ASSERT_EQ(stack.slices.size(), 5u);
  EXPECT_EQ(stack.slices.front().segments.size(), 8u);
}

TEST(Cut, of_nothing_is_empty) {
  EXPECT_TRUE(cut(block_of({}, 0), {}).slices.empty());
  EXPECT_TRUE(cut(block_of(box({0, 0, 0}, {1, 1, 1}), 5), {}).slices.empty()) << "all of it below the ground";
  EXPECT_TRUE(cut(block_of(box({0, 0, 0}, {1, 1, 1}), std::nan("")), {}).slices.empty());
}

TEST(Cut, does_not_lay_millions_of_planes_to_a_stray_vertex) {
  auto mesh = box({0, 0, 0}, {1, 1, 1});
  mesh.vertices.push_back({0, 0, 1e12});
  mesh.triangles.push_back({0, 1, 8});
  EXPECT_LE(cut(block_of(mesh, 0), {}).slices.size(), 50'001u);
}

TEST(Cut, stops_when_asked) {
  base::Cancel cancel;
  cancel.request();
  base::Run run;
  run.cancel = &cancel;
  for (const auto& s : cut(block_of(box({0, 0, 0}, {1, 1, 1}), 0), {}, run).slices) EXPECT_TRUE(s.segments.empty());
}

TEST(SliceOptions, are_listed_with_their_default) {
  slice::Options options;
  const auto list = slice::option_list(options);
  ASSERT_NE(list.find("interval"), nullptr);
  EXPECT_EQ(list.find("interval")->get(), "0.2");
  EXPECT_FALSE(list.find("interval")->set("0"));
  EXPECT_TRUE(list.find("interval")->set("0.5"));
  EXPECT_EQ(options.interval, 0.5);
}

}  // namespace
