// Plans and cities made by hand, and random ones.
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "mansard/base/run.hpp"
#include "mansard/edit/edit.hpp"

namespace mansard::edit::test {

using geometry::Point2;
using geometry::Polygon;
using geometry::Ring;
using model::Plan;
using model::Profile;

/// A wall of 5 m with a pitch of 45° above it.
inline const Profile pitch{{0, 0}, {0, 5}, {3, 8}};
/// A wall all the way.
inline const Profile wall{{0, 0}, {0, 9}};

/// Every edge has a profile of its own, of these in turn.
inline auto plan_of(const Polygon& polygon, const std::vector<Profile>& profiles, double base = 0, double cap = 9)
    -> Plan {
  Plan plan;
  plan.base = base;
  plan.cap = cap;
  const auto ring_of = [&](const Ring& ring) {
    model::PlanRing out{ring, {}};
    for (std::size_t i = 0; i < ring.size(); ++i) {
      out.profile_of_edge.push_back(static_cast<std::uint32_t>(plan.profiles.size()));
      plan.profiles.push_back(profiles[i % profiles.size()]);
    }
    return out;
  };
  plan.outer = ring_of(polygon.outer);
  for (const auto& hole : polygon.holes) plan.holes.push_back(ring_of(hole));
  return plan;
}

inline auto rectangle(double x0, double y0, double x1, double y1) -> Polygon {
  return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}};
}

/// A house of 10 by 8 m, ridge along x: eaves south and north, gables east and west.
inline auto house(double x = 0, double y = 0) -> Plan { return plan_of(rectangle(x, y, x + 10, y + 8), {pitch, wall}); }

/// Around the origin, every corner in a direction of its own: simple, mostly concave.
inline auto star(base::Random& random, std::size_t corners) -> Polygon {
  Polygon polygon;
  for (std::size_t i = 0; i < corners; ++i) {
    const double turn = (static_cast<double>(i) + random.uniform(0.1, 0.9)) / static_cast<double>(corners);
    const double radius = random.uniform(4, 12), angle = 2 * std::numbers::pi * turn;
    polygon.outer.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return polygon;
}

inline auto area_of(const Plan& plan) -> double { return geometry::area(model::polygon_of(plan)); }

/// m²; of what is in one but not in both.
inline auto difference(const Polygon& a, const Polygon& b) -> double {
  double sum = 0;
  for (const auto& [p, q] : {std::pair(a, b), std::pair(b, a)}) {
    const auto pieces = geometry::subtract(p, q);
    if (!pieces) return 1e9;
    for (const auto& piece : *pieces) sum += geometry::area(piece);
  }
  return sum;
}

/// The profile of the plan's edge that the point lies on; null where it lies on none.
inline auto profile_at(const Plan& plan, Point2 at) -> const Profile* {
  std::vector<const model::PlanRing*> rings{&plan.outer};
  for (const auto& hole : plan.holes) rings.push_back(&hole);
  for (const auto* ring : rings)
    for (std::size_t i = 0; i < ring->points.size(); ++i)
      if (geometry::distance({ring->points[i], ring->points[(i + 1) % ring->points.size()]}, at) < 1e-9)
        return &plan.profiles[ring->profile_of_edge[i]];
  return nullptr;
}

/// Buildings "a", "b", … with these plans as their only parts "a-1", "b-1", ….
inline auto city_of(const std::vector<Plan>& plans) -> model::City {
  model::City city;
  for (const auto& plan : plans) {
    model::Building building;
    building.id = std::string(1, static_cast<char>('a' + city.buildings.size()));
    building.footprint = {model::polygon_of(plan)};
    building.ground = plan.base;
    building.parts.push_back({building.id + "-1", plan, {}, {}});
    city.buildings.push_back(std::move(building));
  }
  return city;
}

}  // namespace mansard::edit::test
