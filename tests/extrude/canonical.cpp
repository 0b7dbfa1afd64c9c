// The contract of canonical.hpp, and the nudges. Random cases print their seed; MANSARD_SEED=<n> runs that one alone.
#include "mansard/extrude/canonical.hpp"

#include <gmock/gmock.h>

#include <cstdlib>

#include "mansard/base/text.hpp"
#include "mansard/extrude/corner_edges.hpp"
#include "mansard/extrude/detail/footprint.hpp"
#include "mansard/extrude/detail/grid.hpp"
#include "mansard/extrude/detail/source.hpp"
#include "plans.hpp"

namespace {

namespace geometry = mansard::geometry;
namespace extrude = mansard::extrude;

namespace model = mansard::model;

using namespace plans;
using extrude::Canonical;
using testing::HasSubstr;

auto made(const Plan& p, const extrude::Options& options = {}) -> Canonical {
  auto result = extrude::canonical(p, options);
  if (!result) {
    ADD_FAILURE() << base::to_string(result.error()) << " " << text(p);
    return {};
  }
  return std::move(*result);
}

auto refusal(const Plan& p, const extrude::Options& options = {}) -> std::string {
  const auto result = extrude::canonical(p, options);
  return result ? "accepted" : result.error().code + ": " + result.error().message;
}

template <class Body>
void for_seeds(std::uint64_t count, Body body) {
  if (const char* only = std::getenv("MANSARD_SEED")) {
    body(std::strtoull(only, nullptr, 10));
    return;
  }
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    SCOPED_TRACE("MANSARD_SEED=" + std::to_string(seed));
    body(seed);
    if (testing::Test::HasFatalFailure()) return;
  }
}

/// Edges cut into pieces and shaken by 10 cm down to a nanometre, points nearly repeated, profiles changed at random:
/// what tracing and rounding make of outlines. No rings when it crosses itself.
auto shaken_plan(std::uint64_t seed) -> Plan {
  Plan p = random_plan(seed);
  base::Random random(seed, 2);
  const double by = std::pow(10.0, -1.0 - static_cast<double>(random.index(9)));
  const auto shaken = [&](Point2 v) { return v + Point2{random.uniform(-by, by), random.uniform(-by, by)}; };
  model::PlanRing out;
  const auto& corners = p.outer.points;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::size_t pieces = 1 + random.index(6);
    for (std::size_t k = 0; k < pieces; ++k) {
      const double at = static_cast<double>(k) / static_cast<double>(pieces);
      out.points.push_back(shaken(corners[i] + at * (corners[(i + 1) % corners.size()] - corners[i])));
      out.profile_of_edge.push_back(random.index(3) == 0 ? static_cast<std::uint32_t>(random.index(p.profiles.size()))
                                                         : p.outer.profile_of_edge[i]);
    }
    if (random.index(8) == 0) {
      out.points.push_back(shaken(out.points.back()));
      out.profile_of_edge.push_back(out.profile_of_edge.back());
    }
  }
  p.outer = std::move(out);
  if (!geometry::is_simple({p.outer.points, {}})) p.outer = {};
  return p;
}

/// The rings from their least corners on.
auto rings_of(const Plan& p) -> std::vector<model::PlanRing> {
  std::vector<model::PlanRing> rings{p.outer};
  rings.insert(rings.end(), p.holes.begin(), p.holes.end());
  for (auto& ring : rings) {
    const auto first = std::ranges::min_element(ring.points) - ring.points.begin();
    std::ranges::rotate(ring.points, ring.points.begin() + first);
    std::ranges::rotate(ring.profile_of_edge, ring.profile_of_edge.begin() + first);
  }
  return rings;
}

/// The greatest distance of points along one outline from the other, by sampling: never more than the true one.
auto sampled_distance(const Plan& from, const Plan& to) -> double {
  double most = 0;
  const auto& ring = from.outer.points;
  for (std::size_t i = 0; i < ring.size(); ++i)
    for (int k = 0; k < 16; ++k) {
      const Point2 p = ring[i] + (k / 16.0) * (ring[(i + 1) % ring.size()] - ring[i]);
      most = std::max(most, geometry::boundary_distance(model::polygon_of(to), p));
    }
  return most;
}

