#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "case.hpp"

namespace mansard::segment {
namespace {

using geometry::Point2;
using testing::AsciiMap, testing::Case, testing::expect_guarantees, testing::plain, testing::sweep_edges;

TEST(Choose, cuts_where_a_sweep_edge_runs_between_two_heights) {
  Case c = plain({"AABB", "AABB"}, {{'A', 10}, {'B', 14}}, {"AB"});
  c.map.wall({10, 0}, {10, 10}, 0);
  const Segmentation s = c.run();
  expect_guarantees(c.map.arrangement, s);
  EXPECT_EQ(s.status, "optimal");
  ASSERT_EQ(s.parts.size(), 2U);
  EXPECT_EQ(s.parts[0].height, 10);
  EXPECT_EQ(s.parts[1].height, 14);
  ASSERT_EQ(s.candidates.size(), 1U);
  EXPECT_TRUE(s.candidates[0].sweep && s.candidates[0].chosen);
  EXPECT_NEAR(s.candidates[0].length, 10, 1e-9);
  EXPECT_NEAR(s.candidates[0].amounts[Term::height], 4, 1e-9);
  EXPECT_NEAR(s.objective, 0, 1e-9);
}

TEST(Choose, joins_where_nothing_supports_a_wall) {
  Case c = plain({"AABB", "AABB"}, {{'A', 10}, {'B', 14}}, {"AB"});
  const Segmentation s = c.run();
  expect_guarantees(c.map.arrangement, s);
  ASSERT_EQ(s.parts.size(), 1U);
  EXPECT_NEAR(s.terms[Term::height], 10 * 4, 1e-6);  // O2: 10 m by 4 m
  EXPECT_THAT(s.parts[0].polygon.outer, ::testing::SizeIs(4)) << "collinear corners are dropped";
}

TEST(Choose, cuts_without_support_once_the_height_step_pays_for_it) {
  Case c = plain({"AABB", "AABB"}, {{'A', 10}, {'B', 75}}, {"AB"});
  EXPECT_EQ(c.run().parts.size(), 2U) << "65 m of height against β = 60";
  c.heights['B'] = 65;
  EXPECT_EQ(c.run().parts.size(), 1U) << "55 m";
  c.options.height_weight = 2;
  const Segmentation s = c.run();
  EXPECT_EQ(s.parts.size(), 2U);
  EXPECT_NEAR(s.terms[Term::unsupported], 60 * 10, 1e-6);
}

TEST(Choose, pays_for_every_stretch_of_an_edge_by_itself) {
  Case c = plain({"AABB", "AABB", "AABB"}, {{'A', 10}, {'B', 10}}, {"AB"});
  c.map.wall({10, 0}, {10, 10}, 0);  // 10 of 15 m: leaving it costs 400, using all of it 300
  Segmentation s = c.run();
  EXPECT_EQ(s.parts.size(), 2U);
  EXPECT_TRUE(s.candidates[0].sweep);
  EXPECT_NEAR(s.objective, 300, 1e-6);
  c.options.alpha = 20;  // 200
  s = c.run();
  EXPECT_EQ(s.parts.size(), 1U);
  EXPECT_NEAR(s.terms[Term::sweep_unused], 200, 1e-6);
}

TEST(Choose, reads_continuations_as_told) {
  Case c = plain({"AABB", "AABB"}, {{'A', 10}, {'B', 10}}, {"AB"});
  c.map.wall({10, 0}, {10, 10}, 0, fracture::Kind::continuation);
  EXPECT_EQ(c.run().parts.size(), 1U);
  c.options.continuations = Continuations::sweep;
  const Segmentation s = c.run();
  EXPECT_EQ(s.parts.size(), 2U);
  EXPECT_TRUE(s.candidates[0].sweep);
}

TEST(Choose, lets_no_part_span_two_features_unless_told_to) {
  Case c = plain({"AABBCC", "AABBCC"}, {{'A', 10}, {'B', 10}, {'C', 10}}, {"A", "BC"});
  Segmentation s = c.run();
  expect_guarantees(c.map.arrangement, s);
  ASSERT_EQ(s.parts.size(), 2U);
  EXPECT_EQ(s.parts[0].feature, 0U);
  EXPECT_EQ(s.parts[1].feature, 1U);
  EXPECT_EQ(c.part(s, 'B'), c.part(s, 'C'));
  c.options.gis_edges = GisEdges::ignore;
  s = c.run();
  EXPECT_EQ(s.parts.size(), 1U);
  EXPECT_EQ(s.parts[0].feature, 1U) << "the larger share";
}

TEST(Choose, charges_no_beta_for_edges_between_features) {
  Case c = plain({"AABB", "AABB"}, {{'A', 10}, {'B', 10}}, {"A", "B"});
  c.map.wall({10, 0}, {10, 10}, gis_source + 0);
  const Segmentation s = c.run();
  EXPECT_EQ(s.parts.size(), 2U);
  EXPECT_FALSE(s.candidates[0].sweep);
  EXPECT_NEAR(s.objective, 0, 1e-9);
}

TEST(Choose, uses_no_fewer_metres_of_sweep_edge_with_a_greater_alpha) {
  base::Random random(5);
  for (int round = 0; round < 6; ++round) {
    AsciiMap map({"AABBCCDD", "AABBCCDD", "EEFFGGHH", "EEFFGGHH", "IIJJKKLL", "IIJJKKLL"}, 3);
    Case c{map, {}, {"ABCDEFGHIJKL"}, {}};
    for (const char l : std::string("ABCDEFGHIJKL")) c.heights[l] = 8 + 6 * random.uniform();
    for (std::uint32_t source = 0; source < 5; ++source) {
      const double at = 6 * static_cast<double>(1 + random.index(3)), from = 3 * static_cast<double>(random.index(3));
      const double to = from + 3 * static_cast<double>(2 + random.index(3));
      if (source % 2 == 0) c.map.wall({at, from}, {at, to}, source);
      else c.map.wall({from, std::min(at, 12.0)}, {to, std::min(at, 12.0)}, source);
    }
    c.options.thin_distance = 0.5;
    double before = 1e300;
    for (const double alpha : {0.0, 5.0, 15.0, 40.0, 100.0, 400.0}) {
      c.options.alpha = alpha;
      const Segmentation s = c.run();
      EXPECT_EQ(s.status, "optimal");
      expect_guarantees(c.map.arrangement, s);
      const double unused = alpha > 0 ? s.terms[Term::sweep_unused] / alpha : 1e299;
      EXPECT_LE(unused, before + 1e-6) << "alpha " << alpha;
      before = unused;
    }
  }
}

TEST(Choose, forbids_slivers_by_phi_but_not_thin_walls_seen_from_both_sides) {
  // A strip B one metre wide between two rooms, with a wall on either side of it that faces away from it.
  Case c{AsciiMap(std::vector<std::string>(4, "AAAABCCCC"), 1), {{'A', 8}, {'B', 20}, {'C', 8}}, {"ABC"}, {}};
  c.map.wall({4, 0}, {4, 4}, 0);  // northwards: its outside is A
  c.map.wall({5, 4}, {5, 0}, 1);  // southwards: its outside is C
  c.options.narrow = 0;           // what the program chooses, without what happens afterwards
  c.options.thin_rule = ThinRule::unsupported;
  Segmentation s = c.run();
  EXPECT_EQ(s.parts.size(), 3U);
  EXPECT_EQ(s.conflicts.size(), 0U) << "seen from both sides";
  EXPECT_EQ(s.terms[Term::thin], 0);
  c.options.thin_rule = ThinRule::all;
  s = c.run();
  expect_guarantees(c.map.arrangement, s);
  EXPECT_EQ(s.conflicts.size(), 1U);
  EXPECT_EQ(s.parts.size(), 3U) << "φ is the smaller evil here: two walls of 4 m and 12 m of height";
  EXPECT_NEAR(s.terms[Term::thin], 0.5 * (9 + 9 + 4 * 4), 1e-6) << "half the length of all edges";
  c.options.phi = 100;
  s = c.run();
  EXPECT_EQ(s.parts.size(), 2U);
  EXPECT_EQ(s.terms[Term::thin], 0);
  c.options.phi = 0;
  EXPECT_EQ(c.run().parts.size(), 3U);
}

TEST(Choose, exempts_no_two_walls_that_face_the_same_way) {
  Case c{AsciiMap(std::vector<std::string>(4, "AAAABCCCC"), 1), {{'A', 8}, {'B', 9}, {'C', 10}}, {"ABC"}, {}};
  c.map.wall({4, 0}, {4, 4}, 0);
  c.map.wall({5, 0}, {5, 4}, 1);
  c.options.phi = 100;
  const Segmentation s = c.run();
  EXPECT_EQ(s.conflicts.size(), 1U) << "one wall, found twice";
  EXPECT_EQ(s.parts.size(), 2U);
}

TEST(Choose, counts_a_sliver_along_the_outline) {
  Case c{AsciiMap({"BAAAA", "BAAAA", "BAAAA", "BAAAA"}, 1), {{'A', 8}, {'B', 8}}, {"AB"}, {}};
  c.map.wall({1, 0}, {1, 4}, 0);
  c.options.narrow = 0;
  Segmentation s = c.run();
  EXPECT_EQ(s.conflicts.size(), 1U);
  EXPECT_EQ(s.parts.size(), 2U) << "160 for not using the wall, 11 for the sliver";
  c.options.phi = 20;
  EXPECT_EQ(c.run().parts.size(), 1U);
}

TEST(Choose, keeps_a_low_strip_along_the_outside) {
  // 0.8 m wide on average, 3.5 m high (median) beside 8 m.
  Case c{AsciiMap({"BAAAA", "BAAAA", "BAAAA", "BAAAA"}, 1), {{'A', 8}, {'B', 3.5}}, {"AB"}, {}};
  c.map.wall({1, 0}, {1, 4}, 0);
  const auto roof = c.run();
  EXPECT_EQ(roof.parts.size(), 2U) << "a rear extension";
  EXPECT_TRUE(roof.left_out.empty());
}

TEST(Choose, gives_narrow_parts_to_their_neighbour_or_keeps_them) {
  // A strip 0.8 m wide on average along the west wall: part of the roof when it is level with it.
  const auto strip_at = [](double height, double narrow) {
    Case c{AsciiMap({"BAAAA", "BAAAA", "BAAAA", "BAAAA"}, 1), {{'A', 8}, {'B', height}}, {"AB"}, {}};
    c.map.wall({1, 0}, {1, 4}, 0);
    c.options.narrow = narrow;
    return c.run();
  };
  const auto level = strip_at(8.5, 1), low = strip_at(3.5, 1), half = strip_at(4.5, 1), kept = strip_at(3.5, 0);
  ASSERT_EQ(level.parts.size(), 1U);
  EXPECT_NEAR(geometry::area(level.parts[0].polygon), 20, 1e-6);
  EXPECT_EQ(low.parts.size(), 2U);
  ASSERT_EQ(half.parts.size(), 1U);
  EXPECT_NEAR(geometry::area(half.parts[0].polygon), 20, 1e-6) << "a wall that the scan has melted";
  EXPECT_EQ(kept.parts.size(), 2U);
}

TEST(Choose, keeps_a_narrow_part_that_is_all_of_its_feature) {
  Case c{AsciiMap({"BAAAA", "BAAAA", "BAAAA", "BAAAA"}, 1), {{'A', 8}, {'B', 4}}, {"A", "B"}, {}};
  const auto s = c.run();
  EXPECT_EQ(s.parts.size(), 2U);
}

TEST(Choose, leaves_out_what_is_low_or_outside_the_footprints) {
  Case c = plain({"AABBCCDD", "AABBCCDD"}, {{'A', 10}, {'B', 10}, {'C', 1}, {'D', 10}}, {"ABC"});
  const Segmentation s = c.run();
  expect_guarantees(c.map.arrangement, s);
  EXPECT_TRUE(s.faces[c.map.face.at('A')].inside && s.faces[c.map.face.at('B')].inside);
  EXPECT_FALSE(s.faces[c.map.face.at('C')].inside) << "a courtyard the footprints do not know";
  EXPECT_FALSE(s.faces[c.map.face.at('D')].inside) << "a neighbour the footprints do not have";
  EXPECT_EQ(s.faces[c.map.face.at('D')].gis_share, 0);
  EXPECT_EQ(s.faces[c.map.face.at('A')].gis_share, 1);
  EXPECT_EQ(s.faces[c.map.face.at('A')].feature, 0U);
  EXPECT_FALSE(c.part(s, 'C'));
  ASSERT_EQ(s.parts.size(), 1U);
  Case garage = plain({"AA"}, {{'A', 2.5}}, {"A"});
  EXPECT_EQ(garage.run().parts.size(), 1U);
  garage.options.min_height = 4;
  const Segmentation none = garage.run();
  EXPECT_EQ(none.status, "empty");
  EXPECT_TRUE(none.parts.empty());
  EXPECT_EQ(none.objective, 0);
}

TEST(Choose, measures_height_above_the_features_own_ground) {
  Case c = plain({"AABB", "AABB"}, {{'A', 10}, {'B', 10}}, {"A", "B"});
  block::Block block = c.map.block(c.features);
  block.members[1].ground = 9;
  const auto s = choose(c.map.arrangement, sweep_edges(0), block, rays::Scene(c.map.roofs(c.heights)), {});
  ASSERT_TRUE(s);
  EXPECT_TRUE(s->faces[c.map.face.at('A')].inside);
  EXPECT_FALSE(s->faces[c.map.face.at('B')].inside);
}

TEST(Choose, borrows_heights_over_holes_in_the_mesh) {
  Case c = plain({"AABBCC", "AABBCC"}, {{'A', 12}, {'C', 7}}, {"ABC"});
  c.map.wall({20, 0}, {20, 10}, 0);  // between B and C: B borrows from A
  const Segmentation s = c.run();
  const FaceEvidence& b = s.faces[c.map.face.at('B')];
  EXPECT_TRUE(b.inside);
  EXPECT_FALSE(b.seen);
  EXPECT_EQ(b.height, 12);
  EXPECT_EQ(c.part(s, 'A'), c.part(s, 'B'));
  EXPECT_NE(c.part(s, 'C'), c.part(s, 'B'));
}

TEST(Choose, builds_by_the_footprints_without_mesh_coverage) {
  Case c = plain({"AABB", "AABB"}, {}, {"AB"});
  const Segmentation s = c.run();
  ASSERT_EQ(s.parts.size(), 1U);
  EXPECT_NEAR(s.parts[0].height, c.options.min_height, 1e-9);
}

TEST(Choose, peels_exposed_faces_but_none_the_footprints_vouch_for) {
  // B hangs out over the footprint's edge: 60 % of its area is inside, no wall bounds it.
  Case c = plain({"AAAABBBBB", "AAAABBBBB"}, {{'A', 10}, {'B', 10}}, {"A"});
  block::Block block = c.map.block(c.features);
  block.members[0].polygons.push_back({{{20, 0}, {35, 0}, {35, 10}, {20, 10}}, {}});
  const rays::Scene mesh(c.map.roofs(c.heights));
  auto s = choose(c.map.arrangement, sweep_edges(0), block, mesh, {});
  ASSERT_TRUE(s);
  EXPECT_NEAR(s->faces[c.map.face.at('B')].gis_share, 0.6, 0.05);
  EXPECT_FALSE(s->faces[c.map.face.at('B')].inside);
  EXPECT_TRUE(s->faces[c.map.face.at('A')].inside) << "no wall around it either, but all of it is footprint";
  Options patient;
  patient.exposed = 1000;
  s = choose(c.map.arrangement, sweep_edges(0), block, mesh, patient);
  EXPECT_TRUE(s->faces[c.map.face.at('B')].inside);
  AsciiMap walled = c.map;
  walled.wall({45, 0}, {20, 0}, 0);
  walled.wall({45, 10}, {45, 0}, 1);
  walled.wall({20, 10}, {45, 10}, 2);
  s = choose(walled.arrangement, sweep_edges(3), block, mesh, {});
  EXPECT_TRUE(s->faces[c.map.face.at('B')].inside) << "walls all around";
}

TEST(Choose, makes_holes) {
  Case c = plain({"AAAAA", "ABBCA", "DDDDD"}, {{'A', 10}, {'B', 1}, {'C', 30}, {'D', 10}}, {"ABCD"});
  c.map.wall({15, 5}, {20, 5}, 0), c.map.wall({20, 5}, {20, 10}, 1), c.map.wall({20, 10}, {15, 10}, 2);
  const Segmentation s = c.run();
  expect_guarantees(c.map.arrangement, s);
  ASSERT_EQ(s.parts.size(), 2U) << "a tower in a court: the court is low, the tower is a part of its own";
  ASSERT_EQ(s.parts[0].polygon.holes.size(), 1U);
  EXPECT_NEAR(geometry::area(s.parts[0].polygon), 25 * 12, 1e-6);
  EXPECT_NEAR(geometry::area(s.parts[1].polygon), 25, 1e-6);
}

TEST(Choose, opens_pinched_corners) {
  // A touches itself at (5, 5): the court B in the south-west corner meets the court C.
  Case c = plain({"AAAA", "ACAA", "BAAA"}, {{'A', 10}, {'B', 1}, {'C', 1}}, {"ABC"});
  const Segmentation s = c.run();
  expect_guarantees(c.map.arrangement, s);
  ASSERT_EQ(s.parts.size(), 1U);
  const auto& polygon = s.parts[0].polygon;
  std::set<Point2> seen;
  std::size_t corners = 0;
  for (const Point2 p : polygon.outer) seen.insert(p), ++corners;
  for (const auto& hole : polygon.holes)
    for (const Point2 p : hole) seen.insert(p), ++corners;
  EXPECT_EQ(seen.size(), corners) << "no corner twice";
  EXPECT_TRUE(s.warnings.empty());
}

TEST(Choose, joins_tiny_parts_to_their_feature_or_leaves_them_out) {
  Case c{AsciiMap({"AAAAAAAA", "AAABAAAA", "AAAAAAAA", "AAAAAAAA"}, 0.9), {{'A', 10}, {'B', 90}}, {"AB"}, {}};
  c.options.phi = 0;
  c.map.wall({2.7, 1.8}, {2.7, 2.7}, 0), c.map.wall({3.6, 2.7}, {3.6, 1.8}, 1);
  c.map.wall({2.7, 2.7}, {3.6, 2.7}, 2), c.map.wall({3.6, 1.8}, {2.7, 1.8}, 3);
  Segmentation s = c.run();
  ASSERT_EQ(s.parts.size(), 1U);
  EXPECT_FALSE(s.candidates[0].chosen);
  ASSERT_EQ(s.warnings.size(), 1U);
  EXPECT_EQ(s.warnings[0].code, "segment-part-small");
  c.features = {"A", "B"};
  s = c.run();
  EXPECT_EQ(s.parts.size(), 1U);
  EXPECT_FALSE(c.part(s, 'B')) << "of another feature: left out";
  ASSERT_EQ(s.warnings.size(), 1U);
}

TEST(Choose, is_valid_with_no_time_at_all) {
  Case c = plain({"AABBCC", "AABBCC", "DDEEFF", "DDEEFF"},
                 {{'A', 10}, {'B', 14}, {'C', 11}, {'D', 12}, {'E', 30}, {'F', 9}}, {"ABCDEF"});
  c.map.wall({10, 0}, {10, 20}, 0), c.map.wall({0, 10}, {30, 10}, 1);
  const double best = c.run().objective;
  c.options.seconds = 0;
  const Segmentation s = c.run();
  expect_guarantees(c.map.arrangement, s);
  EXPECT_LE(s.bound, best);
  EXPECT_GE(s.objective, best - 1e-9);
}

TEST(Choose, refuses_origins_it_has_no_sweep_edge_for) {
  Case c = plain({"AABB"}, {{'A', 10}, {'B', 14}}, {"AB"});
  c.map.wall({10, 0}, {10, 5}, 7);
  const rays::Scene mesh(c.map.roofs(c.heights));
  const auto s = choose(c.map.arrangement, sweep_edges(3), c.map.block({"AB"}), mesh, {});
  ASSERT_FALSE(s);
  EXPECT_EQ(s.error().code, "segment-failed");
}

TEST(Choose, answers_an_arrangement_without_faces) {
  const auto s = choose({}, {}, {}, rays::Scene(geometry::Mesh{}), {});
  ASSERT_TRUE(s);
  EXPECT_EQ(s->status, "empty");
}

TEST(Options, list_every_member_once_with_its_default) {
  Options options;
  const base::OptionList list = option_list(options);
  EXPECT_EQ(list.module(), "segment");
  EXPECT_EQ(std::ranges::count(list.options(), false, &base::Option::advanced), 21);
  std::set<std::string> names;
  for (const auto& option : list.options()) names.insert(option.name);
  EXPECT_EQ(names.size(), list.options().size());
  ASSERT_NE(list.find("alpha"), nullptr);
  EXPECT_EQ(list.find("alpha")->get(), "40");
  EXPECT_EQ(list.find("seconds")->get(), "");
  EXPECT_TRUE(list.find("thin_rule")->set("all"));
  EXPECT_EQ(options.thin_rule, ThinRule::all);
  EXPECT_FALSE(list.find("samples")->set("3"));
}

TEST(Codes, begin_with_the_module) {
  for (const auto& code : codes()) EXPECT_THAT(code.code, ::testing::StartsWith("segment-"));
}

/// A house of 4 by 3 m with a bay of 2 by 1 m below it, of which a share is seen at the height of the roof and the rest
/// as ground.
auto bay_is_building(double share, double rim) -> bool {
  const AsciiMap map({"AAAA", "AAAA", "AAAA", ".BB."}, 1);
  auto mesh = map.roofs({{'A', 6}});
  const auto add = [&mesh](double from, double to, double z) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Point2 p : {Point2{1, from}, Point2{3, from}, Point2{3, to}, Point2{1, to}})
      mesh.vertices.push_back({p.x, p.y, z});
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  };
  add(1 - share, 1, 6);
  add(0, 1 - share, 0);
  Options options;
  options.rim = rim;
  const auto s = choose(map.arrangement, sweep_edges(1), map.block({"AB"}), rays::Scene(mesh), options);
  EXPECT_TRUE(s);
  return s && s->faces[map.face.at('B')].inside;
}

