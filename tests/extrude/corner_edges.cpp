// Edges at corners: roof planes that rise in another direction than across a wall. Random cases print their seed.
#include "mansard/extrude/corner_edges.hpp"

#include <gmock/gmock.h>

#include <optional>

#include "mansard/extrude/align.hpp"
#include "mansard/extrude/canonical.hpp"
#include "plans.hpp"

namespace {

namespace extrude = mansard::extrude;
namespace model = mansard::model;

using namespace plans;

constexpr Point2 to_the_west{-1, 0};

auto corners(const model::PlanRing& ring) -> std::size_t {
  return static_cast<std::size_t>(std::ranges::count(extrude::corner_edges_of(ring.points), true));
}

/// The plan with a corner edge; a failure where there can be none.
auto with(Plan p, std::size_t corner, Point2 along, const Profile& profile) -> Plan {
  auto ring = extrude::with_corner_edge(p.outer, corner, along, static_cast<std::uint32_t>(p.profiles.size()));
  if (!ring) {
    ADD_FAILURE() << "no edge of that direction at corner " << corner << ": " << text(p);
    return p;
  }
  p.outer = *std::move(ring);
  p.profiles.push_back(profile);
  return p;
}

auto raised(const Plan& p) -> extrude::Raised {
  auto made = extrude::raise(p);
  if (!made) {
    ADD_FAILURE() << base::to_string(made.error()) << " " << text(p);
    return {};
  }
  EXPECT_EQ(faults(made->solid), "") << text(p);
  return *std::move(made);
}

auto is_full(const extrude::Raised& made) -> bool { return made.outcome == extrude::Outcome::full; }

//   (0, 10) +--.
//           |    `--.  (20, 8)
//           |  - - - -+  ridge at y = 5, z = 8
//           +---------+
auto oblique() -> Plan {
  return with(plan({{0, 0}, {20, 0}, {20, 8}, {0, 10}}, {hip, wall}, {0, 1, 1, 1}), 3, to_the_west, hip);
}

TEST(CornerEdges, a_gable_over_an_oblique_side_is_seven_faces) {
  const auto made = raised(oblique());
  EXPECT_TRUE(is_full(made));
  EXPECT_TRUE(made.warnings.empty()) << base::to_string(made.warnings.front());
  EXPECT_EQ(made.solid.faces.size(), 7U);  // no wall of the edge itself
  EXPECT_EQ(made.solid.vertices.size(), 10U);
  double top = 0;
  for (const Point3& v : made.solid.vertices) {
    top = std::max(top, v.z);
    if (length(xy(v) - Point2{20, 8}) < 1e-3 && v.z > 0) {
      EXPECT_NEAR(v.z, 5, 1e-4);
    }
  }
  EXPECT_NEAR(top, 8, 1e-4);
  for (const Point2 at : {Point2{1, 9}, Point2{19, 7.5}, Point2{10, 6}}) {
    const auto heights = roofs_over(made.solid, at);
    ASSERT_FALSE(heights.empty());
    EXPECT_NEAR(heights.front(), 3 + std::min(at.y, 10 - at.y), 1e-4);
  }
}

TEST(CornerEdges, a_bent_side_has_one_plane) {
  // The bend itself is the corner that the plane rises from.
  const auto p =
      with(plan({{0, 0}, {20, 0}, {20, 8}, {9, 9.5}, {0, 8.5}}, {hip, wall}, {0, 1, 1, 1, 1}), 3, to_the_west, hip);
  const auto made = raised(p);
  EXPECT_TRUE(is_full(made));
  EXPECT_EQ(made.solid.faces.size(), 8U);
  for (const Point2 at : {Point2{1, 8}, Point2{18, 8}, Point2{9, 9}}) {
    const auto heights = roofs_over(made.solid, at);
    ASSERT_FALSE(heights.empty());
    EXPECT_NEAR(heights.front(), 3 + 9.5 - at.y, 1e-4);
  }
}

TEST(CornerEdges, eaves_a_millimetre_apart_are_one) {
  for (const double off : {-9e-4, -1e-4, -1e-5, 1e-5, 1e-4, 9e-4}) {
    const Profile other{{0, 0}, {0, 3 + off}, {1, 4 + off}};
    const auto p = with(plan({{0, 0}, {20, 0}, {20, 8}, {0, 10}}, {hip, wall}, {0, 0, 1, 0}), 3, to_the_west, other);
    const auto made = raised(p);
    EXPECT_TRUE(is_full(made)) << off;
    EXPECT_EQ(made.solid.faces.size(), 9U) << off;
  }
}

TEST(CornerEdges, stand_between_the_directions_of_their_neighbours) {
  const auto p = plan(box(10, 8), {hip});
  const auto is_made = [&](std::size_t corner, double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    return extrude::with_corner_edge(p.outer, corner, {std::cos(angle), std::sin(angle)}, 0).has_value();
  };
  EXPECT_TRUE(is_made(1, 45));
  EXPECT_TRUE(is_made(1, 1));
  EXPECT_TRUE(is_made(1, 89));
  EXPECT_FALSE(is_made(1, 0.3));  // under half a degree: a turn that is straightened
  EXPECT_FALSE(is_made(1, 89.7));
  EXPECT_FALSE(is_made(1, -10));
  EXPECT_FALSE(is_made(1, 100));
  EXPECT_FALSE(is_made(1, 225));
  // At a corner that turns to the outside nothing lies between the sides.
  const auto l = plan({{0, 0}, {10, 0}, {10, 4}, {4, 4}, {4, 10}, {0, 10}}, {hip});
  for (int degrees = 0; degrees < 360; degrees += 10) {
    const double angle = degrees * std::numbers::pi / 180;
    EXPECT_FALSE(extrude::with_corner_edge(l.outer, 3, {std::cos(angle), std::sin(angle)}, 0)) << degrees;
  }
  // What is long enough to be a wall is one.
  EXPECT_FALSE(extrude::is_corner_edge({{0, 0}, {10, 0}, {10, 7.998}, {9.998, 8}, {0, 8}}, 2));
  EXPECT_TRUE(extrude::is_corner_edge({{0, 0}, {10, 0}, {10, 7.9996}, {9.9996, 8}, {0, 8}}, 2));
}

TEST(CornerEdges, their_corner_is_where_the_walls_meet) {
  const auto p = oblique();
  EXPECT_EQ(corners(p.outer), 1U);
  EXPECT_TRUE(extrude::is_corner_edge(p.outer.points, 3));
  const Point2 corner = extrude::corner_at(p.outer.points, 3);
  EXPECT_NEAR(corner.x, 0, 1e-9);
  EXPECT_NEAR(corner.y, 10, 1e-9);
}

TEST(CornerEdges, are_taken_off_where_a_roof_is_made_anew) {
  auto p = oblique();
  p.outer.overhang_of_edge = {0.1, 0.2, 0.3, 0.4, 0.5};
  const auto bare = extrude::without_corner_edges(p);
  ASSERT_EQ(bare.outer.points.size(), 4U);
  EXPECT_NEAR(length(bare.outer.points[3] - Point2{0, 10}), 0, 1e-9);
  EXPECT_EQ(bare.outer.profile_of_edge, (std::vector<std::uint32_t>{0, 1, 1, 1}));
  EXPECT_EQ(bare.outer.overhang_of_edge, (std::vector<double>{0.1, 0.2, 0.3, 0.5}));
  // The last edge of a ring, whose end is its first point.
  const auto last = extrude::without_corner_edges(rotated_start(oblique(), 4));
  EXPECT_EQ(last.outer.points.size(), 4U);
  EXPECT_NEAR(geometry::area({last.outer.points, {}}), 180, 1e-9);
}

TEST(CornerEdges, canonical_plans_keep_them_and_stay_as_they_are) {
  for (int k = 0; k < 24; ++k) {
    const auto p = shifted(turned(oblique(), 0.3 * k), {1000.3, 77.7});
    const auto once = extrude::canonical(p);
    ASSERT_TRUE(once);
    EXPECT_EQ(corners(once->plan.outer), 1U) << k;
    const auto twice = extrude::canonical(once->plan);
    ASSERT_TRUE(twice);
    EXPECT_EQ(once->plan, twice->plan) << k;
    EXPECT_EQ(raised(once->plan).solid.faces.size(), 7U) << k;
  }
}

TEST(CornerEdges, neighbours_on_one_line_keep_them) {
  // The house to the north stands 2 cm off the oblique wall; the shorter wall moves.
  const Point2 along = normalised(Point2{-20, 2}), out = -1.0 * left_of(along);
  const Point2 from = Point2{20, 8} + 0.02 * out - 5.0 * along, to = Point2{0, 10} + 0.02 * out + 5.0 * along;
  std::vector<Plan> plans{oblique(), plan({to, from, from + 9.0 * out, to + 9.0 * out}, {hip})};
  const auto made = extrude::align(plans);
  ASSERT_TRUE(made[0]);
  EXPECT_EQ(corners(made[0]->outer), 1U);
  const auto solid = raised(*made[0]);
  EXPECT_TRUE(is_full(solid));
  EXPECT_EQ(solid.solid.faces.size(), 7U);
  const Point2 corner = extrude::corner_at(made[0]->outer.points, 3);
  EXPECT_GT(length(corner - Point2{0, 10}), 0.01);
}

TEST(CornerEdges, one_whose_wall_turned_past_it_is_told) {
  // Between walls that are straightened to one there is no direction.
  const auto p =
      with(plan({{0, 0}, {20, 0}, {20, 8}, {10, 8.12}, {0, 8}}, {hip, wall}, {0, 1, 1, 1, 1}), 3, to_the_west, hip);
  extrude::Options options;
  options.merge_angle = 0.05;
  options.tolerance = 0.4;
  const auto made = extrude::raise(p, options);
  ASSERT_TRUE(made);
  EXPECT_EQ(faults(made->solid), "");
  EXPECT_TRUE(std::ranges::any_of(made->warnings, [](const auto& w) { return w.code == "extrude-corner-edge"; }));
}

/// A convex outline, no corner of which is sharper than a corner edge stands at.
auto convex(base::Random& random) -> Ring {
  Ring ring;
  const std::size_t n = 4 + random.index(5);
  for (std::size_t i = 0; i < n; ++i) {
    const double angle =
        2 * std::numbers::pi * (static_cast<double>(i) + random.uniform(-0.3, 0.3)) / static_cast<double>(n);
    ring.push_back({9 * std::cos(angle), 6 * std::sin(angle)});
  }
  return ring;
}

/// Any direction between those of the edges at a corner.
auto between(const Ring& ring, std::size_t corner, base::Random& random) -> Point2 {
  const std::size_t n = ring.size();
  const Point2 before = normalised(ring[corner] - ring[(corner + n - 1) % n]),
               after = normalised(ring[(corner + 1) % n] - ring[corner]);
  const double share = random.uniform(0.1, 0.9);
  return normalised((1 - share) * before + share * after);
}

TEST(Guarantee, seven_the_lower_envelope_with_the_planes_of_corner_edges) {
  std::size_t planes = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    base::Random random(seed, 7);
    const Ring ring = convex(random);
    const std::size_t n = ring.size();
    struct Plane {
      Point2 at, inward;
      double slope = 0;
    };
    std::vector<Plane> all;
    std::vector<Profile> profiles{wall};
    std::vector<std::uint32_t> of_edge(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
      if (random.index(3) == 0) continue;  // a gable
      const double slope = random.uniform(0.4, 1.5);
      of_edge[i] = static_cast<std::uint32_t>(profiles.size());
      profiles.push_back({{0, 0}, {0, 3}, {1, 3 + slope}});
      all.push_back({ring[i], left_of(normalised(ring[(i + 1) % n] - ring[i])), slope});
    }
    Plan p = plan(ring, profiles, of_edge, 20);
    for (std::size_t i = n; i-- > 0;) {
      if (random.index(2) == 0) continue;
      const double slope = random.uniform(0.2, 0.8);
      const Point2 along = between(ring, i, random);
      auto with_edge = extrude::with_corner_edge(p.outer, i, along, static_cast<std::uint32_t>(p.profiles.size()));
      if (!with_edge) continue;
      p.outer = *std::move(with_edge);
      p.profiles.push_back({{0, 0}, {0, 3}, {1, 3 + slope}});
      all.push_back({ring[i], left_of(along), slope});
      ++planes;
    }
    const auto made = raised(p);
    ASSERT_TRUE(is_full(made)) << text(p);
    for (int k = 0; k < 40; ++k) {
      const Point2 at{random.uniform(-8, 8), random.uniform(-5, 5)};
      if (!geometry::contains({ring, {}}, at) || geometry::boundary_distance({ring, {}}, at) < 0.05) continue;
      double expected = 20;
      for (const Plane& one : all) expected = std::min(expected, 3 + one.slope * dot(at - one.at, one.inward));
      const auto heights = roofs_over(made.solid, at);
      ASSERT_FALSE(heights.empty()) << text(p);
      EXPECT_NEAR(*std::ranges::max_element(heights), expected, 2e-3) << text(p);
    }
  }
  EXPECT_GT(planes, 300U);
}