// ---- what it merges

TEST(Canonical, leaves_a_plain_house_alone) {
  const Plan p = plan({{0, 0}, {10, 0}, {10, 6}, {4, 6}, {4, 9}, {0, 9}}, {hip});
  const Canonical c = made(p);
  EXPECT_EQ(c.plan, p);
  EXPECT_EQ(c.moved, 0);
  EXPECT_TRUE(c.reasons.empty());
  EXPECT_EQ(c.directions, 1U);
}

TEST(Canonical, drops_repeated_points_and_tells) {
  const Canonical c = made(plan({{0, 0}, {10, 0}, {10, 0}, {10, 6}, {0, 6}, {0, 0}}, {hip}));
  EXPECT_EQ(c.plan.outer.points.size(), 4U);
  EXPECT_EQ(c.repeated_points, 2U);
  ASSERT_EQ(c.reasons.size(), 1U);
  EXPECT_EQ(c.reasons[0].code, "extrude-straightened");
}

TEST(Canonical, makes_one_edge_of_collinear_neighbours_with_one_profile_and_a_joint_where_it_changes) {
  //   |  hip  |  hip  |  wall  |
  const Canonical c = made(plan({{0, 0}, {3, 0}, {6, 0}, {9, 0}, {9, 5}, {0, 5}}, {hip, wall}, {0, 0, 1, 0, 0, 0}));
  EXPECT_THAT(c.plan.outer.points,
              testing::ElementsAre(Point2{0, 0}, Point2{6, 0}, Point2{9, 0}, Point2{9, 5}, Point2{0, 5}));
  EXPECT_THAT(c.plan.outer.profile_of_edge, testing::ElementsAre(0, 1, 0, 0, 0));
  EXPECT_EQ(c.collinear, 2U);
  EXPECT_EQ(c.joints, 1U);
}

TEST(Canonical, calls_profiles_that_climb_alike_one) {
  const Profile same{{0, 0}, {0, 1.25}, {0, 3}, {1, 4}};  // a knot on a straight run
  const Canonical c = made(plan({{0, 0}, {3, 0}, {9, 0}, {9, 5}, {0, 5}}, {hip, same}, {0, 1, 0, 0, 0}));
  EXPECT_EQ(c.plan.outer.points.size(), 4U);
  EXPECT_EQ(c.straight_knots, 1U);
  EXPECT_EQ(c.plan.profiles[1], hip);
}

TEST(Canonical, takes_terraces_without_run_and_storeys_without_height_out_of_profiles) {
  const Profile odd{{0, 0}, {0, 3}, {1e-6, 3}, {0.000001, 3.000001}, {1, 4}};
  const Canonical c = made(plan(box(9, 5), {odd}));
  EXPECT_EQ(c.plan.profiles[0], hip);
  EXPECT_EQ(c.empty_parts, 2U);
}

TEST(Canonical, straightens_a_bulge_but_not_a_bend) {
  const Canonical bulge = made(plan({{0, 0}, {5, -0.02}, {10, 0}, {10, 6}, {0, 6}}, {hip}));
  EXPECT_EQ(bulge.plan.outer.points.size(), 4U);
  EXPECT_EQ(bulge.straightened, 1U);
  EXPECT_NEAR(bulge.moved, 0.02, 1e-3);
  // tried: lower --extrude-merge-angle to keep them
  extrude::Options exact;
  exact.merge_angle = 0;
  const Canonical kept = made(plan({{0, 0}, {5, -0.02}, {10, 0}, {10, 6}, {0, 6}}, {hip}), exact);
  EXPECT_EQ(kept.plan.outer.points.size(), 5U);
  EXPECT_TRUE(kept.reasons.empty());
  EXPECT_EQ(made(plan({{0, 0}, {5, -0.03}, {10, 0}, {10, 6}, {0, 6}}, {hip})).plan.outer.points.size(), 5U);
}

