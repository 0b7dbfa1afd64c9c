#include "mansard/extrude/extrude.hpp"
#include "mansard/solid/solid.hpp"

#include <gmock/gmock.h>

#include "plans.hpp"

namespace {

namespace geometry = mansard::geometry;
namespace extrude = mansard::extrude;

namespace solid = mansard::solid;
namespace model = mansard::model;

using namespace plans;
using extrude::Outcome;
using model::FaceKind;

/// Extruded in full and without fault.
auto full(const Plan& p) -> model::Solid {
  auto raised = extrude::raise(p);
  if (!raised) {
    ADD_FAILURE() << base::to_string(raised.error()) << " " << text(p);
    return {};
  }
  EXPECT_EQ(raised->outcome, Outcome::full)
      << (raised->warnings.empty() ? "" : raised->warnings.back().message) << " " << text(p);
  EXPECT_EQ(faults(raised->solid), "") << text(p);
  return std::move(raised->solid);
}

auto top_of(const model::Solid& solid) -> double {
  double top = -1e9;
  for (const Point3 p : solid.vertices) top = std::max(top, p.z);
  return top;
}

TEST(Raise, puts_a_pyramid_on_a_square) {
  const auto solid = full(plan(box(10, 10), {hip}));
  EXPECT_EQ(solid.vertices.size(), 9U);  // four below, four at the gutter, the apex
  EXPECT_EQ(solid.faces.size(), 9U);
  EXPECT_NEAR(solid::volume(solid), 300 + 100 * 5.0 / 3, 1e-6);
  EXPECT_NEAR(top_of(solid), 8, 1e-9);
}

TEST(Raise, puts_a_ridge_on_a_rectangle) {
  const auto solid = full(plan(box(10, 6), {hip}));
  EXPECT_EQ(solid.vertices.size(), 10U);
  // A prism over the middle 4 m and two half pyramids.
  EXPECT_NEAR(solid::volume(solid), 180 + 4 * 9 + 36 * 3.0 / 3, 1e-6);
}

TEST(Raise, makes_gables_of_vertical_edges) {
  const auto solid = full(plan(box(10, 6), {hip, wall}, {0, 1, 0, 1}));
  EXPECT_NEAR(solid::volume(solid), 180 + 10 * 9, 1e-6);
  EXPECT_EQ(solid.vertices.size(), 10U);
  EXPECT_EQ(solid.faces.size(), 7U);  // base, two walls, two gables with five corners, two roofs
  std::vector<std::size_t> corners;
  for (const auto& face : solid.faces) corners.push_back(face.loops[0].size());
  EXPECT_THAT(corners, testing::UnorderedElementsAre(4, 4, 4, 4, 4, 5, 5));
}

TEST(Raise, names_the_edge_and_part_of_every_face) {
  const auto solid = full(plan(box(10, 6), {hip, wall}, {0, 1, 0, 1}));
  std::vector<model::Provenance> found;
  for (const auto& face : solid.faces)
    if (face.provenance) found.push_back(*face.provenance);
  EXPECT_THAT(found, testing::UnorderedElementsAre(model::Provenance{0, 0, 0}, model::Provenance{0, 0, 1},
                                                   model::Provenance{0, 1, 0}, model::Provenance{0, 2, 0},
                                                   model::Provenance{0, 2, 1}, model::Provenance{0, 3, 0}));
  for (const auto& face : solid.faces) {
    if (!face.provenance) continue;
    EXPECT_NEAR(face.normal.z, face.provenance->part == 1 ? std::numbers::sqrt2 / 2 : 0, 1e-9);
    EXPECT_NEAR(length(face.normal), 1, 1e-12);
  }
}

TEST(Raise, roofs_an_L_a_T_a_plus_and_an_H) {
  //  +--+         +------+        +--+
  //  |  |         +-+  +-+      +-+  +-+
  //  |  +---+       |  |        +-+  +-+
  //  +------+       +--+          +--+
  full(plan({{0, 0}, {12, 0}, {12, 5}, {5, 5}, {5, 12}, {0, 12}}, {hip}));
  full(plan({{4, 0}, {8, 0}, {8, 8}, {12, 8}, {12, 12}, {0, 12}, {0, 8}, {4, 8}}, {hip}));
  const auto plus = full(plan(
      {{4, 0}, {8, 0}, {8, 4}, {12, 4}, {12, 8}, {8, 8}, {8, 12}, {4, 12}, {4, 8}, {0, 8}, {0, 4}, {4, 4}}, {tent}));
  EXPECT_NEAR(top_of(plus), 2, 1e-9);
  EXPECT_EQ(plus.vertices.size(), 12U + 4U + 1U);  // outline, ridge ends, crossing
  full(plan({{0, 0}, {4, 0}, {4, 4}, {8, 4}, {8, 0}, {12, 0}, {12, 12}, {8, 12}, {8, 8}, {4, 8}, {4, 12}, {0, 12}},
            {hip}));
}

TEST(Raise, roofs_a_comb) {
  Ring ring{{0, 0}, {26, 0}};
  for (int tooth = 6; tooth >= 0; --tooth) {
    const double x = 4.0 * tooth;
    ring.insert(ring.end(), {{x + 2, 8}, {x, 8}});
    if (tooth > 0) ring.insert(ring.end(), {{x, 3}, {x - 2, 3}});
  }
  for (const Profile& profile : {hip, tent, two_pitch, setback}) full(plan(ring, {profile}));
}

TEST(Raise, roofs_a_courtyard_all_round) {
  const auto solid = full(plan(box(20, 20), {hip}, {}, 100, {turned_in({{6, 6}, {14, 6}, {14, 14}, {6, 14}})}));
  EXPECT_NEAR(top_of(solid), 6, 1e-9);  // wings of 6 m
  double outline = 0;
  for (const auto& face : solid.faces)
    if (face.kind == FaceKind::base) outline += solid::area(solid, face);
  EXPECT_NEAR(outline, 400 - 64, 1e-4);
}

TEST(Raise, lets_a_hole_merge_with_the_outside) {
  // The wing beside the hole is narrow at one side only: its roof ends first, and the hole's edge goes on with the
  // outline.
  const auto solid = full(plan(box(20, 20), {hip}, {}, 100, {turned_in({{2, 6}, {12, 6}, {12, 14}, {2, 14}})}));
  EXPECT_NEAR(integrated_volume(solid), solid::volume(solid), 1e-6);
}

TEST(Raise, changes_the_pitch_at_the_knots_of_a_mansard_profile) {
  const auto solid = full(plan(box(12, 12), {two_pitch}));
  // Walls; a frustum from 12 m to 10 m in 2 m; then a pitch of 1:2 over 10 m.
  const double frustum = 2.0 / 3 * (144 + 100 + 120), top = 100 * 2.5 / 3;
  EXPECT_NEAR(solid::volume(solid), 432 + frustum + top, 1e-5);
  EXPECT_NEAR(top_of(solid), 3 + 2 + 2.5, 1e-6);
}

TEST(Raise, sets_storeys_back_behind_terraces) {
  const auto solid = full(plan(box(12, 12), {setback}, {}, 9));
  EXPECT_NEAR(solid::volume(solid), 144 * 3 + 64 * 6, 1e-5);
  EXPECT_EQ(count(solid, FaceKind::terrace), 1U);  // one piece round the tower
  EXPECT_EQ(count(solid, FaceKind::cap), 1U);
}

TEST(Raise, goes_on_upwards_after_a_last_terrace) {
  const auto solid = full(plan(box(12, 12), {{{0, 0}, {0, 3}, {2, 3}}}, {}, 5));
  EXPECT_NEAR(solid::volume(solid), 144 * 3 + 64 * 2, 1e-5);
}

TEST(Raise, lets_a_terrace_use_up_everything) {
  for (const double run : {6.0, 7.0}) {
    const auto solid = full(plan(box(12, 12), {{{0, 0}, {0, 3}, {run, 3}, {run, 9}}}));
    EXPECT_NEAR(solid::volume(solid), 432, 1e-5);
    EXPECT_EQ(count(solid, FaceKind::terrace), 1U);
    EXPECT_EQ(count(solid, FaceKind::cap), 0U);
  }
}

TEST(Raise, sets_one_side_back_between_upright_neighbours) {
  const auto solid = full(plan(box(10, 10), {wall, setback}, {1, 0, 0, 0}, 6));
  EXPECT_NEAR(solid::volume(solid), 300 + 240, 1e-5);
  EXPECT_EQ(count(solid, FaceKind::terrace), 1U);
}

TEST(Raise, lets_a_setback_beside_a_reflex_corner_lengthen_its_neighbour) {
  // The neighbour changes its own face at the same height, longer above than below.
  const Profile knot_here{{0, 0}, {0, 3}, {1, 4}};
  const Ring ell{{0, 0}, {12, 0}, {12, 6}, {6, 6}, {6, 12}, {0, 12}};
  for (std::uint32_t i = 0; i < 6; ++i) {
    std::vector<std::uint32_t> of_edge(6, 0);
    of_edge[i] = 1;
    full(plan(ell, {knot_here, {{0, 0}, {0, 3}, {1, 3}, {2, 4}}}, of_edge));
  }
}

TEST(Raise, starts_roofs_at_unequal_heights) {
  const Profile low{{0, 0}, {0, 2}, {1, 3}}, high{{0, 0}, {0, 5}, {1, 6}};
  const auto solid = full(plan(box(10, 8), {low, high}, {0, 1, 0, 1}));
  EXPECT_NEAR(integrated_volume(solid), solid::volume(solid), 1e-6);
  EXPECT_NEAR(top_of(solid), 6, 1e-6);  // the long sides meet over 4 m
}

TEST(Raise, starts_a_roof_only_after_its_neighbours_have_met_it) {
  // The delayed edge is gone from the wavefront before its roof would start.
  const Profile late{{0, 0}, {0, 50}, {1, 51}};
  const auto solid = full(plan(box(10, 6), {hip, late}, {0, 1, 0, 1}));
  EXPECT_NEAR(solid::volume(solid), 180 + 90, 1e-6);
}

TEST(Raise, ends_flat_at_the_cap) {
  for (const auto& [cap, flat] : std::vector<std::pair<double, double>>{{2, 100}, {3, 100}, {5, 36}, {7.5, 1}}) {
    const auto solid = full(plan(box(10, 10), {hip}, {}, cap));
    EXPECT_NEAR(top_of(solid), cap, 1e-9);
    double area = 0;
    for (const auto& face : solid.faces)
      if (face.kind == FaceKind::cap) area += solid::area(solid, face);
    EXPECT_NEAR(area, flat, 1e-4);
  }
}

TEST(Raise, takes_a_cap_at_the_height_of_an_event) {
  EXPECT_EQ(count(full(plan(box(10, 10), {hip}, {}, 8)), FaceKind::cap), 0U);  // the apex
  EXPECT_EQ(count(full(plan(box(10, 6), {hip}, {}, 6)), FaceKind::cap), 0U);   // the ridge
  full(plan(box(12, 12), {two_pitch}, {}, 5));                                 // a knot
  full(plan(box(12, 12), {setback}, {}, 3));                                   // a terrace
  // Two wings joined by a neck that has just closed: the cap is two pieces that touch in the ridge's ends only.
  const Ring neck{{0, 0}, {8, 0}, {8, 3}, {14, 3}, {14, 0}, {22, 0}, {22, 8}, {14, 8}, {14, 5}, {8, 5}, {8, 8}, {0, 8}};
  EXPECT_EQ(count(full(plan(neck, {hip}, {}, 4)), FaceKind::cap), 2U);
}

TEST(Raise, makes_a_block_of_upright_profiles) {
  const auto solid = full(plan(box(10, 6), {wall}, {}, 7.25));
  EXPECT_EQ(solid.faces.size(), 6U);
  EXPECT_NEAR(solid::volume(solid), 435, 1e-9);
}

TEST(Raise, puts_connectors_between_collinear_neighbours) {
  // One straight side, upright on the left half and sloped on the right.
  //   +-----------+
  //   |           |
  //   +-----+-----+
  //    wall   hip
  const Plan p = plan({{0, 0}, {5, 0}, {10, 0}, {10, 8}, {0, 8}}, {hip, wall}, {1, 0, 0, 0, 0});
  const auto solid = full(p);
  EXPECT_EQ(count(solid, FaceKind::connector), 1U);
  EXPECT_NEAR(integrated_volume(solid), solid::volume(solid), 1e-6);
  for (const auto& face : solid.faces)
    if (face.kind == FaceKind::connector) {
      EXPECT_NEAR(face.normal.x, 1, 1e-12);
      EXPECT_FALSE(face.provenance);
    }
}

TEST(Raise, turns_a_connector_round_when_the_other_side_gets_ahead) {
  const Profile early{{0, 0}, {0, 2}, {1, 3}, {1, 6}, {2, 7}}, late{{0, 0}, {0, 4}, {3, 5.5}};
  const auto solid = full(plan({{0, 0}, {7, 0}, {14, 0}, {14, 14}, {0, 14}}, {wall, early, late}, {1, 2, 0, 0, 0}, 9));
  std::set<double> facing;
  for (const auto& face : solid.faces)
    if (face.kind == FaceKind::connector) facing.insert(std::round(face.normal.x));
  EXPECT_THAT(facing, testing::ElementsAre(-1, 1));
}

TEST(Raise, takes_many_profiles_along_one_facade) {
  Ring ring;
  std::vector<std::uint32_t> of_edge;
  for (std::uint32_t i = 0; i < 8; ++i) {
    ring.push_back({3.0 * i, 0});
    of_edge.push_back(i % 5);
  }
  ring.insert(ring.end(), {{24, 0}, {24, 11}, {0, 11}});
  of_edge.insert(of_edge.end(), {0, 1, 0});
  const std::vector<Profile> profiles{wall, hip, two_pitch, setback, tent};
  for (const double cap : {2.0, 3.0, 5.0, 8.0, 20.0}) full(turned(plan(ring, profiles, of_edge, cap), 0.3));
}

TEST(Raise, joins_collinear_neighbours_with_one_profile) {
  const auto solid = full(plan({{0, 0}, {4, 0}, {10, 0}, {10, 6}, {0, 6}}, {hip}));
  EXPECT_EQ(solid.faces.size(), 9U);
  for (const auto& face : solid.faces)
    if (face.provenance) {
      EXPECT_NE(face.provenance->edge, 1U);  // named after the first of the two
    }
}

TEST(Raise, keeps_a_twelve_gon_to_one_apex_when_turned) {
  for (const double angle : {0.0, 0.1, 0.3, 1.234}) {
    Ring ring;
    for (int i = 0; i < 12; ++i)
      ring.push_back({10 * std::cos(i * std::numbers::pi / 6), 10 * std::sin(i * std::numbers::pi / 6)});
    const auto solid = full(turned(plan(ring, {tent}), angle));
    EXPECT_EQ(solid.vertices.size(), 13U) << angle;
    EXPECT_EQ(solid.faces.size(), 13U) << angle;
  }
}

TEST(Raise, keeps_a_plus_to_one_crossing_when_turned) {
  const Plan plus = plan(
      {{4, 0}, {8, 0}, {8, 4}, {12, 4}, {12, 8}, {8, 8}, {8, 12}, {4, 12}, {4, 8}, {0, 8}, {0, 4}, {4, 4}}, {tent});
  for (const double angle : {0.3, 0.7, 2.9}) {
    const auto solid = full(turned(plus, angle));
    EXPECT_EQ(solid.vertices.size(), 17U) << angle;
    EXPECT_NEAR(solid::volume(solid), solid::volume(full(plus)), 1e-3);
  }
}

TEST(Raise, pulls_a_dog_bone_apart) {
  const Ring bone{{0, 0}, {8, 0}, {8, 3}, {14, 3}, {14, 0}, {22, 0}, {22, 8}, {14, 8}, {14, 5}, {8, 5}, {8, 8}, {0, 8}};
  const auto solid = full(plan(bone, {hip}));
  EXPECT_NEAR(top_of(solid), 7, 1e-6);
  for (const Profile& profile : {tent, two_pitch, setback}) full(plan(bone, {profile}, {}, 12));
}

TEST(Raise, leaves_a_corridor_between_vertical_walls) {
  // The neck is upright, its ends slope: the roofs run into it and meet in the middle.
  full(plan({{0, 0}, {8, 0}, {8, 3}, {14, 3}, {14, 0}, {22, 0}, {22, 8}, {14, 8}, {14, 5}, {8, 5}, {8, 8}, {0, 8}},
            {hip, wall}, {0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0}));
}

TEST(Raise, survives_tiny_edges_and_shallow_turns) {
  const Ring noisy{{0, 0},     {4, 0.01},    {8, -0.008},   {8.05, -0.008}, {12, 0.004},
                   {12.02, 3}, {11.99, 6.5}, {12.04, 6.54}, {12.03, 10},    {7, 10.06},
                   {6.96, 10}, {0.03, 9.97}, {0, 5.02},     {-0.04, 5},     {-0.036, 4.95}};
  const std::vector<Profile> profiles{hip, wall, two_pitch, setback};
  base::Random random(7);
  for (int round = 0; round < 20; ++round) {
    std::vector<std::uint32_t> of_edge;
    for (std::size_t i = 0; i < noisy.size(); ++i) of_edge.push_back(static_cast<std::uint32_t>(random.index(4)));
    full(plan(noisy, profiles, of_edge, 9));
  }
}

TEST(Raise, lies_within_the_tolerance_of_the_plan) {
  const Ring wavy{{0, 0}, {5, 0.02}, {10, 0}, {15, -0.02}, {20, 0}, {20, 10}, {0, 10}};
  const auto solid = full(plan(wavy, {hip}));
  for (const Point3 p : solid.vertices) {
    if (p.z > 1e-9) continue;
    EXPECT_LT(geometry::boundary_distance({wavy, {}}, xy(p)), extrude::Options{}.tolerance);
  }
  EXPECT_EQ(std::ranges::count_if(solid.vertices, [](Point3 p) { return p.z == 0; }), 4);
}

TEST(Raise, stands_on_the_plans_base) {
  Plan p = plan(box(10, 10), {hip});
  p.base = 21.5;
  const auto solid = full(p);
  EXPECT_NEAR(top_of(solid), 29.5, 1e-9);
  EXPECT_EQ(std::ranges::count_if(solid.vertices, [](Point3 v) { return v.z == 21.5; }), 4);
}

TEST(Raise, starts_behind_a_setback_at_the_ground) {
  const auto solid = full(plan(box(10, 10), {{{0, 0}, {1, 0}, {1, 4}}}, {}, 4));
  EXPECT_NEAR(solid::volume(solid), 64 * 4, 1e-5);
}

TEST(Raise, reads_rings_of_either_orientation) {
  Plan p = plan(turned_in(box(10, 6)), {hip, wall}, {0, 1, 0, 1});
  EXPECT_NEAR(solid::volume(full(p)), solid::volume(full(plan(box(10, 6), {hip, wall}, {0, 1, 0, 1}))), 1e-9);
}

TEST(Raise, says_what_is_wrong_with_a_plan) {
  const auto code = [](const Plan& p) {
    const auto raised = extrude::raise(p);
    const auto flat = extrude::prism(p);
    EXPECT_EQ(raised.has_value(), flat.has_value());
    return raised ? std::string("raised") : raised.error().code;
  };
  EXPECT_EQ(code(plan({{0, 0}, {4, 4}, {4, 0}, {0, 4}}, {hip})), "extrude-no-area");
  EXPECT_EQ(code(plan({{0, 0}, {9, 4}, {9, 0}, {0, 5}}, {hip})), "extrude-not-simple");
  EXPECT_EQ(code(plan(box(10, 10), {hip}, {}, 100, {turned_in({{12, 1}, {14, 1}, {14, 3}})})), "extrude-not-simple");
  EXPECT_EQ(code(plan(box(10, 10), {hip}, {}, 100, {turned_in({{8, 1}, {14, 1}, {14, 3}})})), "extrude-not-simple");
  EXPECT_EQ(code(plan({{0, 0}, {4, 0}, {8, 0}}, {hip})), "extrude-no-area");
  EXPECT_EQ(code(plan({{0, 0}, {std::nan(""), 0}, {8, 4}}, {hip})), "extrude-not-simple");
  EXPECT_EQ(code(plan(box(10, 10), {hip}, {}, 0)), "extrude-cap");
  EXPECT_EQ(code(plan(box(10, 10), {hip}, {}, std::nan(""))), "extrude-cap");
  EXPECT_EQ(code(plan(box(10, 10), {{{0, 0}}})), "extrude-profile");
  EXPECT_EQ(code(plan(box(10, 10), {{{0, 0}, {-1, 3}}})), "extrude-profile");
  EXPECT_EQ(code(plan(box(10, 10), {{{0, 0}, {0, 3}, {1, 2}}})), "extrude-profile");
  EXPECT_EQ(code(plan(box(10, 10), {{{0, 1}, {0, 3}}})), "extrude-profile");
  EXPECT_EQ(code(plan(box(10, 10), {hip}, {0, 0, 0, 5})), "extrude-profile");
  EXPECT_EQ(code(plan(box(10, 10), {hip})), "raised");
  const auto known = extrude::codes();
  for (const char* named : {"extrude-no-area", "extrude-not-simple", "extrude-cap", "extrude-profile"})
    EXPECT_TRUE(std::ranges::any_of(known, [&](const auto& c) { return c.code == named; })) << named;
}

TEST(Raise, names_the_cap_that_is_too_high) {
  const auto raised = extrude::raise(plan(box(300, 300), {{{0, 0}, {0, 6}, {0.01, 16}}}, {}, 150006));
  ASSERT_FALSE(raised);
  EXPECT_EQ(raised.error().code, "extrude-cap");
  EXPECT_THAT(raised.error().message,
              testing::HasSubstr("the cap is 150006 m above the base, and the maximum is 100000 m"));
  EXPECT_THAT(extrude::raise(plan(box(10, 10), {hip}, {}, -2)).error().message, testing::HasSubstr("-2.000000 m"));
}

TEST(Raise, says_where_an_outline_is_too_narrow_even_for_a_prism) {
  extrude::Options on_file_grid;
  on_file_grid.grid = 1e-4;
  const auto why = [&](const Ring& ring) -> std::string {
    const auto raised = extrude::raise(plan(ring, {hip}, {}, 6), on_file_grid);
    return raised ? "raised" : raised.error().code + ": " + raised.error().message;
  };
  EXPECT_THAT(
      why({{0, 0}, {20, 0}, {20, 2e-5}, {0, 2e-5}}),
      testing::AllOf(testing::StartsWith("extrude-narrow"), testing::HasSubstr("sliver, on average 0.0200 mm wide")));
  // A neck of a micrometre between two yards.
  EXPECT_THAT(
      why({{0, 0}, {5, 4.9999995}, {10, 0}, {10, 10}, {5, 5.0000005}, {0, 10}}),
      testing::AllOf(testing::StartsWith("extrude-narrow"), testing::HasSubstr("corner 1 at (5.000, 5.000) is "),
                     testing::HasSubstr("widen that place to 5.0000 mm")));
}

TEST(Raise, reports_a_small_edge_with_a_profile_of_its_own) {
  // A chamfer of 2.6 cm with a pitch of 6° between edges of 45°.
  const Profile shallow{{0, 0}, {0, 3}, {10, 4}};
  const double c = 0.026 / std::sqrt(2);
  const auto small = [](const Plan& p) {
    const auto raised = extrude::raise(p);
    EXPECT_TRUE(raised && raised->outcome == Outcome::full);
    std::string message;
    for (const auto& warning : raised->warnings)
      if (warning.code == "extrude-small-edge") message = warning.message;
    return message;
  };
  EXPECT_THAT(small(plan({{0, 0}, {10 - c, 0}, {10, c}, {10, 8}, {0, 8}}, {hip, shallow}, {0, 1, 0, 0, 0})),
              testing::AllOf(testing::HasSubstr("edge 1 at (9.982, 0.000) is only 0.026 m long"),
                             testing::HasSubstr("m² of roof rise")));
  // The same edge nearly in line with its neighbours, into whose line it is straightened.
  EXPECT_THAT(
      small(plan({{0, 0}, {5, -0.03}, {5.026, -0.03}, {10, 0}, {10, 8}, {0, 8}}, {hip, shallow}, {0, 1, 0, 0, 0, 0})),
      testing::HasSubstr("edge 1 at (5.000, -0.030) is only 0.026 m long"));
  EXPECT_EQ(small(plan({{0, 0}, {10 - c, 0}, {10, c}, {10, 8}, {0, 8}}, {hip, shallow}, {0, 0, 0, 0, 0})), "");
}

TEST(Raise, cuts_off_a_needle_shorter_than_a_detail) {
  // 20 cm long and a tenth of a micrometre wide: its sides are one direction.
  const Ring needle{{0, 0}, {10, 0}, {10, 10}, {5.0000001, 10}, {5.00000005, 10.2}, {5, 10}, {0, 10}};
  const auto raised = extrude::raise(plan(needle, {hip}));
  ASSERT_TRUE(raised);
  EXPECT_EQ(raised->outcome, Outcome::simplified);
  ASSERT_FALSE(raised->warnings.empty());
  EXPECT_EQ(raised->warnings.front().code, "extrude-simplified");
  EXPECT_EQ(faults(raised->solid), "");
  EXPECT_NEAR(solid::volume(raised->solid), 300 + 100 * 5.0 / 3, 1e-4);
}

TEST(Raise, comes_down_to_the_prism_for_a_needle) {
  // 20 m long, and as thin.
  const Ring needle{{0, 0}, {10, 0}, {10, 5}, {5.0000001, 5}, {5.00000005, 25}, {5, 5}, {0, 5}};
  const auto raised = extrude::raise(plan(needle, {hip}, {}, 6));
  ASSERT_TRUE(raised);
  EXPECT_EQ(raised->outcome, Outcome::prism);
  std::vector<std::string> codes;
  for (const auto& warning : raised->warnings) codes.push_back(warning.code);
  EXPECT_THAT(codes, testing::ElementsAre("extrude-simplified", "extrude-two-part", "extrude-prism"));
  EXPECT_EQ(faults(raised->solid), "");
}

TEST(Raise, separates_vertical_walls_that_would_meet_in_a_line) {
  // Setbacks of half the depth, on one half from the front, on the other from behind:
  //   +-----+-----+      upper    +-----+
  //   |           |      storey:  |     |
  //   |           |               +-----+-----+
  //   |           |                     |     |
  //   +-----+-----+                     +-----+
  const Profile half{{0, 0}, {0, 3}, {2, 3}, {2, 6}};
  const auto raised =
      extrude::raise(plan({{0, 0}, {3, 0}, {6, 0}, {6, 4}, {3, 4}, {0, 4}}, {wall, half}, {1, 0, 0, 1, 0, 0}, 6));
  ASSERT_TRUE(raised);
  EXPECT_EQ(raised->outcome, Outcome::full);
  ASSERT_EQ(raised->warnings.size(), 1U);
  EXPECT_EQ(raised->warnings[0].code, "extrude-nudged");
  EXPECT_EQ(faults(raised->solid), "");
  EXPECT_NEAR(solid::volume(raised->solid), 24 * 3 + 12 * 3, 0.1);
}

TEST(Raise, comes_down_to_the_prism_when_stopped) {
  base::Cancel cancel;
  cancel.request();
  base::Run run;
  run.cancel = &cancel;
  const auto raised = extrude::raise(plan(box(10, 10), {hip}, {}, 6), {}, run);
  ASSERT_TRUE(raised);
  EXPECT_EQ(raised->outcome, Outcome::prism);
  EXPECT_EQ(raised->warnings.back().code, "extrude-prism");
  EXPECT_NEAR(solid::volume(raised->solid), 600, 1e-9);
}

TEST(Prism, is_the_polygon_from_base_to_cap) {
  Plan p = plan(box(20, 20), {hip}, {}, 5, {turned_in({{6, 6}, {14, 6}, {14, 14}, {6, 14}})});
  p.base = 2;
  const auto solid = extrude::prism(p);
  ASSERT_TRUE(solid);
  EXPECT_EQ(faults(*solid), "");
  EXPECT_NEAR(solid::volume(*solid), (400 - 64) * 5, 1e-9);
  EXPECT_EQ(solid->faces.size(), 10U);
}

TEST(Options, list_every_member) {
  extrude::Options options;
  const auto list = extrude::option_list(options);
  EXPECT_EQ(list.module(), "extrude");
  ASSERT_NE(list.find("merge_angle"), nullptr);
  ASSERT_NE(list.find("tolerance"), nullptr);
  EXPECT_TRUE(list.find("tolerance")->set("0.1"));
  EXPECT_EQ(options.tolerance, 0.1);
}

TEST(Sketch, is_what_raise_gives_before_rounding) {
  for (const auto& ring : {box(10, 10), box(14, 9), box(6.5, 22)}) {
    const auto p = plan(ring, {hip});
    const auto sketch = extrude::sketch(p);
    ASSERT_TRUE(sketch);
    const auto solid = full(p);
    EXPECT_EQ(sketch->faces.size(), solid.faces.size());
    EXPECT_NEAR(solid::volume(*sketch), solid::volume(solid), 1e-3);
  }
}

TEST(Sketch, fails_on_a_footprint_that_crosses_itself) {
  const auto sketch = extrude::sketch(plan({{0, 0}, {10, 10}, {10, 0}, {0, 14}}, {hip}));
  ASSERT_FALSE(sketch);
  EXPECT_EQ(sketch.error().code, "extrude-not-simple");
}

}  // namespace
