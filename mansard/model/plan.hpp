// Plan and profiles: the editable source of truth of one building part.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mansard/geometry/polygon.hpp"

namespace mansard::model {

/// A point of a profile, relative to the foot of its edge, in metres.
struct ProfilePoint {
  double inward = 0;  ///< horizontal run towards the interior
  double height = 0;  ///< above the base of the plan
  friend auto operator==(const ProfilePoint&, const ProfilePoint&) -> bool = default;
};

/// A polyline from (0, 0), both coordinates never decreasing, no repeated points, at least two points. A vertical part
/// is wall, a sloped one roof, a horizontal one a terrace. The last part goes on upwards until roofs meet or the cap;
/// a last part that is horizontal goes on vertically.
using Profile = std::vector<ProfilePoint>;

/// One ring of a plan: edge i goes from points[i] to points[i + 1] and rises along profiles[profile_of_edge[i]].
struct PlanRing {
  geometry::Ring points;
  std::vector<std::uint32_t> profile_of_edge;
  /// Per edge, m: how far the eaves above its wall overhang, if a roof rises from the top of a vertical wall there.
  /// Empty: nothing overhangs. extrude::raise() makes none of them; solid::with_eaves() does, on the solid of all
  /// parts.
  std::vector<double> overhang_of_edge{};
  friend auto operator==(const PlanRing&, const PlanRing&) -> bool = default;
};

struct Plan {
  PlanRing outer;               ///< counter-clockwise
  std::vector<PlanRing> holes;  ///< clockwise
  std::vector<Profile> profiles;
  double base = 0;  ///< z of the ground floor, metres, local frame
  double cap = 0;   ///< height above base at which the extrusion is cut off flat, metres, > 0
  friend auto operator==(const Plan&, const Plan&) -> bool = default;
};

/// The plan's rings as a polygon.
[[nodiscard]] inline auto polygon_of(const Plan& plan) -> geometry::Polygon {
  geometry::Polygon polygon{plan.outer.points, {}};
  for (const auto& hole : plan.holes) polygon.holes.push_back(hole.points);
  return polygon;
}

}  // namespace mansard::model
