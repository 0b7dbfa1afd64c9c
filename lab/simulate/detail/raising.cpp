#include "lab/simulate/detail/raising.hpp"

#include "mansard/extrude/extrude.hpp"

#include <algorithm>
#include <limits>

#include "lab/simulate/detail/party.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::simulate::detail {
namespace {

using geometry::Polygon;

constexpr double file_grid = 1e-4;  // m; what CityJSON keeps

auto raise_lot(const Lot& lot, double ground, const std::string& id, const base::Run& run)
    -> base::Result<std::pair<model::Plan, model::Solid>> {
  auto plan = plan_of(lot, ground);
  if (!plan) return base::error("simulate-solid", "no roof can be raised here: " + plan.error().message, id);
  extrude::Options options;
  options.grid = file_grid;
  options.overhang = lot.overhang;
  auto raised = extrude::raise(*plan, options, run);
  // A soffit that runs into another one is a prism in files: the scan would show a roof that the truth has not.
  if (lot.overhang > 0 && raised && !solid::check(raised->solid, solid::written_rules()).empty()) {
    options.overhang = 0;
    raised = extrude::raise(*plan, options, run);
  }
  if (!raised) return base::error("simulate-solid", "nothing can be raised here: " + raised.error().message, id);
  if (raised->outcome != extrude::Outcome::full)
    return base::error("simulate-solid", "not raised in full: " + raised->warnings.front().message, id);
  return std::pair(std::move(*plan), std::move(raised->solid));
}

}  // namespace

auto outline_of(const std::vector<Polygon>& parts) -> base::Result<std::vector<Polygon>> {
  constexpr double seam = 0.01;
  if (parts.size() < 2) return parts;
  std::vector<Polygon> grown, outline;
  for (const Polygon& part : parts) {
    auto more = geometry::buffer(part, seam);
    if (!more) return more.error();
    grown.insert(grown.end(), more->begin(), more->end());
  }
  const auto whole = geometry::unite(grown);
  if (!whole) return whole.error();
  for (const Polygon& polygon : *whole) {
    auto less = geometry::buffer(polygon, -seam);
    if (!less) return less.error();
    outline.insert(outline.end(), less->begin(), less->end());
  }
  return outline;
}

auto raise_house(const House& house, const base::Run& run) -> base::Result<Raised> {
  Raised out;
  out.building.id = house.id;
  out.building.ground = house.ground;
  std::vector<Polygon> standing;
  for (const Lot& lot : house.lots)
    if (lot.base == 0) standing.push_back(lot.polygon);
  auto outline = outline_of(standing);
  if (!outline) return outline.error();
  out.building.footprint = std::move(*outline);
  out.building.attributes = {{"sim_roof", house.roof}, {"sim_storeys", std::int64_t{house.storeys}}};
  for (const Lot& given : house.lots) {
    const auto lots = with_parapet(given);
    if (!lots) return lots.failure();
    for (const Lot& lot : *lots) {
      model::Part part;
      part.id = house.id + "-" + std::to_string(out.building.parts.size() + 1);
      part.attributes = {{"ms_role", lot.role}, {"ms_eaves", house.ground + lot.eaves}};
      auto raised = raise_lot(lot, house.ground, part.id, run);
      if (!raised) return raised.error();
      part.plan = std::move(raised->first);
      out.solids.push_back(std::move(raised->second));
      out.building.parts.push_back(std::move(part));
    }
  }
  return out;
}

/// A building of plans as they are, with the outline of those that stand on the ground where it has none.
auto raise_again(model::Building building, const base::Run& run) -> base::Result<Raised> {
  Raised out;
  std::vector<Polygon> standing;
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& part : building.parts) lowest = std::min(lowest, part.plan.base);
  for (const auto& part : building.parts) {
    extrude::Options options;
    options.grid = file_grid;
    auto raised = extrude::raise(part.plan, options, run);
    if (!raised) {
      auto why = raised.error();
      why.subject = part.id;
      return why;
    }
    out.solids.push_back(std::move(raised->solid));
    constexpr double storey = 2.5;  // m; what begins higher stands on another part
    if (part.plan.base < lowest + storey) standing.push_back(model::polygon_of(part.plan));
  }
  if (building.footprint.empty()) {
    auto outline = outline_of(standing);
    if (!outline) return outline.error();
    building.footprint = std::move(*outline);
  }
  out.building = std::move(building);
  return out;
}

auto truth_over(std::vector<Raised> buildings, const base::Run& run) -> Truth {
  Truth truth;
  std::vector<model::Solid> solids;
  for (auto& raised : buildings) {
    std::ranges::move(raised.solids, std::back_inserter(solids));
    truth.city.buildings.push_back(std::move(raised.building));
  }
  // All at once: party walls are between buildings.
  auto models = label::classify(std::move(solids), {}, run);
  std::size_t next = 0;
  for (auto& building : truth.city.buildings)
    for (auto& part : building.parts) part.model = std::move(models[next++]);
  std::vector<Standing> standing;
  for (const auto& building : truth.city.buildings) standing.push_back(standing_of(building));
  truth.party_walls = party_walls_of(standing, solids_touch);
  return truth;
}

}  // namespace mansard::simulate::detail
