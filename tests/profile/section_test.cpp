#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mansard/profile/detail/section_index.hpp"
#include "profile/houses.hpp"

namespace {

using mansard::geometry::Mesh;
using mansard::geometry::Point2;
using mansard::geometry::Point3;
using mansard::profile::detail::Piece;
using mansard::profile::detail::SectionIndex;
using mansard::profile::detail::SectionPlane;

/// Every triangle against the plane, without an index and without clipping.
auto slow_cut(const Mesh& mesh, const SectionPlane& plane) -> std::vector<Piece> {
  std::vector<Piece> pieces;
  const Point2 across = mansard::geometry::left_of(plane.direction);
  for (const auto& t : mesh.triangles) {
    std::vector<mansard::profile::detail::SectionPoint> ends;
    for (int i = 0; i < 3; ++i) {
      const Point3 p = mesh.vertices[t[i]], q = mesh.vertices[t[(i + 1) % 3]];
      const double a = dot(mansard::geometry::xy(p) - plane.foot, across);
      const double b = dot(mansard::geometry::xy(q) - plane.foot, across);
      if ((a >= 0) == (b >= 0)) continue;
      const Point3 r = p + (a / (a - b)) * (q - p);
      ends.push_back({dot(mansard::geometry::xy(r) - plane.foot, plane.direction), r.z});
    }
    if (ends.size() != 2) continue;
    if (ends[0].height > ends[1].height) std::swap(ends[0], ends[1]);
    pieces.push_back({ends[0], ends[1]});
  }
  return pieces;
}

auto length_of(const Piece& piece, double from, double to) -> double {
  const double run = std::abs(piece.high.inward - piece.low.inward);
  const double whole = std::hypot(run, piece.high.height - piece.low.height);
  const double low = std::min(piece.low.inward, piece.high.inward);
  if (run == 0) return low >= from && low <= to ? whole : 0;
  return whole * std::max(0.0, std::min(low + run, to) - std::max(low, from)) / run;
}

TEST(Section, is_the_same_as_without_an_index) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    mansard::base::Random random(seed);
    Mesh mesh;
    const double size = random.index(2) == 0 ? 1.5 : 30;
    for (std::uint32_t i = 0; i < 300; ++i) {
      const Point3 at{random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(0, 9)};
      for (int k = 0; k < 3; ++k)
        mesh.vertices.push_back(at + Point3{random.uniform(0, size), random.uniform(0, size), random.uniform(0, 2)});
      mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    const SectionIndex index(mesh);
    for (int k = 0; k < 20; ++k) {
      // Some along the axes, some leaving the mesh, some beside it.
      const double angle = k < 4 ? k * 1.5707963267948966 : random.uniform(0, 6.28);
      SectionPlane plane{{random.uniform(-30, 30), random.uniform(-30, 30)}, {std::cos(angle), std::sin(angle)}, 0, 0};
      if (k < 4) plane.direction = {std::round(plane.direction.x), std::round(plane.direction.y)};
      plane.from = random.uniform(-10, 0);
      plane.to = random.uniform(0, 60);
      double expected = 0, got = 0;
      for (const auto& piece : slow_cut(mesh, plane)) expected += length_of(piece, plane.from, plane.to);
      for (const auto& piece : index.cut(plane)) {
        EXPECT_LE(piece.low.height, piece.high.height);
        EXPECT_GE(std::min(piece.low.inward, piece.high.inward), plane.from);
        EXPECT_LE(std::max(piece.low.inward, piece.high.inward), plane.to);
        got += length_of(piece, plane.from, plane.to);
      }
      EXPECT_NEAR(got, expected, 1e-9 * (1 + expected));
    }
  }
}

TEST(Section, joins_pieces_exactly_where_triangles_share_an_edge) {
  houses::House house;
  house.roof = houses::gable(9, 0.7);
  house.walls = false;
  const auto mesh = houses::scan(house);
  const auto inward = Point2{-std::sin(house.turned), std::cos(house.turned)};
  const auto pieces = SectionIndex(mesh).cut({houses::placed(house, 7.03, 0), inward, 0.5, 8.5});
  ASSERT_GT(pieces.size(), 20U);
  // Every end but the window's two is the end of two pieces, to the bit.
  std::vector<std::pair<double, double>> ends;
  for (const auto& p : pieces) {
    ends.emplace_back(p.low.inward, p.low.height);
    ends.emplace_back(p.high.inward, p.high.height);
  }
  std::ranges::sort(ends);
  std::size_t alone = 0;
  for (std::size_t i = 0; i < ends.size(); ++i)
    alone += (i == 0 || ends[i] != ends[i - 1]) && (i + 1 == ends.size() || ends[i] != ends[i + 1]) ? 1 : 0;
  EXPECT_EQ(alone, 2U);
}

TEST(Section, counts_a_vertex_on_the_plane_once) {
  // Two triangles with a corner on the plane x = 0, one on each side, and a wall lying in it.
  const Mesh mesh{{{0, 0, 0}, {-1, 1, 0}, {-1, 2, 1}, {1, 1, 0}, {1, 2, 1}, {0, 5, 0}, {0, 6, 0}, {0, 5, 3}},
                  {{0, 1, 2}, {0, 3, 4}, {5, 6, 7}}};
  const auto pieces = SectionIndex(mesh).cut({{0, -1}, {0, 1}, 0, 10});
  EXPECT_LE(pieces.size(), 1U);
  for (const auto& piece : pieces) EXPECT_EQ(piece.low.inward, piece.high.inward);
}

TEST(Section, of_an_empty_mesh_is_empty) { EXPECT_TRUE(SectionIndex({}).cut({{0, 0}, {1, 0}, -1, 1}).empty()); }

}  // namespace
