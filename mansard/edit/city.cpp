// The city that is exported after edits.
#include <algorithm>
#include <map>
#include <utility>

#include "mansard/edit/edit.hpp"
#include "mansard/report/attributes.hpp"

namespace mansard::edit {
namespace {

using model::Attributes;

void set(Attributes& attributes, std::string_view name, model::Value value) {
  const auto found = std::ranges::find(attributes, name, &Attributes::value_type::first);
  if (found != attributes.end()) found->second = std::move(value);
  else attributes.emplace_back(name, std::move(value));
}

/// What a part that the run did not make may say of the run: its building's block.
auto attributes_of_new(const model::Building& building) -> Attributes {
  Attributes out;
  for (const auto& part : building.parts)
    for (const auto& attribute : part.attributes)
      if (attribute.first == "ms_block") return {attribute};
  return out;
}

auto plans_of(const model::Building& building) -> std::vector<NamedPlan> {
  std::vector<NamedPlan> out;
  for (const auto& part : building.parts) out.push_back({part.id, part.plan});
  return out;
}

/// The building with the plans that it has now, each with what is known of it from the run. `unchanged` gets a flag a
/// part.
auto with_plans(const model::Building& before, const std::vector<NamedPlan>& plans, std::vector<bool>& unchanged)
    -> model::Building {
  model::Building building{before.id, before.attributes, before.footprint, before.ground, {}, {}};
  for (const auto& [id, plan] : plans) {
    const auto same = std::ranges::find(before.parts, id, &model::Part::id);
    const bool known = same != before.parts.end();
    unchanged.push_back(known && same->plan == plan);
    building.parts.push_back({id, plan, {}, known ? same->attributes : attributes_of_new(before)});
  }
  return building;
}

}  // namespace

auto edited_city(const model::City& city, const History& history, const MeshOf& mesh_of,
                 const pipeline::Options& options, const base::Run& run) -> base::Result<model::City> {
  model::City plans{city.frame, city.made_by, {}};
  std::vector<std::vector<bool>> unchanged(city.buildings.size());
  for (std::size_t b = 0; b < city.buildings.size(); ++b) {
    const auto& building = city.buildings[b];
    const auto edited = history.edited(building.id) ? history.parts(building.id) : nullptr;
    plans.buildings.push_back(with_plans(building, edited ? *edited : plans_of(building), unchanged[b]));
  }
  auto raised = pipeline::raise_plans(std::move(plans), options, run);
  if (!raised) return raised.failure();
  if (!raised->refused.empty()) return base::Failure{std::move(raised->refused)};

  std::map<std::pair<std::size_t, std::size_t>, std::string> fallback;
  for (const auto& less : raised->fell_short)
    fallback[{less.building, less.part}] = less.reasons.empty() ? "unknown" : less.reasons.front().code;

  model::City out = std::move(raised->city);
  const auto z0 = static_cast<double>(out.frame.origin[2]);
  base::parallel_for(out.buildings.size(), [&](std::size_t b) {
    auto& building = out.buildings[b];
    for (std::size_t p = 0; p < building.parts.size(); ++p) {
      auto& part = building.parts[p];
      if (unchanged[b][p]) {
        const auto areas = label::areas(part.model);
        set(part.attributes, "ms_area_wall", report::rounded_measure(areas.wall));
        set(part.attributes, "ms_area_party_wall", report::rounded_measure(areas.party_wall));
        continue;
      }
      const auto why = fallback.find({b, p});
      part.attributes =
          report::part_attributes(part, why != fallback.end() ? why->second : std::string(),
                                  mesh_of ? mesh_of(building.id) : nullptr, z0, {options.roof_grid, options.evaluate});
      set(part.attributes, edited_mark, true);
    }
    if (!history.edited(building.id)) return;
    building.attributes = report::building_attributes(building, z0);
    set(building.attributes, edited_mark, true);
  });
  return out;
}

}  // namespace mansard::edit