TEST(Canonical, makes_nearly_parallel_and_perpendicular_edges_exactly_so) {
  const Canonical c = made(turned(plan({{0, 0}, {10, 0.0004}, {10.0003, 6}, {0, 6.0005}}, {hip}), 0.3));
  EXPECT_EQ(c.directions, 1U);
  EXPECT_LT(c.moved, 1e-3);
}

TEST(Canonical, keeps_a_jog_of_one_grid_unit_that_lies_on_the_grid) {
  const double q = 0x1p-16;
  const Plan p = plan({{0, 0}, {5, 0}, {5, q}, {10, q}, {10, 6}, {0, 6}}, {hip});
  EXPECT_EQ(made(p).plan, p);
}

TEST(Canonical, drops_a_jog_of_a_micrometre) {
  const Canonical c = made(turned(plan({{0, 0}, {5, 0}, {5, 1e-6}, {10, 1e-6}, {10, 6}, {0, 6}}, {hip}), 0.3));
  EXPECT_EQ(c.plan.outer.points.size(), 4U);
}

TEST(Canonical, follows_a_raster_outline_within_tolerance) {
  // A diagonal in steps of a pixel is an outline of real corners; one in steps under the tolerance is a line.
  const auto stairs = [](double pixel) {
    Ring ring{{0, 0}, {20 * pixel, 0}};
    for (int i = 1; i <= 10; ++i) {
      ring.push_back({(20 - i) * pixel, 2 * i * pixel - pixel});
      ring.push_back({(20 - i) * pixel, 2 * i * pixel});
    }
    ring.push_back({0, 20 * pixel});
    return plan(ring, {hip});
  };
  const Canonical coarse = made(stairs(0.5));
  EXPECT_LE(coarse.moved, 1e-3);
  const Canonical turned_coarse = made(turned(stairs(0.5), 0.4));
  EXPECT_EQ(turned_coarse.plan.outer.points.size(), coarse.plan.outer.points.size());
}

TEST(Canonical, straightens_round_outlines_alike_on_all_sides) {
  Ring ring;
  constexpr int n = 2000;  // turns of 0.18°
  for (int i = 0; i < n; ++i)
    ring.push_back({20 * std::cos(2 * std::numbers::pi * i / n), 20 * std::sin(2 * std::numbers::pi * i / n)});
  const Canonical c = made(plan(ring, {hip}));
  EXPECT_LT(c.plan.outer.points.size(), 150U);
  EXPECT_GT(c.plan.outer.points.size(), 40U);
  EXPECT_LE(c.moved, 0.05);
}

// ---- what it refuses

TEST(Canonical, says_where_edges_cross_and_what_to_do) {
  EXPECT_THAT(
      refusal(plan({{0, 0}, {9, 4}, {9, 0}, {0, 6}}, {hip})),
      testing::AllOf(HasSubstr("extrude-not-simple: edge 0 and edge 2 cross at (5.400, 2.400)"), HasSubstr(";")));
}

TEST(Canonical, says_where_a_ring_touches_itself) {
  EXPECT_THAT(refusal(plan({{0, 0}, {4, 0}, {4, 4}, {8, 4}, {8, 8}, {4, 8}, {4, 4}, {0, 4}}, {hip})),
              HasSubstr("touch at (4.000, 4.000); a ring may not touch itself: make two parts"));
  EXPECT_THAT(refusal(plan({{0, 0}, {8, 0}, {8, 4}, {4, 0}, {0, 4}}, {hip})),
              HasSubstr("edge 0 and edge 2 touch at (4.000, 0.000)"));
}

TEST(Canonical, says_where_edges_lie_on_each_other) {
  EXPECT_THAT(refusal(plan({{0, 0}, {9, 0}, {9, 4}, {5, 4}, {5, 7}, {5, 4}, {0, 4}}, {hip})),
              testing::AnyOf(HasSubstr("fold back on each other at (5.000, 7.000); remove the corner"),
                             HasSubstr("lie on each other")));
  EXPECT_THAT(
      refusal(plan({{0, 0}, {9, 0}, {9, 4}, {6, 4}, {6, 2}, {3, 2}, {3, 6}, {6, 6}, {6, 4}, {3, 4}, {0, 4}}, {hip})),
      HasSubstr("extrude-not-simple"));
}

