// The guarantees of docs/extrude.md over random plans. The seeds are fixed and printed with a failure.
#include <gmock/gmock.h>

#include "mansard/extrude/extrude.hpp"
#include "plans.hpp"

namespace {

using namespace plans;
using extrude::Outcome;

constexpr std::uint64_t seeds = 60;

auto raised(const Plan& p) -> extrude::Solid {
  auto result = extrude::raise(p);
  if (!result) {
    ADD_FAILURE() << base::to_string(result.error()) << " " << text(p);
    return {};
  }
  EXPECT_EQ(result->outcome, Outcome::full)
      << (result->warnings.empty() ? "" : result->warnings.front().message) << " " << text(p);
  return std::move(result->solid);
}

TEST(Guarantee, one_and_two_the_solid_is_closed_manifold_and_free_of_self_intersection) {
  for (std::uint64_t seed = 0; seed < 2 * seeds; ++seed) {
    SCOPED_TRACE(seed);
    EXPECT_EQ(faults(raised(random_plan(seed))), "");
  }
}

TEST(Guarantee, two_a_vertical_ray_meets_the_roof_once) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    const Plan p = random_plan(seed);
    const auto solid = raised(p);
    base::Random random(seed, 1);
    const auto area = geometry::bounds(p.outer.points);
    for (int ray = 0; ray < 20; ++ray) {
      const Point2 at{random.uniform(area.least.x, area.most.x), random.uniform(area.least.y, area.most.y)};
      if (geometry::boundary_distance(geometry::polygon_of(p), at) < 0.01) continue;
      const auto heights = roofs_over(solid, at);
      EXPECT_EQ(heights.size(), geometry::contains(geometry::polygon_of(p), at) ? 1U : 0U) << at.x << " " << at.y;
      for (const double z : heights) EXPECT_LE(z, p.cap + 1e-6);
    }
  }
}

TEST(Guarantee, three_the_volume_is_the_integral_of_the_sections) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    const auto solid = raised(random_plan(seed));
    EXPECT_NEAR(extrude::volume(solid), integrated_volume(solid), 1e-4);
  }
}

TEST(Guarantee, four_a_uniform_roofs_section_is_the_footprint_shrunk) {
  // An outside judge: the offset polygon of the geometry library.
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    Plan p = random_plan(seed);
    p.profiles = {tent};
    p.outer.profile_of_edge.assign(p.outer.points.size(), 0);
    p.cap = 100;
    const auto solid = raised(p);
    for (const double z : {0.31, 0.77, 1.23, 1.91, 2.83}) {
      const auto shrunk = geometry::buffer(geometry::polygon_of(p), -z);
      ASSERT_TRUE(shrunk);
      double area = 0;
      for (const auto& part : *shrunk) area += geometry::area(part);
      EXPECT_NEAR(section_area(solid, z), area, 0.01 + 2e-3 * area) << z;
    }
  }
}

TEST(Guarantee, seven_over_a_convex_footprint_the_roof_is_the_lower_envelope_of_its_planes) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    base::Random random(seed);
    Ring ring;
    const std::size_t n = 3 + random.index(7);
    for (std::size_t i = 0; i < n; ++i) {
      const double angle =
          2 * std::numbers::pi * (static_cast<double>(i) + random.uniform(0.2, 0.8)) / static_cast<double>(n);
      ring.push_back({9 * std::cos(angle), 9 * std::sin(angle)});
    }
    Plan p = plan(ring, {});
    std::vector<double> slopes;
    for (std::size_t i = 0; i < n; ++i) {
      slopes.push_back(static_cast<double>(1 + random.index(6)) / 4);  // run over rise
      p.profiles.push_back({{0, 0}, {4 * slopes.back(), 4}});
      p.outer.profile_of_edge[i] = static_cast<std::uint32_t>(i);
    }
    const auto solid = raised(p);
    for (int ray = 0; ray < 20; ++ray) {
      const Point2 at{random.uniform(-6, 6), random.uniform(-6, 6)};
      if (!geometry::contains(ring, at) || geometry::boundary_distance({ring, {}}, at) < 0.05) continue;
      double envelope = 1e9;
      for (std::size_t i = 0; i < n; ++i) {
        const Point2 a = ring[i], b = ring[(i + 1) % n];
        envelope = std::min(envelope, dot(left_of(normalised(b - a)), at - a) / slopes[i]);
      }
      const auto heights = roofs_over(solid, at);
      ASSERT_EQ(heights.size(), 1U);
      EXPECT_NEAR(heights[0], envelope, 2e-3);
    }
  }
}

