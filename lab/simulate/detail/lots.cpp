#include "lab/simulate/detail/lots.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mansard/extrude/extrude.hpp"
#include "mansard/geometry/angles.hpp"

namespace mansard::simulate::detail {
namespace {

using model::Plan;
using model::Profile;

constexpr double steep_rise = 2.5, steep_run = 0.91;  // m; the lower part of a mansard roof: a storey at 70°
constexpr double gutter_width = 0.3;                  // m
constexpr double long_run = 10;                       // m; the last part goes on by itself
constexpr double above_ridge = 0.01;                  // m; so that the cap cuts nothing

/// Wall and roof of an edge that does not stand upright. Heights count from the plan's base.
auto leaning(const Lot& lot) -> Profile {
  const double wall = lot.eaves - lot.base;
  Profile profile{{0, 0}, {0, wall}};
  if (lot.gutter) profile.push_back({gutter_width, wall});
  if (lot.roof == Roof::mansard)
    profile.push_back({profile.back().inward + steep_run, profile.back().height + steep_rise});
  profile.push_back(
      {profile.back().inward + long_run, profile.back().height + long_run * geometry::tangent(lot.pitch)});
  return profile;
}

}  // namespace

auto plan_of(const Lot& lot, double ground) -> base::Result<Plan> {
  const double wall = lot.eaves - lot.base;
  Plan plan;
  plan.base = ground + lot.base;
  plan.profiles = {Profile{{0, 0}, {0, wall}}};
  plan.outer = {lot.polygon.outer, std::vector<std::uint32_t>(lot.polygon.outer.size(), 0)};
  for (const auto& hole : lot.polygon.holes) plan.holes.push_back({hole, std::vector<std::uint32_t>(hole.size(), 0)});
  plan.cap = wall;
  if (lot.roof == Roof::flat) return plan;

  plan.profiles.push_back(leaning(lot));
  for (std::size_t i = 0; i < lot.polygon.outer.size(); ++i)
    plan.outer.profile_of_edge[i] = i < lot.upright.size() && lot.upright[i] ? 0 : 1;
  if (lot.roof != Roof::mono)
    for (auto& hole : plan.holes) std::ranges::fill(hole.profile_of_edge, 1);
  plan.cap = wall + most_rise;
  const auto crest = extrude::crest(plan);
  if (!crest) return crest.error();
  plan.cap = std::min(plan.cap, *crest + above_ridge);
  return plan;
}

auto with_parapet(const Lot& lot) -> base::Result<std::vector<Lot>> {
  constexpr double thick = 0.3, high = 0.7;
  std::vector<Lot> all{lot};
  if (!lot.parapet || lot.roof != Roof::flat) return all;
  const auto inside = geometry::buffer(lot.polygon, -thick);
  if (!inside) return inside.failure();
  if (inside->size() != 1) return all;
  const auto rings = geometry::subtract(lot.polygon, inside->front());
  if (!rings) return rings.failure();
  for (const auto& ring : *rings) {
    if (ring.holes.empty()) continue;
    Lot parapet;
    parapet.role = "parapet";
    parapet.polygon = ring;
    parapet.base = lot.eaves;
    parapet.eaves = lot.eaves + high;
    all.push_back(std::move(parapet));
  }
  return all;
}

}  // namespace mansard::simulate::detail