TEST(Canonical, names_holes_by_number) {
  const auto hole = [](Ring ring) {
    return plan(box(10, 10), {hip}, {}, 100, {turned_in({{1, 1}, {2, 1}, {2, 2}}), turned_in(std::move(ring))});
  };
  EXPECT_THAT(refusal(hole({{8, 1}, {14, 1}, {14, 3}})), HasSubstr("of hole 2 cross"));
  EXPECT_THAT(refusal(hole({{12, 1}, {14, 1}, {14, 3}})),
              HasSubstr("hole 2 near (14.000, 3.000) lies outside of the footprint"));
  EXPECT_THAT(refusal(hole({{10, 1}, {9, 3}, {8, 2}})),
              HasSubstr("edge 1 and edge 1 of hole 2 touch at (10.000, 1.000); rings may not"));
  EXPECT_THAT(refusal(hole({{1, 1}, {0.5, 0.5}, {5, 1}})), HasSubstr("of hole 1"));
}

TEST(Canonical, counts_the_places) {
  EXPECT_THAT(refusal(plan({{0, 0}, {10, 0}, {10, 4}, {8, -1}, {6, 4}, {4, -1}, {2, 4}, {0, 4}}, {hip})),
              HasSubstr("(4 such places)"));
}

TEST(Canonical, refuses_what_is_no_building_in_metres) {
  EXPECT_THAT(refusal(plan(box(1e7, 1e7), {hip})), HasSubstr("4,000 km across; coordinates must be metres"));
  EXPECT_THAT(refusal(plan({}, {hip})), HasSubstr("extrude-no-area"));
  EXPECT_THAT(refusal(plan({{0, 0}, {4, 4}, {4, 0}, {0, 4}}, {hip})), HasSubstr("cross at (2.000, 2.000)"));
  EXPECT_THAT(refusal(plan(box(9, 9), {{{0, 0}, {0, 2e6}}})), HasSubstr("extrude-profile: profile 0 reaches beyond"));
}

TEST(Canonical, refuses_a_slit_that_closes_on_the_grid_and_names_it) {
  // 3 µm wide, not on the grid.
  const Plan slit =
      plan({{0, 0}, {4.00001, 0}, {4.00001, 5}, {4.000013, 5}, {4.000013, 0}, {9, 0}, {9, 8}, {0, 8}}, {hip});
  EXPECT_THAT(refusal(turned(slit, 0.3)),
              testing::AllOf(HasSubstr("extrude-canonical: edge "), HasSubstr("millimetre")));
}

// ---- how far it may lie from the input, and what it guarantees

void keeps_guarantees(const Plan& p) {
  const auto result = extrude::canonical(p);
  ASSERT_TRUE(result) << base::to_string(result.error()) << " " << text(p);
  EXPECT_TRUE(geometry::is_simple(model::polygon_of(result->plan)));
  EXPECT_LE(result->moved, extrude::Options{}.tolerance);
  double off = result->moved + 1e-9;
  const auto at_corner = extrude::corner_edges_of(p.outer.points);
  if (std::ranges::find(at_corner, true) != at_corner.end()) off += extrude::longest_corner_edge;
  EXPECT_LE(sampled_distance(p, result->plan), off);
  EXPECT_LE(sampled_distance(result->plan, p), off);
}

TEST(Guarantee, one_the_canonical_outline_is_simple_and_within_the_bound_it_tells) {
  for_seeds(150, [](std::uint64_t seed) { keeps_guarantees(random_plan(seed)); });
}

TEST(Guarantee, one_the_same_for_shaken_outlines) {
  std::size_t tried = 0;
  for_seeds(400, [&](std::uint64_t seed) {
    const Plan p = shaken_plan(seed);
    if (p.outer.points.empty()) return;
    ++tried;
    keeps_guarantees(p);
  });
  EXPECT_GT(tried, std::getenv("MANSARD_SEED") == nullptr ? 200U : 0U);
}