TEST(Guarantee, one_random_plans_with_corner_edges_are_sound) {
  std::size_t edges = 0, full = 0, tried = 0;
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    base::Random random(seed, 8);
    Plan p = random_plan(seed);
    for (std::size_t i = p.outer.points.size(); i-- > 0;) {
      if (random.index(2) == 0) continue;
      auto with_edge = extrude::with_corner_edge(p.outer, i, between(p.outer.points, i, random),
                                                 static_cast<std::uint32_t>(random.index(p.profiles.size())));
      if (!with_edge) continue;
      p.outer = *std::move(with_edge);
      ++edges;
    }
    ++tried;
    const auto made = raised(p);
    full += is_full(made) ? 1 : 0;
    double shortest = 1;
    for (const auto& face : made.solid.faces)
      for (const auto& loop : face.loops)
        for (std::size_t i = 0; i < loop.size(); ++i)
          shortest = std::min(shortest,
                              length(made.solid.vertices[loop[(i + 1) % loop.size()]] - made.solid.vertices[loop[i]]));
    EXPECT_GT(shortest, 1e-4) << text(p);  // the edge itself, a micrometre long, is never seen
  }
  EXPECT_GT(edges, 2000U);
  EXPECT_GE(static_cast<double>(full), 0.98 * static_cast<double>(tried)) << full << " of " << tried;
}

}  // namespace
