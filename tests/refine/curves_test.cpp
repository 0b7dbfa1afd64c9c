// Round plans: the chords of a curve are one side, and a roof that bends has as many pitches as it takes.
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <numbers>

#include "mansard/refine/detail/steps.hpp"
#include "mansard/refine/detail/strips.hpp"
#include "mansard/refine/law.hpp"
#include "scans.hpp"

namespace {

namespace geometry = mansard::geometry;
namespace model = mansard::model;

using namespace scans;
namespace detail = refine::detail;

auto circle(double radius, int chords) -> geometry::Ring {
  geometry::Ring out;
  for (int i = 0; i < chords; ++i) {
    const double angle = 2 * std::numbers::pi * i / chords;
    out.push_back({10 + radius * std::cos(angle), 20 + radius * std::sin(angle)});
  }
  return out;
}

/// One profile for all edges.
auto all_alike(geometry::Ring ring, const Profile& profile, double cap) -> Plan {
  Plan out = plan(std::move(ring), {profile}, cap);
  std::ranges::fill(out.outer.profile_of_edge, 0U);
  return out;
}
/// Half a sphere over a wall of 5 m, in as many pitches as anyone might want.
auto dome(double radius) -> Profile {
  Profile out{{0, 0}, {0, 5}};
  constexpr int pitches = 40;
  for (int i = 1; i <= pitches; ++i) {
    const double angle = std::numbers::pi / 2 * i / pitches;
    out.push_back({radius * (1 - std::cos(angle)), 5 + radius * std::sin(angle)});
  }
  return out;
}
auto draft_of(const Plan& truth) -> refine::Draft { return {0, all_alike(truth.outer.points, wall(6), 6), {6}, {}}; }
auto refined(const Plan& truth, double noise) -> refine::Part {
  model::Accuracy accuracy;
  accuracy.noise = 0.03, accuracy.correlated_area = 0.5;
  auto options = refine::decided_by({}, accuracy);
  options.effort = refine::Effort::planes;
  auto out = refine::refine(std::vector{draft_of(truth)}, scan({truth}, noise), options, {});
  EXPECT_EQ(out.parts.size(), 1U);
  EXPECT_TRUE(mansard::solid::check(out.parts[0].raised.solid).empty());
  return std::move(out.parts[0]);
}
/// Faces by their slope, in hundredths.
auto slopes(const model::Solid& solid) -> std::map<int, int> {
  std::map<int, int> out;
  for (const auto& face : solid.faces)
    if (face.normal.z > 0.05)
      ++out[static_cast<int>(std::round(100 * std::hypot(face.normal.x, face.normal.y) / face.normal.z))];
  return out;
}

TEST(Curves, of_a_cone_have_one_pitch_all_around) {
  for (const int chords : {12, 32}) {
    const Plan truth = all_alike(circle(6, chords), roof(5, 0.8), 20);
    const auto part = refined(truth, 0.04);
    EXPECT_EQ(part.plan.profiles.size(), 1U);
    EXPECT_LT(difference({part}, {truth}), 0.05);
    const auto found = slopes(part.raised.solid);
    EXPECT_GE(found.rbegin()->second, chords) << "every chord has the same face";
  }
}

TEST(Curves, of_a_dome_have_the_pitches_that_it_takes_and_no_more) {
  const Plan truth = all_alike(circle(8, 24), dome(8), 20);
  const auto part = refined(truth, 0.04);
  EXPECT_LT(difference({part}, {truth}), 0.1);
  ASSERT_EQ(part.plan.profiles.size(), 1U);
  const auto pitches = part.plan.profiles[0].size() - 2;
  EXPECT_GE(pitches, 3U);
  EXPECT_LE(pitches, 7U) << "a chord of 15° of this arc is off by 7 cm at most";
  for (const auto& [slope, faces] : slopes(part.raised.solid)) {
    if (slope == 0) continue;
    EXPECT_GE(faces, 20) << slope;
  }
}

TEST(Curves, of_a_barrel_have_several_pitches_over_straight_sides) {
  const Profile half = [] {
    Profile out{{0, 0}, {0, 5}};
    for (int i = 1; i <= 20; ++i) {
      const double angle = std::numbers::pi * (0.25 + 0.25 * i / 20);
      out.push_back({4 * (1 - std::cos(angle) * std::sqrt(2)), 5 + 4 * (std::sqrt(2) * std::sin(angle) - 1)});
    }
    return out;
  }();
  const Plan truth = plan(rectangle(0, 0, 20, 8), {half, wall(9), half, wall(9)}, 20);
  Plan flat = plan(rectangle(0, 0, 20, 8), {wall(6), wall(6), wall(6), wall(6)}, 6);
  model::Accuracy accuracy;
  accuracy.noise = 0.03, accuracy.correlated_area = 0.5;
  const auto options = refine::decided_by({}, accuracy);
  const auto out = refine::refine(std::vector{refine::Draft{0, flat, {6}, {}}}, scan({truth}), options, {});
  EXPECT_LT(difference(out.parts, {truth}), 0.06);
}

TEST(Curves, count_as_one_face_for_each_pitch) {
  const Plan cone = all_alike(circle(6, 32), roof(5, 0.8), 20);
  const auto raised = mansard::extrude::raise(cone);
  const auto strips = detail::strips_of(cone, raised->solid);
  EXPECT_LT(strips.count, raised->solid.faces.size());
  EXPECT_LT(strips.count, 8U) << "walls, roof, ground, and what rounding leaves at the apex";
  const Plan box = plan(rectangle(0, 0, 20, 8), {wall(6), wall(6), wall(6), wall(6)}, 6);
  const auto plain = mansard::extrude::raise(box);
  EXPECT_EQ(detail::strips_of(box, plain->solid).count, plain->solid.faces.size());
}

TEST(Curves, take_another_profile_along_all_of_their_chords) {
  Plan apse;  // straight sides, and a half circle at one end
  for (int i = 0; i <= 12; ++i) {
    const double angle = std::numbers::pi * (i / 12.0 - 0.5);
    apse.outer.points.push_back({20 + 5 * std::cos(angle), 5 + 5 * std::sin(angle)});
  }
  apse.outer.points.push_back({0, 10});
  apse.outer.points.push_back({0, 0});
  apse.outer.profile_of_edge.assign(15, 0);
  apse.profiles = {wall(6)};
  apse.cap = 6;
  const auto out = detail::carrying(apse, 0, 5, roof(5, 0.8));
  ASSERT_EQ(out.profiles.size(), 2U);
  for (std::size_t i = 0; i < 15; ++i) EXPECT_EQ(out.outer.profile_of_edge[i], i < 12 ? 1U : 0U) << i;
  const auto side = detail::carrying(apse, 0, 13, roof(5, 0.8));
  EXPECT_EQ(std::ranges::count(side.outer.profile_of_edge, 1U), 1);
}

}  // namespace