TEST(Guarantee, three_canonical_of_canonical_changes_nothing) {
  std::size_t tried = 0, changed = 0;
  const auto look = [&](const Plan& p) {
    const Canonical once = made(p);
    const Canonical twice = made(once.plan);
    ++tried;
    if (rings_of(twice.plan) != rings_of(once.plan)) ++changed;
    EXPECT_EQ(twice.plan.profiles, once.plan.profiles);
  };
  for_seeds(300, [&](std::uint64_t seed) {
    look(random_plan(seed));
    EXPECT_EQ(changed, 0U);
  });
  for_seeds(400, [&](std::uint64_t seed) {
    if (const Plan p = shaken_plan(seed); !p.outer.points.empty()) look(p);
  });
  EXPECT_LE(changed, tried / 200);  // where turns straightened one after the other come near the tolerance
}

TEST(Guarantee, four_turned_mirrored_shifted_and_renumbered_plans_have_the_same_form_so_treated) {
  const auto quarter = [](const Plan& p) { return mapped(p, [](Point2 v) { return Point2{-v.y, v.x}; }); };
  for_seeds(300, [&](std::uint64_t seed) {
    const Plan p = random_plan(seed);
    const Plan c = made(p).plan;
    EXPECT_EQ(rings_of(made(quarter(p)).plan), rings_of(quarter(c)));
    EXPECT_EQ(rings_of(made(mirrored(p)).plan), rings_of(mirrored(c)));
    EXPECT_EQ(rings_of(made(rotated_start(p, 1 + seed % 3)).plan), rings_of(c));
    // So that the shift itself loses no digits.
    const Plan q = mapped(p, [](Point2 v) {
      return Point2{std::nearbyint(v.x * 0x1p30) * 0x1p-30, std::nearbyint(v.y * 0x1p30) * 0x1p-30};
    });
    const auto here = rings_of(made(q).plan), there = rings_of(made(shifted(q, {1024, -517})).plan);
    ASSERT_EQ(here.size(), there.size());
    ASSERT_EQ(here[0].points.size(), there[0].points.size());
    for (std::size_t i = 0; i < here[0].points.size(); ++i)
      EXPECT_LE(length(here[0].points[i] + Point2{1024, -517} - there[0].points[i]), 3e-13);  // the rounding of doubles
  });
}

TEST(Guarantee, four_shaken_outlines_too) {
  for_seeds(200, [](std::uint64_t seed) {
    const Plan p = shaken_plan(seed);
    if (p.outer.points.empty()) return;
    const Plan c = made(p).plan;
    EXPECT_EQ(rings_of(made(rotated_start(p, 1 + seed % 5)).plan), rings_of(c));
    EXPECT_EQ(rings_of(made(mirrored(p)).plan), rings_of(mirrored(c)));
  });
}

TEST(Canonical, bearings_turn_and_mirror_bit_for_bit) {
  base::Random random(5);
  for (int i = 0; i < 2000; ++i) {
    const Point2 v{random.uniform(-1, 1), random.uniform(-1, 1)};
    const auto d = extrude::detail::direction_of(extrude::detail::bearing_of(v));
    EXPECT_EQ(extrude::detail::direction_of(extrude::detail::bearing_of({-v.y, v.x})), d.left());
    const auto m = extrude::detail::direction_of(extrude::detail::bearing_of({-v.x, v.y}));
    EXPECT_EQ(m, (extrude::detail::Direction{-d.a, d.b, d.l}));
    EXPECT_EQ(static_cast<extrude::detail::Int128>(d.a) * d.a + static_cast<extrude::detail::Int128>(d.b) * d.b,
              static_cast<extrude::detail::Int128>(d.l) * d.l);
    EXPECT_LT(std::abs(cross(d.approximate(), normalised(v))), 1.1e-6);
  }
}