TEST(Choose, a_bay_as_narrow_as_the_scans_edges_is_building_where_a_roof_is_seen) {
  EXPECT_TRUE(bay_is_building(0.4, 0.4));
  EXPECT_FALSE(bay_is_building(0.1, 0.4));
  EXPECT_FALSE(bay_is_building(0.4, 0));  // a scan with sharp edges shows what is there
}

TEST(Choose, what_no_point_was_measured_over_is_what_the_footprint_says) {
  // A bay of 2 by 1 m, over which the surface between the points falls from the roof to the ground beside it.
  const AsciiMap map({"AAAA", "AAAA", "AAAA", ".BB."}, 1);
  auto mesh = map.roofs({{'A', 6}, {'B', 0}});
  for (double x = 0.1; x < 4; x += 0.4)
    for (double y = 1.1; y < 4; y += 0.4) mesh.points.push_back({x, y, 6});
  Options options;
  options.by_points = true;
  const auto is_building = [&](int points_on_the_ground) {
    auto scan = mesh;
    for (int i = 0; i < points_on_the_ground; ++i) scan.points.push_back({1.3 + 0.2 * i, 0.5, 0});
    const auto s = choose(map.arrangement, sweep_edges(1), map.block({"AB"}), rays::Scene(scan), options);
    EXPECT_TRUE(s);
    return s && s->faces[map.face.at('B')].inside;
  };
  EXPECT_TRUE(is_building(0));
  EXPECT_TRUE(is_building(2));
  EXPECT_FALSE(is_building(5));
}

TEST(Choose, what_is_along_a_boundary_does_not_tell_the_height_of_a_face) {
  // Off the rim, half of the bay is left: as much roof as ground in all, and roof alone in the middle.
  EXPECT_TRUE(bay_is_building(0.6, 0.1));
  EXPECT_FALSE(bay_is_building(0.45, 0.1));
}

}  // namespace
}  // namespace mansard::segment
