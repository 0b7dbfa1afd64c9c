#include <gmock/gmock.h>

#include <numbers>

#include "extrude/plans.hpp"
#include "mansard/extrude/extrude.hpp"
#include "mansard/solid/solid.hpp"

namespace {

namespace extrude = mansard::extrude;
namespace solid = mansard::solid;

namespace model = mansard::model;

using namespace plans;
using model::Face;
using model::Solid;

auto codes_of(const Solid& solid, double planar = 1e-4) -> std::vector<std::string> {
  std::vector<std::string> out;
  for (const auto& fault : solid::check(solid, {.planar = planar})) out.push_back(fault.code);
  return out;
}

auto written_codes_of(const Solid& solid) -> std::vector<std::string> {
  std::vector<std::string> out;
  for (const auto& fault : solid::check(solid, solid::written_rules())) out.push_back(fault.code);
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

TEST(Check, asks_of_the_corners_and_not_of_the_normal_whether_a_face_is_planar) {
  // A narrow roof of 12 m: a normal that is off by the two decimals of a degree of a file seems to bend it.
  Solid solid = *extrude::prism(plan(box(12, 2), {wall}, {}, 2));
  for (Face& face : solid.faces)
    if (face.kind == model::FaceKind::cap) face.normal = normalised(Point3{1e-4, 0, 1});
  EXPECT_THAT(codes_of(solid), testing::IsEmpty());
  solid.vertices[5].z += 0.01;
  EXPECT_THAT(codes_of(solid), testing::Contains("solid-not-planar"));
}

TEST(Check, finds_the_least_bend_of_a_narrow_face) {
  // 10 m long and 1 cm wide, its corners 0.05 mm to either side of a plane that Newell's normal misses.
  mansard::base::Random random(5);
  for (int round = 0; round < 200; ++round) {
    Solid solid = *extrude::prism(plan(box(10, 0.01), {wall}, {}, 2));
    for (Point3& p : solid.vertices) p = p + Point3{0, 0, random.uniform(-0.9e-4, 0.9e-4)};
    for (Face& face : solid.faces) face.normal = {};
    for (const auto& code : codes_of(solid)) EXPECT_NE(code, "solid-not-planar") << "round " << round;
  }
}

TEST(Check, finds_a_face_whose_area_is_rounding) {
  // Three corners of a line, in coordinates of 100 km: their products are off by more than the area of any dust.
  for (const double far : {0.0, 1234.5678, 98765.4321}) {
    Solid solid = cube({far, far, 0});
    const auto n = static_cast<std::uint32_t>(solid.vertices.size());
    solid.vertices.push_back({far + 0.1, far + 0.3, 2});
    solid.vertices.push_back({far + 0.2, far + 0.6, 2});
    solid.vertices.push_back({far + 0.4, far + 1.2, 2});
    Face sliver;
    sliver.loops = {{n, n + 1, n + 2}};
    sliver.normal = {0, 0, 1};
    solid.faces.push_back(sliver);
    const auto faults = solid::check(solid);
    ASSERT_FALSE(faults.empty());
    EXPECT_EQ(faults[0].code, "solid-degenerate");
    EXPECT_THAT(faults[0].message, testing::HasSubstr("has no area"));
  }
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

TEST(Check, finds_a_courtyard_that_touches_the_outline) {
  // At the corner (5, 0, 0) all faces are in one fan. val3dity 2.6: 303, where rounding lets no faces intersect, too.
  const std::vector<Point2> low{{0, 0}, {5, 0}, {3, 4}, {5, 4}, {5, 10}, {0, 10}},
      high{{5, 0}, {10, 0}, {10, 10}, {5, 10}, {5, 4}, {7, 4}};
  Solid solid;
  const auto at = [&](Point2 p, double z) {
    const Point3 v{p.x, p.y, z};
    const auto found = std::ranges::find(solid.vertices, v);
    if (found != solid.vertices.end()) return static_cast<std::uint32_t>(found - solid.vertices.begin());
    solid.vertices.push_back(v);
    return static_cast<std::uint32_t>(solid.vertices.size() - 1);
  };
  const auto add = [&](std::vector<std::vector<std::uint32_t>> loops, Point3 normal) {
    solid.faces.push_back({std::move(loops), model::FaceKind::side, {}, normal});
  };
  const auto roof = [&](const std::vector<Point2>& ring, double z) {
    std::vector<std::uint32_t> loop;
    for (const Point2 p : ring) loop.push_back(at(p, z));
    add({loop}, {0, 0, 1});
  };
  const auto wall_of = [&](Point2 a, Point2 b, double low_z, double high_z) {
    const Point3 normal{b.y - a.y, a.x - b.x, 0};
    add({{at(a, low_z), at(b, low_z), at(b, high_z), at(a, high_z)}}, normal);
  };
  roof(low, 3);
  roof(high, 5);
  const std::vector<std::pair<Point2, Point2>> of_low{
      {{0, 0}, {5, 0}}, {{5, 0}, {3, 4}}, {{3, 4}, {5, 4}}, {{5, 10}, {0, 10}}, {{0, 10}, {0, 0}}},
      of_high{{{5, 0}, {10, 0}}, {{10, 0}, {10, 10}}, {{10, 10}, {5, 10}}, {{7, 4}, {5, 0}}};
  for (const auto& [a, b] : of_low) wall_of(a, b, 0, 3);
  for (const auto& [a, b] : of_high) wall_of(a, b, 0, 5);
  // At the ends of the step the walls of the higher part have its foot as a corner.
  solid.faces.pop_back(), solid.faces.pop_back();
  add({{at({10, 10}, 0), at({5, 10}, 0), at({5, 10}, 3), at({5, 10}, 5), at({10, 10}, 5)}}, {0, 1, 0});
  wall_of({7, 4}, {5, 0}, 0, 5);
  add({{at({5, 4}, 0), at({7, 4}, 0), at({7, 4}, 5), at({5, 4}, 5), at({5, 4}, 3)}}, {0, -1, 0});
  wall_of({5, 10}, {5, 4}, 3, 5);
  std::vector<std::uint32_t> outer, hole;
  for (const Point2 p : {Point2{0, 10}, {5, 10}, {10, 10}, {10, 0}, {5, 0}, {0, 0}}) outer.push_back(at(p, 0));
  for (const Point2 p : {Point2{5, 0}, {7, 4}, {5, 4}, {3, 4}}) hole.push_back(at(p, 0));
  add({outer, hole}, {0, 0, -1});
  EXPECT_THAT(written_codes_of(solid), testing::Contains("solid-non-manifold"));
}

TEST(Check, finds_a_bent_face_by_its_limit) {
  Solid solid = cube();
  const auto corner = std::ranges::find(solid.vertices, Point3{2, 2, 2});
  corner->z += 0.001;
  EXPECT_THAT(codes_of(solid), testing::ElementsAre("solid-not-planar"));
  EXPECT_THAT(codes_of(solid, 0.01), testing::IsEmpty());
}

/// A shed of 20 by 10 m under a roof of 27°, with a corner of the eaves a tenth of a millimetre low between two others
/// near it. Seen from above the eaves are straight; validators, which cut the roof as they see it, make a needle there.
TEST(Check, finds_needles_that_validators_make_of_corners_nearly_on_a_line) {
  Solid shed;
  shed.vertices = {{0, 0, 0},       {20, 0, 0}, {20, 10, 0}, {0, 10, 0}, {0, 0, 3}, {10, 0, 3}, {10.0183, 0, 2.9999},
                   {10.0367, 0, 3}, {20, 0, 3}, {20, 10, 8}, {0, 10, 8}};
  for (const std::vector<std::uint32_t>& loop : std::vector<std::vector<std::uint32_t>>{
           {0, 3, 2, 1}, {0, 1, 8, 7, 6, 5, 4}, {1, 2, 9, 8}, {2, 3, 10, 9}, {3, 0, 4, 10}, {4, 5, 6, 7, 8, 9, 10}})
    shed.faces.push_back(Face{{loop}, model::FaceKind::side, {}, {}});
  EXPECT_THAT(codes_of(shed), testing::IsEmpty());
  EXPECT_THAT(written_codes_of(shed), testing::ElementsAre("solid-needle"));
}

TEST(Check, finds_faces_too_narrow_for_their_plane) {
  for (const double width : {1.2e-3, 1.2}) {
    Solid strip = cube();
    for (auto& v : strip.vertices) v = {v.x * width, v.y * 14, v.z};
    if (width < 1) {
      EXPECT_THAT(written_codes_of(strip), testing::ElementsAre("solid-not-planar"));
    } else {
      EXPECT_THAT(written_codes_of(strip), testing::IsEmpty());
    }
  }
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

TEST(Triangulate, refuses_a_vertex_that_is_nowhere) {
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    Solid nowhere = cube();
    nowhere.vertices[3].y = bad;
    const auto triangulated = solid::triangulate(nowhere);
    ASSERT_FALSE(triangulated);
    EXPECT_EQ(triangulated.error().code, "solid-degenerate");
  }
}

TEST(Triangulate, covers_every_face_with_its_own_vertices) {
  const auto solid =
      extrude::raise(plan(box(20, 20), {setback}, {}, 6, {turned_in({{8, 8}, {12, 8}, {12, 12}, {8, 12}})}))->solid;
  const auto triangulated = solid::triangulate(solid);
  ASSERT_TRUE(triangulated);
  std::vector<double> area(solid.faces.size(), 0);
  for (std::size_t i = 0; i < triangulated->triangles.size(); ++i) {
    const auto& t = triangulated->triangles[i];
    const std::uint32_t f = triangulated->face_of[i];
    const Point3 n = cross(solid.vertices[t[1]] - solid.vertices[t[0]], solid.vertices[t[2]] - solid.vertices[t[0]]);
    EXPECT_GT(dot(n, solid.faces[f].normal), 0);
    area[f] += length(n) / 2;
  }
  for (std::size_t f = 0; f < area.size(); ++f) EXPECT_NEAR(area[f], solid::area(solid, solid.faces[f]), 1e-6);
  // Closed as triangles too: no T-junctions.
  std::multiset<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& t : triangulated->triangles)
    for (std::size_t i = 0; i < 3; ++i) edges.emplace(t[i], t[(i + 1) % 3]);
  for (const auto& [a, b] : edges) EXPECT_EQ(edges.count({b, a}), 1U);
}

/// A many-sided drum: its floor and lid are large level faces.
auto drum(std::size_t sides, double r = 10) -> Solid {
  Ring ring;
  for (std::size_t i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(sides);
    ring.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  return *extrude::prism(plan(ring, {wall}, {}, 5));
}

TEST(Check, finds_what_pierces_or_touches_a_large_level_face) {
  const Solid large = drum(150);
  EXPECT_THAT(codes_of(large), testing::IsEmpty());
  EXPECT_THAT(codes_of(together(large, cube({0, 0, 6}))), testing::IsEmpty());
  EXPECT_THAT(codes_of(together(large, cube({0, 0, 1}))), testing::IsEmpty());  // a second shell inside
  const auto crossing = testing::ElementsAre("solid-self-intersection");
  EXPECT_THAT(codes_of(together(large, cube({0, 0, 4}))), crossing);  // through the lid
  EXPECT_THAT(codes_of(together(large, cube({0, 0, 5}))), crossing);  // stands on the lid
  EXPECT_THAT(codes_of(together(large, cube({0, 0, 3}))), crossing);  // hangs from it
  EXPECT_THAT(codes_of(together(large, drum(150, 5))), crossing);     // floor in floor
  auto above = drum(150, 5);
  for (Point3& p : above.vertices) p.z += 5;
  EXPECT_THAT(codes_of(together(large, above)), crossing);  // floor on lid
  for (Point3& p : above.vertices) p.z += 0.001;
  EXPECT_THAT(codes_of(together(large, above)), testing::IsEmpty());
}

TEST(Check, finds_a_wall_that_leans_over_a_large_level_face) {
  // Two corners of the lid's rim change places: walls cross each other, and the lid's boundary itself.
  Solid solid = drum(150);
  std::swap(solid.vertices[160], solid.vertices[200]);
  EXPECT_THAT(codes_of(solid, 100), testing::Contains("solid-self-intersection"));
}

TEST(Check, finds_holes_outside_across_and_within_holes) {
  const auto lid_with = [](std::vector<Ring> holes) {
    Solid solid = *extrude::prism(plan(box(20, 20), {wall}, {}, 5, std::move(holes)));
    return solid;
  };
  const Solid good = lid_with({turned_in({{2, 2}, {5, 2}, {5, 5}, {2, 5}}), turned_in({{8, 8}, {11, 8}, {11, 15}})});
  EXPECT_THAT(codes_of(good), testing::IsEmpty());
  const auto moved = [&](double x, double y) {  // the triangle
    Solid solid = good;
    for (Point3& p : solid.vertices)
      if (p.x >= 8 && p.x <= 11 && p.y >= 8 && p.y <= 15) p = p + Point3{x, y, 0};
    return solid;
  };
  EXPECT_THAT(codes_of(moved(5, -6)), testing::IsEmpty());
  EXPECT_THAT(codes_of(moved(10, 0)), testing::ElementsAre("solid-self-intersection"));   // over the outline
  EXPECT_THAT(codes_of(moved(30, 0)), testing::ElementsAre("solid-self-intersection"));   // outside of it
  EXPECT_THAT(codes_of(moved(-5, -7)), testing::ElementsAre("solid-self-intersection"));  // over the other hole
}

TEST(Check, finds_an_edge_that_touches_an_edge) {
  // A tetrahedron whose upper edge lies across an upper edge of the cube from outside.
  Solid tip;
  tip.vertices = {{1.5, 1, 2}, {2.5, 1, 2}, {2.4, 0.5, 1}, {2.4, 1.5, 1}};
  for (const auto& loop : std::vector<std::vector<std::uint32_t>>{{0, 1, 3}, {0, 2, 1}, {0, 3, 2}, {1, 2, 3}}) {
    Face face;
    face.loops = {loop};
    tip.faces.push_back(face);
  }
  EXPECT_THAT(codes_of(tip), testing::IsEmpty());
  for (const double shift : {0.5, 0.0}) {  // touching with the end; lying across
    Solid moved = tip;
    for (Point3& p : moved.vertices) p.x += shift;
    EXPECT_THAT(codes_of(together(cube(), moved)), testing::ElementsAre("solid-self-intersection")) << shift;
  }
  for (Point3& p : tip.vertices) p.x += 0.51;
  EXPECT_THAT(codes_of(together(cube(), tip)), testing::IsEmpty());
}

TEST(Check, gives_the_same_verdict_far_from_the_origin) {
  for (const Point3 at : {Point3{}, Point3{524288, 4194304, 128}}) {
    EXPECT_THAT(codes_of(together(cube(at), cube(at + Point3{2, 0.5, 0.5}))),
                testing::ElementsAre("solid-self-intersection"));
    EXPECT_THAT(codes_of(together(cube(at), cube(at + Point3{2 + 0x1.0p-20, 0.5, 0.5}))), testing::IsEmpty());
  }
}

TEST(Triangulate, covers_stars_combs_and_faces_with_holes) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    base::Random random(seed);
    Ring ring = seed % 2 == 0 ? star(random, 5 + random.index(60)) : Ring{};
    while (ring.empty()) ring = rectilinear(random, 6 + random.index(14));
    std::vector<Ring> holes;
    if (seed % 2 == 0)  // inside of every star
      for (const Point2 at : {Point2{1, 0}, Point2{-1.5, 0.5}, Point2{0, -1.7}})
        holes.push_back(turned_in({at, at + Point2{0.5, 0.1}, at + Point2{0.4, 0.6}, at + Point2{0.1, 0.2}}));
    const Plan p = turned(plan(ring, {wall}, {}, 5, holes), seed % 3 == 0 ? 0 : 0.3);
    const auto solid = *extrude::prism(p);
    EXPECT_EQ(faults(solid), "");
    const auto triangulated = solid::triangulate(solid);
    ASSERT_TRUE(triangulated);
    std::vector<double> area(solid.faces.size(), 0);
    std::multiset<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (std::size_t i = 0; i < triangulated->triangles.size(); ++i) {
      const auto& t = triangulated->triangles[i];
      const std::uint32_t f = triangulated->face_of[i];
      const Point3 n = cross(solid.vertices[t[1]] - solid.vertices[t[0]], solid.vertices[t[2]] - solid.vertices[t[0]]);
      EXPECT_GT(dot(n, solid.faces[f].normal), 1e-9);  // corners on a line make no triangle
      area[f] += length(n) / 2;
      for (std::size_t k = 0; k < 3; ++k) edges.emplace(t[k], t[(k + 1) % 3]);
    }
    for (std::size_t f = 0; f < area.size(); ++f) EXPECT_NEAR(area[f], solid::area(solid, solid.faces[f]), 1e-9);
    for (const auto& [a, b] : edges) EXPECT_EQ(edges.count({b, a}), 1U);
  }
}

TEST(Volume, does_not_depend_on_the_place) {
  Solid solid = cube();
  EXPECT_DOUBLE_EQ(solid::volume(solid), 8);
  for (Point3& p : solid.vertices) p = p + Point3{500000, 4000000, 100};
  EXPECT_DOUBLE_EQ(solid::volume(solid), 8);
  EXPECT_DOUBLE_EQ(solid::area(solid, solid.faces[0]), 4);
}

}  // namespace
