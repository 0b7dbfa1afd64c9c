// Plans raised without a scan.
#include <algorithm>
#include <iterator>
#include <utility>

#include "mansard/base/stopped.hpp"
#include "mansard/pipeline/detail/assemble.hpp"
#include "mansard/pipeline/detail/overlaps.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/pipeline/solids.hpp"

namespace mansard::pipeline {

void detail::drop_lost(RaisedPlans& raised, std::size_t building, SolidsOf& made) {
  auto& parts = raised.city.buildings[building].parts;
  for (const std::size_t p : made.lost)
    raised.refused.push_back(base::error("solid-left-out", "no valid solid can be made of it", parts[p].id));
  std::erase_if(raised.fell_short, [&](RaisedPlans::Short& one) {
    if (one.building != building) return false;
    const auto first = std::ranges::lower_bound(made.lost, one.part);
    const bool is_lost = first != made.lost.end() && *first == one.part;
    one.part -= static_cast<std::size_t>(first - made.lost.begin());
    return is_lost;
  });
  pipeline::drop_lost(raised.city.buildings[building], made);
}

auto raise_plans(model::City city, const Options& options, const base::Run& run) -> base::Result<RaisedPlans> {
  struct Place {
    std::size_t building = 0, part = 0;
  };
  std::vector<Place> places;
  for (std::size_t b = 0; b < city.buildings.size(); ++b)
    for (std::size_t p = 0; p < city.buildings[b].parts.size(); ++p) places.push_back({b, p});
  const auto part_at = [&](const Place& at) -> model::Part& { return city.buildings[at.building].parts[at.part]; };

  std::vector<std::optional<base::Result<extrude::Raised>>> raised(places.size());
  base::Run inner = run;
  inner.progress = nullptr;
  base::parallel_for(places.size(), [&](std::size_t i) {
    if (!run.cancelled()) raised[i] = raise_part(part_at(places[i]).plan, options, inner);
  });
  // A raise that is cut short by cancelling would be a prism.
  if (run.cancelled()) return base::stopped();

  RaisedPlans out;
  std::vector<model::Solid> solids;
  std::vector<std::vector<model::Part>> kept(city.buildings.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    model::Part& part = part_at(places[i]);
    auto& made = raised[i];
    if (!made) continue;  // each was made
    auto& result = *made;
    if (!result) {
      for (const auto& why : result.errors()) out.refused.push_back({why.severity, why.code, why.message, part.id});
      continue;
    }
    for (auto& warning : result->warnings) warning.subject = part.id;
    auto& parts = kept[places[i].building];
    if (result->outcome != extrude::Outcome::full)
      out.fell_short.push_back({places[i].building, parts.size(), result->outcome, std::move(result->warnings)});
    else
      std::ranges::copy_if(result->warnings, std::back_inserter(out.remarks),
                           [](const auto& warning) { return warning.code == "extrude-small-edge"; });
    solids.push_back(std::move(result->solid));
    parts.push_back(std::move(part));
  }
  if (solids.empty() && !out.refused.empty()) return base::Failure{std::move(out.refused)};
  auto labelled = label::classify(std::move(solids), options.label, run);
  auto next = labelled.begin();
  for (std::size_t b = 0; b < kept.size(); ++b) {
    for (auto& part : kept[b]) part.model = std::move(*next++);
    city.buildings[b].parts = std::move(kept[b]);
  }
  out.city = std::move(city);
  out.city.made_by.version = detail::version();
  auto united = unite_parts(out.city.buildings);
  for (std::size_t b = 0; b < united.size(); ++b) {
    auto& building = out.city.buildings[b];
    detail::drop_lost(out, b, united[b]);
    building.solids = std::move(united[b].solids);
    for (auto& warning : united[b].warnings) {
      warning.subject = building.id;
      out.remarks.push_back(std::move(warning));
    }
  }
  if (std::ranges::all_of(out.city.buildings, [](const auto& one) { return one.parts.empty(); }) &&
      !out.refused.empty())
    return base::Failure{std::move(out.refused)};
  auto overlaps = detail::overlaps(out.city.buildings, run);
  std::ranges::move(overlaps.in_all, std::back_inserter(out.remarks));
  if (run.cancelled()) return base::stopped();
  return out;
}

}  // namespace mansard::pipeline
