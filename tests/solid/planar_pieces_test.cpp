#include "mansard/solid/detail/planar_pieces.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mansard/solid/detail/fitted_plane.hpp"

namespace mansard::solid::detail {
namespace {

using model::Face;
using model::Solid;

/// A pitch of 45° over a plan, with one corner off it.
struct Pitch {
  Solid solid;
  Face face;
  std::vector<Corners> triangles;

  Pitch(std::vector<std::vector<geometry::Point2>> loops, std::size_t off, double by) {
    for (const auto& loop : loops) {
      face.loops.emplace_back();
      for (const auto& p : loop) {
        face.loops.back().push_back(static_cast<std::uint32_t>(solid.vertices.size()));
        solid.vertices.push_back({p.x, p.y, p.y + (solid.vertices.size() == off ? by : 0)});
      }
    }
    face.normal = geometry::normalised(geometry::Point3{0, -1, 1});
    solid.faces.push_back(face);
    EXPECT_TRUE(Triangulator(solid).append(face, face.normal, triangles));
  }
  auto pieces() const -> std::vector<Face> {
    return planar_pieces(solid, face, triangles, [&](const Face& f) { return fitted_plane(solid, f).furthest < 1e-4; });
  }
  auto area(const std::vector<Face>& faces) const -> double {
    double sum = 0;
    for (const auto& f : faces)
      for (const auto& loop : f.loops)
        for (std::size_t i = 0; i < loop.size(); ++i) {
          const auto p = solid.vertices[loop[i]], q = solid.vertices[loop[(i + 1) % loop.size()]];
          sum += (p.x * q.y - q.x * p.y) / 2;
        }
    return sum;
  }
};

TEST(PlanarPieces, a_corner_off_the_plane_costs_one_triangle) {
  const std::vector<geometry::Point2> octagon{{2, 0}, {4, 0}, {6, 2}, {6, 4}, {4, 6}, {2, 6}, {0, 4}, {0, 2}};
  for (std::size_t off = 0; off < octagon.size(); ++off) {
    const Pitch pitch({octagon}, off, 0.002);
    const auto pieces = pitch.pieces();
    ASSERT_EQ(pieces.size(), 2U) << off;
    EXPECT_EQ(pieces[0].loops[0].size(), 7U);
    EXPECT_EQ(pieces[1].loops[0][1], off);
    EXPECT_NEAR(pitch.area(pieces), 28, 1e-12);
  }
}

TEST(PlanarPieces, a_reflex_corner_off_the_plane_leaves_planar_pieces_that_are_put_together) {
  const Pitch pitch({{{0, 0}, {8, 0}, {8, 6}, {5, 6}, {5, 2}, {3, 2}, {3, 6}, {0, 6}}}, 4, 0.003);  // a U
  ASSERT_EQ(pitch.triangles.size(), 6U);
  const auto pieces = pitch.pieces();
  EXPECT_LT(pieces.size(), 6U);
  EXPECT_NEAR(pitch.area(pieces), 40, 1e-12);
  for (const auto& piece : pieces) EXPECT_LT(fitted_plane(pitch.solid, piece).furthest, 1e-4);
}

TEST(PlanarPieces, a_hole_stays_where_a_corner_of_the_outline_is_off) {
  const Pitch pitch({{{0, 0}, {6, 0}, {8, 3}, {6, 6}, {0, 6}}, {{2, 2}, {2, 4}, {4, 4}, {4, 2}}}, 2, 0.002);
  const auto pieces = pitch.pieces();
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_EQ(pieces[0].loops.size(), 2U);
  EXPECT_NEAR(pitch.area(pieces), 38, 1e-12);
}

TEST(PlanarPieces, a_planar_face_of_which_nothing_is_good_stays_in_triangles) {
  const Pitch pitch({{{0, 0}, {4, 0}, {4, 4}, {2, 5}, {0, 4}}}, 0, 0);
  const auto pieces = planar_pieces(pitch.solid, pitch.face, pitch.triangles, [](const Face&) { return false; });
  EXPECT_EQ(pieces.size(), 3U);
  EXPECT_NEAR(pitch.area(pieces), 18, 1e-12);
}

}  // namespace
}  // namespace mansard::solid::detail
