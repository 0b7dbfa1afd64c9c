// `mansard extrude FOOTPRINTS -o OUT`: buildings from outlines and attributes.
#include <cstdio>

#include "apps/cli/exit.hpp"
#include "apps/cli/extrude.hpp"
#include "apps/cli/progress.hpp"
#include "mansard/formats/input_name.hpp"

namespace mansard::cli {
namespace {

auto summarise(const Made& made, std::size_t tasks, const ExtrudeRequest& request, Progress& progress)
    -> base::Result<void> {
  const auto& n = made.outcomes;
  std::size_t remarks = 0;
  std::vector<std::string> reasons;
  const bool all = request.verbose || n.all() <= 20;
  auto counted = made.each([&](const auto&, const report::BuildingReport& building) -> base::Result<void> {
    if (building.outcome == report::Outcome::full && !building.reasons.empty()) ++remarks;
    if (all)
      for (const auto& reason : building.reasons) reasons.push_back(base::to_string(reason));
    return {};
  });
  if (!counted) return counted;
  if (const auto reuse = in_words(made.summary.reuse, tasks, "tasks"); !reuse.empty()) progress.say(reuse);
  progress.say(in_words(n, remarks));
  for (const auto& reason : reasons) progress.say(reason);
  return {};
}

}  // namespace

auto extrude_footprints(const ExtrudeRequest& request, const base::Cancel& cancel) -> int {
  pipeline::Options options;
  if (auto applied = request.settings.apply(options); !applied) return give_up(applied.errors());
  if (auto ready = check_outputs(request); !ready) return give_up(ready.errors());

  const auto folder = open_run(request);
  if (!folder) return give_up(folder.errors());
  RunFolder* const kept = folder->get();
  Progress progress(request.quiet);
  base::Run run;
  run.cancel = &cancel;
  run.seed = static_cast<std::uint64_t>(options.seed);
  run.progress = [&](auto stage, auto subject, double fraction) {
    if (kept != nullptr) kept->note(stage, fraction);
    progress.show(stage, subject, fraction);
  };

  progress.show("ingest", request.input, 0);
  auto scene = ingest::read_footprints(request.input, options.ingest, run);
  if (!scene) return give_up(scene.errors());
  for (const auto& warning : scene->warnings) progress.say(base::to_string(warning));
  if (auto joined = request.join.apply(*scene, options.ingest, progress); !joined) return give_up(joined.errors());

  pipeline::Schedule schedule;
  if (kept != nullptr) schedule = {request.no_resume ? nullptr : kept->kept(), &kept->tally()};
  const auto stopped = [&](const auto& failed) {
    const auto code = give_up(failed.errors());
    if (kept != nullptr && !request.no_resume)
      if (const auto words = kept->kept_in_words(); !words.empty()) progress.say(words);
    return code;
  };
  const auto city = pipeline::raise_footprints_aside(*scene, options, run, schedule);
  if (!city) return stopped(city);
  const auto made = made_of(*city);
  for (const auto& warning : made.summary.warnings) progress.say(base::to_string(warning));
  run.report("write", formats::name_to_show(request.out), 1);
  const auto missing = write_out(made, *scene, options, request, run, progress);
  if (!missing) return stopped(missing);
  if (missing->empty() && kept != nullptr) city->tasks > 0 ? kept->finished() : kept->finished_without_kept();
  if (auto done = summarise(made, city->tasks, request, progress); !done) return stopped(done);
  if (!missing->empty())
    if (const auto targets = targets_of(request)) return give_up(reasons_of(*missing, *targets));
  std::printf("%s\n", formats::name_to_show(request.out).c_str());
  return made.outcomes.full == made.outcomes.all() ? all_done : some_fell_back;
}

}  // namespace mansard::cli
