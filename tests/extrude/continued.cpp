// Holes of a roof behind which a slope goes on: one plane, one face.
#include <gmock/gmock.h>

#include <numbers>

#include "mansard/extrude/detail/footprint.hpp"
#include "mansard/extrude/detail/source.hpp"
#include "mansard/extrude/extrude.hpp"
#include "mansard/solid/solid.hpp"
#include "plans.hpp"

namespace {

namespace geometry = mansard::geometry;
namespace extrude = mansard::extrude;
namespace solid = mansard::solid;
namespace model = mansard::model;

using namespace plans;
using model::FaceKind;

/// A hole of a gable's southern slope, in metres from its corner.
struct Dormer {
  double left = 0, right = 0, front = 0, back = 0;
};

/// 12 m along the eaves, 9 m deep; from a height of 5.03 m on a run of 4.7 m and a rise of 5.888 m, as a fit gives
/// them.
///
///     +------------------+
///     |      (ridge)     |
///     |   b        b     |     b: the slope goes on from here
///     |  +-+      +-+    |
///     |  +-+      +-+    |
///     +------------------+
constexpr double gutter = 5.0301, run = 4.7, rise = 5.8884320615;
auto gable(const std::vector<Dormer>& dormers, Profile roof = {{0, 0}, {0, gutter}, {run, gutter + rise}}) -> Plan {
  const auto upright = Profile{{0, 0}, {0, 30}};
  Plan p = plan(box(12, 9), {roof, upright}, {0, 1, 0, 1}, 40);
  for (const auto& d : dormers) {
    // The rest of the profile, from the height that it has at the back.
    Profile rest{{0, 0}};
    std::size_t part = 1;
    while (part + 2 < roof.size() && roof[part + 1].inward <= d.back) ++part;
    const double slope = (roof[part + 1].height - roof[part].height) / (roof[part + 1].inward - roof[part].inward);
    const double height = roof[part].height + slope * (d.back - roof[part].inward);
    rest.push_back({0, height});
    for (std::size_t i = part + 1; i < roof.size(); ++i) rest.push_back({roof[i].inward - d.back, roof[i].height});
    const auto back = static_cast<std::uint32_t>(p.profiles.size());
    p.profiles.push_back(rest);
    p.holes.push_back({{{d.left, d.front}, {d.left, d.back}, {d.right, d.back}, {d.right, d.front}}, {1, back, 1, 1}});
  }
  return p;
}

auto slopes_of(const model::Solid& made) -> std::vector<model::Face> {
  std::vector<model::Face> out;
  for (const auto& face : made.faces)
    if (face.kind == FaceKind::side && face.normal.z > 0.01) out.push_back(face);
  return out;
}

auto full(const Plan& p, double grid = 1e-4) -> model::Solid {
  extrude::Options options;
  options.grid = grid;
  auto raised = extrude::raise(p, options);
  EXPECT_TRUE(raised) << text(p);
  if (!raised) return {};
  EXPECT_EQ(raised->outcome, extrude::Outcome::full);
  EXPECT_EQ(solid::check(raised->solid).size(), 0U) << text(p);
  EXPECT_THAT(raised->warnings, testing::IsEmpty());
  return std::move(raised->solid);
}

TEST(Continued, slopes_with_holes_are_one_face_each) {
  const auto made = full(gable({{1, 2.63, 0.8, 2.04}, {6.1, 7.7, 0.7, 2.31}}));
  const auto slopes = slopes_of(made);
  ASSERT_EQ(slopes.size(), 2U);
  EXPECT_EQ(slopes[0].loops.size() + slopes[1].loops.size(), 4U);  // each hole is one of its face
  EXPECT_EQ(made.faces.size(), 4U + 2 + 1 + 2 * 4);                // and has four walls
  for (const auto& face : made.faces) EXPECT_NE(face.kind, FaceKind::connector);
}

TEST(Continued, at_any_angle_and_place_and_with_many_holes) {
  const auto p = gable({{0.7, 1.9, 0.5, 1.7},
                        {2.6, 4.1, 0.5, 1.71},
                        {5, 6.3, 0.6, 2.2},
                        {5, 6.3, 2.6, 3.9},
                        {8.123, 9.877, 0.31, 2.7189}});
  for (int k = 0; k < 60; ++k) {
    const auto turned_plan = shifted(turned(p, 0.1 + k * std::numbers::pi / 31), {13.37 * k, -7.77 * k});
    EXPECT_EQ(slopes_of(full(turned_plan)).size(), 2U) << k;
    EXPECT_EQ(slopes_of(full(mirrored(turned_plan))).size(), 2U) << k;
  }
}

TEST(Continued, the_parts_of_a_profile_above_are_the_hosts) {
  // The hole begins on the lower pitch and ends on it or on the upper one.
  const Profile two{{0, 0}, {0, gutter}, {2, gutter + 2.5}, {4.5, gutter + 3.6}};
  for (const double back : {1.6, 2.9}) {
    const auto made = full(turned(gable({{3.01, 4.5, 0.62, back}}, two), 0.3));
    EXPECT_EQ(slopes_of(made).size(), 4U) << back;
  }
}

TEST(Continued, the_slope_of_a_courtyard_goes_on_as_well) {
  // A courtyard of 6 m × 5 m in a house of 20 m × 19 m, and a hole of the slope that rises from it to the south.
  const Profile roof{{0, 0}, {0, gutter}, {run, gutter + rise}};
  for (const double angle : {0.0, 0.77}) {
    Plan p = plan(box(20, 19), {roof, {{0, 0}, {0, 30}}}, {}, 40);
    p.holes.push_back({{{7, 7}, {7, 12}, {13, 12}, {13, 7}}, {0, 0, 0, 0}});
    EXPECT_EQ(slopes_of(full(turned(p, angle))).size(), 8U);
    const double height = gutter + rise / run * 1.9;
    p.profiles.push_back({{0, 0}, {0, height}, {run, height + rise}});
    p.holes.push_back({{{9, 5.1}, {9, 6.3}, {10.37, 6.3}, {10.37, 5.1}}, {1, 1, 1, 2}});
    EXPECT_EQ(slopes_of(full(turned(p, angle))).size(), 8U);
  }
}

TEST(Continued, a_back_edge_that_is_turned_by_a_rounding_is_turned_back) {
  auto p = gable({{1, 2.63, 0.8, 2.04}});
  p.holes[0].points[1].y += 4e-4;  // on a direction of its own
  p.holes[0].points[2].y -= 4e-4;
  EXPECT_EQ(slopes_of(full(turned(p, 0.4))).size(), 2U);
}

TEST(Continued, the_face_is_named_after_the_outline) {
  for (const auto& face : slopes_of(full(gable({{1, 2.63, 0.8, 2.04}})))) {
    ASSERT_TRUE(face.provenance);
    EXPECT_EQ(face.provenance->ring, 0U);
    EXPECT_EQ(face.provenance->part, 1U);
  }
}

TEST(Continued, volume_is_that_of_the_gable_less_that_over_the_holes) {
  const Dormer d{1, 2.63, 0.8, 2.04};
  const double pitch = rise / run, middle = gutter + pitch * (d.front + d.back) / 2;
  const double without = solid::volume(full(gable({}), 0)), with = solid::volume(full(gable({d}), 0));
  EXPECT_NEAR(without - with, (d.right - d.left) * (d.back - d.front) * middle, 1e-3);
}

TEST(Continued, a_roof_behind_a_hole_that_is_another_stays_another) {
  // 1 cm above the slope, or steeper by a twentieth: what was asked for.
  auto higher = gable({{1, 2.63, 0.8, 2.04}});
  for (std::size_t i = 1; i < higher.profiles.back().size(); ++i) higher.profiles.back()[i].height += 0.01;
  EXPECT_GT(slopes_of(full(higher)).size(), 2U);
  auto steeper = gable({{1, 2.63, 0.8, 2.04}});
  steeper.profiles.back().back().height += 0.05 * rise;
  EXPECT_GT(slopes_of(full(steeper)).size(), 2U);
}

TEST(Continued, footprints_without_such_holes_stay_as_they_are) {
  for (const Plan& p : {gable({}), plan(box(10, 10), {hip}, {}, 20, {turned_in({{4, 4}, {6, 4}, {6, 6}, {4, 6}})})}) {
    std::string why;
    const auto footprint = extrude::detail::canonical(*extrude::detail::prepared(p), {}, why);
    ASSERT_TRUE(footprint);
    EXPECT_FALSE(extrude::detail::continued(*footprint));
  }
}

}  // namespace