TEST(Canonical, agrees_with_the_geometry_module_on_what_is_simple) {
  base::Random random(11);
  std::size_t simple = 0;
  for (int i = 0; i < 3000; ++i) {
    Ring ring;
    const std::size_t n = 3 + random.index(5);
    for (std::size_t k = 0; k < n; ++k)
      ring.push_back({static_cast<double>(random.index(4)), static_cast<double>(random.index(4))});
    bool repeated = false;
    for (std::size_t k = 0; k < n; ++k) repeated = repeated || ring[k] == ring[(k + 1) % n];
    if (repeated) continue;
    const std::vector<extrude::detail::GridRing> grid{extrude::detail::on_fine_grid(ring, {})};
    const bool is = !extrude::detail::meetings_of(grid).first;
    EXPECT_EQ(is, geometry::is_simple({ring, {}}));
    simple += is ? 1 : 0;
  }
  EXPECT_GT(simple, 100U);
}

// ---- the coarser source

TEST(Simplified, takes_details_away_and_stays_simple) {
  for_seeds(60, [](std::uint64_t seed) {
    base::Random random(seed);
    const Plan p = plan(star(random, 12 + random.index(60)), {hip});
    const auto source = extrude::detail::prepared(p);
    ASSERT_TRUE(source);
    const auto coarse = extrude::detail::simplified(*source, 1.5);
    const Ring& ring = coarse.rings[0].points;
    EXPECT_LE(ring.size(), p.outer.points.size());
    EXPECT_EQ(ring.size(), coarse.rings[0].edge.size());
    EXPECT_TRUE(geometry::is_simple({ring, {}}));
    EXPECT_GT(geometry::signed_area(ring), 0);
  });
}

// ---- nudges

TEST(Nudged, footprints_stay_simple_within_tolerance_and_on_the_grid) {
  for_seeds(40, [](std::uint64_t seed) {
    const auto source = extrude::detail::prepared(random_plan(seed));
    ASSERT_TRUE(source);
    std::string why, how;
    const extrude::Options options;
    const auto footprint = extrude::detail::canonical(*source, options, why);
    ASSERT_TRUE(footprint) << why;
    for (int attempt = 0; attempt < extrude::detail::most_nudges; ++attempt) {
      const auto nudged = extrude::detail::nudged(*footprint, attempt, options, how);
      if (!nudged) continue;
      EXPECT_NE(how, "");
      EXPECT_LE(nudged->moved, options.tolerance);
      EXPECT_FALSE(extrude::detail::clash_in(nudged->corners));
      for (std::size_t i = 0; i < nudged->rings[0].size(); ++i) {
        const auto& edge = nudged->rings[0][i];
        EXPECT_EQ(65536 % edge.offset.get_den(), 0);
        EXPECT_GE(edge.offset, footprint->rings[0][i].offset);
        EXPECT_LE(edge.offset - footprint->rings[0][i].offset, extrude::detail::Rational(3, 1000));
        const auto& p = nudged->corners[0][i];
        const auto on_line = [&](const extrude::detail::CanonicalEdge& e) {
          return e.direction.a * p.y - e.direction.b * p.x == e.offset * e.direction.l;
        };
        EXPECT_TRUE(on_line(edge));
        EXPECT_TRUE(on_line(nudged->rings[0][(i + nudged->rings[0].size() - 1) % nudged->rings[0].size()]));
      }
      for (const auto& track : nudged->tracks)
        for (const auto& part : track) EXPECT_EQ(65536 % part.inward.get_den(), 0);
    }
  });
}

TEST(Nudged, part_walls_where_shorter_runs_do_not) {
  // Setbacks above a stepped outline whose walls still meet in a line when all runs are shortened alike.
  const auto raised = extrude::raise(random_plan(14629));
  ASSERT_TRUE(raised);
  EXPECT_EQ(raised->outcome, extrude::Outcome::full);
  ASSERT_FALSE(raised->warnings.empty());
  EXPECT_EQ(raised->warnings[0].code, "extrude-nudged");
  EXPECT_THAT(raised->warnings[0].message, HasSubstr("mm"));
  EXPECT_EQ(faults(raised->solid), "");
}

}  // namespace
