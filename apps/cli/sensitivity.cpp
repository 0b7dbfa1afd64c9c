#include "apps/cli/sensitivity.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "apps/cli/exit.hpp"
#include "apps/cli/output.hpp"
#include "lab/explore/sensitivity.hpp"
#include "mansard/base/files.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;

/// Lines that are there as soon as they are written: a run that is stopped goes on from them.
auto open_runs(const fs::path& runs, const explore::SensitivityRequest& request) -> std::ofstream {
  std::ofstream file(runs, std::ios::trunc);
  file << explore::trials_head(request);
  for (const auto& trial : request.known) file << explore::trial_line(trial);
  file.flush();
  return file;
}

}  // namespace

auto explore_sensitivity(const ScanRequest& scan, const explore::Request& study,
                         const std::vector<std::string>& parameters, const fs::path& out, const base::Cancel& cancel)
    -> int {
  explore::SensitivityRequest request;
  auto axes = explore::parameters_of(parameters, study.options);
  if (!axes) return give_up(axes.error());
  const fs::path runs = out / "runs.csv";
  const bool goes_on = fs::exists(runs);
  if (auto ready = prepare(out, scan.overwrite || goes_on); !ready) return give_up(ready.error());
  request.datasets = study.datasets;
  request.parameters = std::move(*axes);
  request.options = study.options;
  request.command = study.command;
  request.version = study.version;
  if (goes_on)
    if (const auto text = base::read_file(runs)) request.known = explore::trials_from(*text, request);
  auto file = open_runs(runs, request);
  request.on_done = [&](const explore::Trial& trial) { file << explore::trial_line(trial) << std::flush; };
  Progress progress(scan.quiet);
  const auto run = start(scan, study.options.seed, cancel, progress);
  const auto result = explore::sensitivity(request, run);
  if (!result) return give_up(result.error());
  const auto named = explore::report(*result);
  if (auto written = base::write_files(in_folder(out, named), run.cancel); !written) return give_up(written.error());
  std::printf("%s\n", (out / "index.html").c_str());
  const bool all = std::ranges::all_of(result->effects, [](const auto& effect) {
    return std::ranges::all_of(effect.trials, [](const auto& trial) { return trial.failure.empty(); });
  });
  return all ? all_done : some_fell_back;
}

}  // namespace mansard::cli
