#include <gmock/gmock.h>

#include "mansard/extrude/extrude.hpp"
#include "plans.hpp"

namespace {

using namespace plans;
using extrude::Face;
using extrude::Solid;

auto codes_of(const Solid& solid, double planar = 1e-4) -> std::vector<std::string> {
  std::vector<std::string> out;
  for (const auto& fault : extrude::check(solid, planar)) out.push_back(fault.code);
  return out;
}

/// A cube of 2 m at a place.
auto cube(Point3 at = {}) -> Solid {
  auto solid = *extrude::prism(plan(box(2, 2), {wall}, {}, 2));
  for (Point3& p : solid.vertices) p = p + at;
  return solid;
}

/// Both in one, faces and vertices side by side.
auto together(Solid a, const Solid& b) -> Solid {
  const auto first = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (Face face : b.faces) {
    for (auto& loop : face.loops)
      for (auto& v : loop) v += first;
    a.faces.push_back(std::move(face));
  }
  return a;
}

TEST(Check, finds_nothing_wrong_with_a_cube) { EXPECT_THAT(codes_of(cube()), testing::IsEmpty()); }

TEST(Check, finds_nothing_wrong_with_two_cubes_apart) {
  EXPECT_THAT(codes_of(together(cube(), cube({2.001, 0, 0}))), testing::IsEmpty());
}

TEST(Check, finds_a_missing_face) {
  Solid solid = cube();
  solid.faces.pop_back();
  EXPECT_THAT(codes_of(solid), testing::Contains("solid-open"));
}

TEST(Check, finds_a_face_turned_over) {
  Solid solid = cube();
  std::ranges::reverse(solid.faces[2].loops[0]);
  EXPECT_THAT(codes_of(solid), testing::Contains("solid-orientation"));
  EXPECT_THAT(codes_of(solid), testing::Contains("solid-open"));
}

TEST(Check, finds_a_solid_inside_out) {
  Solid solid = cube();
  for (Face& face : solid.faces) {
    std::ranges::reverse(face.loops[0]);
    face.normal = -1.0 * face.normal;
  }
  EXPECT_THAT(codes_of(solid), testing::ElementsAre("solid-orientation"));
}

TEST(Check, finds_a_normal_that_looks_inward) {
  Solid solid = cube();
  solid.faces[3].normal = -1.0 * solid.faces[3].normal;
  EXPECT_THAT(codes_of(solid), testing::ElementsAre("solid-orientation"));
}

TEST(Check, finds_a_shared_edge_with_four_faces) {
  // Two cubes that share an edge: its two vertices are one in both.
  Solid solid = together(cube(), cube({2, 2, 0}));
  for (Face& face : solid.faces)
    for (auto& loop : face.loops)
      for (auto& v : loop)
        for (std::uint32_t old = 0; old < 8; ++old)
          if (v >= 8 && solid.vertices[v] == solid.vertices[old]) v = old;
  EXPECT_THAT(codes_of(solid), testing::Contains("solid-non-manifold"));
}

TEST(Check, finds_a_shared_vertex_with_two_fans) {
  Solid solid = together(cube(), cube({2, 2, 2}));
  for (Face& face : solid.faces)
    for (auto& loop : face.loops)
      for (auto& v : loop)
        if (v >= 8 && solid.vertices[v] == Point3{2, 2, 2})
          v = static_cast<std::uint32_t>(std::ranges::find(solid.vertices, Point3{2, 2, 2}) - solid.vertices.begin());
  EXPECT_THAT(codes_of(solid), testing::ElementsAre("solid-non-manifold"));
}

TEST(Check, finds_a_bent_face_by_its_limit) {
  Solid solid = cube();
  const auto corner = std::ranges::find(solid.vertices, Point3{2, 2, 2});
  corner->z += 0.001;
  EXPECT_THAT(codes_of(solid), testing::ElementsAre("solid-not-planar"));
  EXPECT_THAT(codes_of(solid, 0.01), testing::IsEmpty());
}

TEST(Check, finds_solids_that_overlap_touch_or_hold_each_other) {
  EXPECT_THAT(codes_of(together(cube(), cube({1, 0.5, 0.7}))), testing::ElementsAre("solid-self-intersection"));
  EXPECT_THAT(codes_of(together(cube(), cube({2, 0.5, 0.7}))),
              testing::ElementsAre("solid-self-intersection"));  // face on face
  EXPECT_THAT(codes_of(together(cube(), cube({1, 1, 2}))), testing::ElementsAre("solid-self-intersection"));
  EXPECT_THAT(codes_of(together(cube(), cube({1, 0, 0}))),
              testing::ElementsAre("solid-self-intersection"));  // coplanar sides
}

TEST(Check, finds_a_vertex_that_touches_a_face) {
  // A tetrahedron standing on its tip on the cube's lid.
  Solid tip;
  tip.vertices = {{1, 1, 2}, {0, 0, 3}, {2, 0, 3}, {1, 2, 3}};
  for (const auto& loop : std::vector<std::vector<std::uint32_t>>{{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}}) {
    Face face;
    face.loops = {loop};
    face.normal =
        normalised(cross(tip.vertices[loop[1]] - tip.vertices[loop[0]], tip.vertices[loop[2]] - tip.vertices[loop[0]]));
    tip.faces.push_back(face);
  }
  EXPECT_THAT(codes_of(tip), testing::IsEmpty());
  EXPECT_THAT(codes_of(together(cube(), tip)), testing::ElementsAre("solid-self-intersection"));
}

TEST(Check, finds_a_vertex_pushed_through_the_far_side) {
  auto solid = extrude::raise(plan(box(10, 10), {hip}))->solid;
  ASSERT_THAT(codes_of(solid), testing::IsEmpty());
  for (Point3& p : solid.vertices)
    if (p.z > 7) p.z = -1;  // the apex comes out below the ground floor
  EXPECT_THAT(codes_of(solid, 10), testing::Contains("solid-self-intersection"));
}

TEST(Check, finds_a_face_whose_boundary_crosses_itself) {
  Solid solid = cube();
  std::swap(solid.faces.back().loops[0][1], solid.faces.back().loops[0][2]);
  EXPECT_FALSE(codes_of(solid).empty());
}

TEST(Check, finds_degenerate_faces_and_vertices) {
  Solid repeated = cube();
  repeated.faces[1].loops[0].push_back(repeated.faces[1].loops[0][1]);
  EXPECT_THAT(codes_of(repeated), testing::ElementsAre("solid-degenerate"));
  Solid flat = cube();
  flat.faces[1].loops[0].resize(2);
  EXPECT_THAT(codes_of(flat), testing::ElementsAre("solid-degenerate"));
  Solid twice = cube();
  twice.vertices.push_back(twice.vertices[0]);
  twice.faces[1].loops[0][0] = 8;
  EXPECT_THAT(codes_of(twice), testing::Contains("solid-degenerate"));
  Solid nowhere = cube();
  nowhere.vertices[3].x = std::nan("");
  EXPECT_THAT(codes_of(nowhere), testing::ElementsAre("solid-degenerate"));
  Solid beyond = cube();
  beyond.faces[0].loops[0][0] = 99;
  EXPECT_THAT(codes_of(beyond), testing::ElementsAre("solid-degenerate"));
  EXPECT_THAT(codes_of({}), testing::ElementsAre("solid-degenerate"));
}

TEST(Triangulate, covers_every_face_with_its_own_vertices) {
  const auto solid =
      extrude::raise(plan(box(20, 20), {setback}, {}, 6, {turned_in({{8, 8}, {12, 8}, {12, 12}, {8, 12}})}))->solid;
  const auto triangulated = extrude::triangulate(solid);
  ASSERT_TRUE(triangulated);
  std::vector<double> area(solid.faces.size(), 0);
  for (std::size_t i = 0; i < triangulated->triangles.size(); ++i) {
    const auto& t = triangulated->triangles[i];
    const std::uint32_t f = triangulated->face_of[i];
    const Point3 n = cross(solid.vertices[t[1]] - solid.vertices[t[0]], solid.vertices[t[2]] - solid.vertices[t[0]]);
    EXPECT_GT(dot(n, solid.faces[f].normal), 0);
    area[f] += length(n) / 2;
  }
  for (std::size_t f = 0; f < area.size(); ++f) EXPECT_NEAR(area[f], extrude::area(solid, solid.faces[f]), 1e-6);
  // Closed as triangles too: no T-junctions.
  std::multiset<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& t : triangulated->triangles)
    for (std::size_t i = 0; i < 3; ++i) edges.emplace(t[i], t[(i + 1) % 3]);
  for (const auto& [a, b] : edges) EXPECT_EQ(edges.count({b, a}), 1U);
}

TEST(Volume, does_not_depend_on_the_place) {
  Solid solid = cube();
  EXPECT_DOUBLE_EQ(extrude::volume(solid), 8);
  for (Point3& p : solid.vertices) p = p + Point3{500000, 4000000, 100};
  EXPECT_DOUBLE_EQ(extrude::volume(solid), 8);
  EXPECT_DOUBLE_EQ(extrude::area(solid, solid.faces[0]), 4);
}

}  // namespace
