// `mansard extrude FOOTPRINTS -o OUT`: buildings from outlines and attributes.
#include <algorithm>
#include <cstdio>

#include "apps/cli/exit.hpp"
#include "apps/cli/extrude.hpp"
#include "apps/cli/progress.hpp"

namespace mansard::cli {
namespace {

auto count(const report::Reconstruction& r, report::Outcome outcome) -> std::size_t {
  return static_cast<std::size_t>(std::ranges::count(r.buildings, outcome, &report::BuildingReport::outcome));
}

void summarise(const report::Reconstruction& r, const ExtrudeRequest& request, Progress& progress) {
  const auto remarks = std::ranges::count_if(
      r.buildings, [](const auto& b) { return b.outcome == report::Outcome::full && !b.reasons.empty(); });
  progress.say(std::to_string(count(r, report::Outcome::full)) + " of " + std::to_string(r.buildings.size()) +
               " buildings in full (" + std::to_string(remarks) + " of them with remarks), " +
               std::to_string(count(r, report::Outcome::fallback)) + " fell back, " +
               std::to_string(count(r, report::Outcome::refused)) + " refused");
  for (const auto& building : r.buildings)
    if (request.verbose || r.buildings.size() <= 20)
      for (const auto& reason : building.reasons) progress.say(base::to_string(reason));
}

}  // namespace

auto extrude_footprints(const ExtrudeRequest& request, const base::Cancel& cancel) -> int {
  pipeline::Options options;
  if (auto applied = request.settings.apply(options); !applied) return give_up(applied.errors());
  if (auto ready = check_outputs(request); !ready) return give_up(ready.errors());

  Progress progress(request.quiet);
  base::Run run;
  run.cancel = &cancel;
  run.seed = static_cast<std::uint64_t>(options.seed);
  run.progress = [&](auto stage, auto subject, double fraction) { progress.show(stage, subject, fraction); };

  progress.show("ingest", request.input, 0);
  const auto scene = ingest::read_footprints(request.input, options.ingest, run);
  if (!scene) return give_up(scene.errors());
  for (const auto& warning : scene->warnings) progress.say(base::to_string(warning));

  const auto result = pipeline::raise_footprints(*scene, options, run);
  if (!result) return give_up(result.errors());
  for (const auto& warning : result->warnings) progress.say(base::to_string(warning));
  progress.show("write", request.out, 1);
  const auto report = report::run_json(*result, *scene);
  if (auto written = write_out(result->city, report, options, request, run); !written) return give_up(written.errors());
  summarise(*result, request, progress);
  std::printf("%s\n", request.out.c_str());
  return count(*result, report::Outcome::full) == result->buildings.size() ? all_done : some_fell_back;
}

}  // namespace mansard::cli