TEST(Guarantee, eight_mirrored_shifted_and_renumbered_plans_give_the_same_solid) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    const Plan p = random_plan(seed);
    const auto solid = raised(p);
    const double volume = extrude::volume(solid);
    const auto same = [&](const Plan& other, double within) {
      const auto image = raised(other);
      EXPECT_NEAR(extrude::volume(image), volume, within * (1 + volume));
      EXPECT_EQ(image.faces.size(), solid.faces.size());
      EXPECT_EQ(image.vertices.size(), solid.vertices.size());
    };
    same(rotated_start(p, 1 + seed % 3), 1e-9);
    if (seed % 2 == 0) continue;  // stars: mirroring and shifting round their corners anew
    same(shifted(p, {1234, -987}), 1e-9);
    same(mirrored(p), 1e-9);
  }
}

TEST(Guarantee, eight_a_turned_plan_gives_the_same_volume) {
  for (std::uint64_t seed = 1; seed < seeds; seed += 2) {
    SCOPED_TRACE(seed);
    const Plan p = random_plan(seed);
    const double volume = extrude::volume(raised(p));
    EXPECT_NEAR(extrude::volume(raised(turned(p, 0.3))), volume,
                3e-3 * volume);  // where upright walls meet in a line exactly, runs are shortened
  }
}

TEST(Guarantee, nine_a_profile_cut_at_an_interior_knot_changes_nothing) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    const Plan p = random_plan(seed);
    Plan cut = p;
    for (Profile& profile : cut.profiles) {
      const auto last = profile.back(), before = profile[profile.size() - 2];
      profile.insert(profile.end() - 1, {before.inward + 0.25 * (last.inward - before.inward),
                                         before.height + 0.25 * (last.height - before.height)});
    }
    const auto a = raised(p), b = raised(cut);
    EXPECT_EQ(a.vertices, b.vertices);
  }
}

TEST(Guarantee, nine_a_lower_cap_cuts_the_higher_solid) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    Plan p = random_plan(seed);
    p.cap = 9;
    const auto high = raised(p);
    p.cap = 4.75;
    const auto low = raised(p);
    for (const double z : {0.4, 1.3, 2.7, 3.6, 4.7})
      EXPECT_NEAR(section_area(low, z), section_area(high, z), 1e-4) << z;
  }
}

TEST(Guarantee, ten_more_run_never_gives_more_volume) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    Plan p = random_plan(seed);
    const double before = extrude::volume(raised(p));
    Profile& profile = p.profiles[seed % p.profiles.size()];
    for (std::size_t i = 1; i < profile.size(); ++i) profile[i].inward *= 1.25;
    EXPECT_LE(extrude::volume(raised(p)), before * (1 + 2e-3));  // runs can be shortened by 0.1 %
  }
}

TEST(Guarantee, two_raises_give_the_same_bytes) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Plan p = random_plan(seed);
    const auto a = raised(p), b = raised(p);
    EXPECT_EQ(a.vertices, b.vertices);
    ASSERT_EQ(a.faces.size(), b.faces.size());
    for (std::size_t f = 0; f < a.faces.size(); ++f) EXPECT_EQ(a.faces[f].loops, b.faces[f].loops);
  }
}

}  // namespace
