// Roofs over sides that are not parallel to their ridge: one plane, from an edge at a corner.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mansard/extrude/corner_edges.hpp"
#include "mansard/refine/law.hpp"
#include "scans.hpp"

namespace {

namespace extrude = mansard::extrude;
namespace geometry = mansard::geometry;
namespace model = mansard::model;

using namespace scans;
using geometry::Point2;

/// A house: its outline, what its sides carry, and the corner from which its other plane rises.
struct House {
  geometry::Ring outline;
  std::vector<Profile> profiles;
  std::size_t corner = 0;
  Point2 along;
};

auto turned(Point2 p, double by) -> Point2 {
  const double c = std::cos(by), s = std::sin(by);
  return {30 + c * p.x - s * p.y, 12 + s * p.x + c * p.y};
}
auto truth_of(House house, double by) -> Plan {
  for (Point2& p : house.outline) p = turned(p, by);
  Plan out = plan(house.outline, house.profiles, 40);
  auto ring = extrude::with_corner_edge(out.outer, house.corner, turned(house.along, by) - turned({}, by),
                                        static_cast<std::uint32_t>(out.profiles.size()));
  EXPECT_TRUE(ring);
  out.outer = *std::move(ring);
  out.profiles.push_back(roof(5, 0.9));
  return out;
}

auto refined(const geometry::Ring& outline, const Plan& truth, double noise) -> std::vector<refine::Part> {
  model::Accuracy accuracy;
  accuracy.noise = noise, accuracy.correlated_area = 0.5;
  const auto options = refine::decided_by({}, accuracy);
  auto out = refine::refine(std::vector{flat_draft(outline, 6)}, scan({truth}, noise), options, {});
  for (const auto& part : out.parts) EXPECT_TRUE(mansard::solid::check(part.raised.solid).empty());
  return std::move(out.parts);
}
auto corners_of(const std::vector<refine::Part>& parts) -> std::ptrdiff_t {
  std::ptrdiff_t count = 0;
  for (const auto& part : parts) count += std::ranges::count(extrude::corner_edges_of(part.plan.outer.points), true);
  return count;
}
auto roof_faces(const model::Solid& solid) -> std::ptrdiff_t {
  return std::ranges::count_if(solid.faces, [](const auto& face) { return face.normal.z > 0.05; });
}

const Profile pitch = roof(5, 0.9), gable = wall(5);
const std::vector<House> houses{
    // A gable over an oblique side, one over a bent side, and a hip at an oblique end.
    {{{0, 0}, {16, 0}, {16, 8}, {0, 9.6}}, {pitch, gable, gable, gable}, 3, {-1, 0}},
    {{{0, 0}, {16, 0}, {16, 8}, {8, 9.2}, {0, 8.4}}, {pitch, gable, gable, gable, gable}, 3, {-1, 0}},
    {{{0, 0}, {14, 0}, {15.6, 8}, {0, 8}}, {pitch, gable, pitch, pitch}, 2, {0, 1}},
};

TEST(Turned, sides_have_one_plane_that_is_theirs) {
  for (std::size_t k = 0; k < houses.size(); ++k)
    for (const double noise : {0.0, 0.04}) {
      SCOPED_TRACE("house " + std::to_string(k) + ", noise " + std::to_string(noise));
      const Plan truth = truth_of(houses[k], 0.4);
      geometry::Ring outline = houses[k].outline;
      for (Point2& p : outline) p = turned(p, 0.4);
      const auto parts = refined(outline, truth, noise);
      ASSERT_EQ(parts.size(), 1U);
      EXPECT_EQ(corners_of(parts), 1);
      const auto made = extrude::raise(truth);
      ASSERT_TRUE(made);
      EXPECT_EQ(roof_faces(parts[0].raised.solid), roof_faces(made->solid));
      EXPECT_LT(difference(parts, {truth}), noise == 0 ? 0.01 : 0.06);
    }
}

TEST(Turned, sides_across_their_roof_stay_what_they_are) {
  // A rectangle: what is left of its roof is noise, of which no direction is made.
  const geometry::Ring outline{turned({0, 0}, 0.4), turned({14, 0}, 0.4), turned({14, 8}, 0.4), turned({0, 8}, 0.4)};
  for (const double noise : {0.0, 0.03, 0.1, 0.2})
    for (const auto& profiles : {std::vector{pitch, gable, pitch, gable}, std::vector{pitch, pitch, pitch, pitch}}) {
      const auto parts = refined(outline, plan(outline, profiles, 40), noise);
      EXPECT_EQ(parts.size(), 1U) << noise;
      EXPECT_EQ(corners_of(parts), 0) << noise;
    }
}

}  // namespace
