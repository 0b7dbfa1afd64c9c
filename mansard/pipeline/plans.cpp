// Plans raised without a scan.
#include <utility>

#include "mansard/pipeline/detail/assemble.hpp"
#include "mansard/pipeline/pipeline.hpp"

namespace mansard::pipeline {

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
  if (run.cancelled()) return base::error("cancelled", "stopped on request; nothing was written");

  RaisedPlans out;
  std::vector<model::Solid> solids;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto& id = part_at(places[i]).id;
    auto& result = *raised[i];
    if (!result) {
      auto why = result.error();
      why.subject = id;
      return why;
    }
    if (result->outcome != extrude::Outcome::full) {
      auto& less = out.fell_short.emplace_back();
      less = {places[i].building, places[i].part, result->outcome, std::move(result->warnings)};
      for (auto& reason : less.reasons) reason.subject = id;
    }
    solids.push_back(std::move(result->solid));
  }
  auto labelled = label::classify(std::move(solids), options.label, run);
  for (std::size_t i = 0; i < places.size(); ++i) part_at(places[i]).model = std::move(labelled[i]);
  out.city = std::move(city);
  out.city.made_by.version = detail::version();
  return out;
}

}  // namespace mansard::pipeline
