// `mansard reconstruct MESH… FOOTPRINTS -o OUTDIR`.
#include <algorithm>
#include <cstdio>
#include <memory>

#include "apps/cli/catalogue.hpp"
#include "apps/cli/exit.hpp"
#include "apps/cli/formats.hpp"
#include "apps/cli/output.hpp"
#include "apps/cli/scan.hpp"
#include "apps/cli/verbs.hpp"
#include "mansard/base/files.hpp"
#include "mansard/base/text.hpp"
#include "mansard/report/layers.hpp"
#include "mansard/report/pictures.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;

struct Request {
  ScanRequest scan;
  std::string out;
  std::string formats = "default";
  bool picture = false, layers = false;
  double error_limit = 2.0;
};

auto count(const report::Reconstruction& r, report::Outcome outcome) -> std::size_t {
  std::size_t n = 0;
  for (const auto& building : r.buildings) n += building.outcome == outcome ? 1 : 0;
  return n;
}

void summarise(const report::Reconstruction& r, const Request& request, Progress& progress) {
  const auto full = count(r, report::Outcome::full);
  progress.say(std::to_string(full) + " of " + std::to_string(r.buildings.size()) + " buildings in full, " +
               std::to_string(count(r, report::Outcome::fallback)) + " fell back, " +
               std::to_string(count(r, report::Outcome::covered)) + " covered by neighbours, " +
               std::to_string(count(r, report::Outcome::refused)) + " refused");
  progress.say("mean squared vertical error " + base::to_text(r.scores.mse, 3) + " m² over the blocks, " +
               base::to_text(r.scores.footprint_mse, 3) + " m² over the footprints");
  for (const auto& building : r.buildings)
    if (building.outcome != report::Outcome::full && (request.scan.verbose || r.buildings.size() <= 20))
      for (const auto& reason : building.reasons) progress.say(base::to_string(reason));
}

/// What `--formats` and `--layers` ask for.
auto targets_of(const Request& request) -> base::Result<std::vector<Target>> {
  auto formats = formats_in(request.formats + (request.layers ? ",geopackage" : ""));
  if (!formats) return formats.failure();
  return targets_in(request.out, *formats);
}

auto write_pictures(const Request& request, const report::Reconstruction& result, const model::Scene& scene,
                    const base::Run& run, base::Outputs& outputs) -> base::Result<void> {
  const auto pictures = report::pictures(result, scene, request.error_limit, run);
  for (const auto& [name, image] : {std::pair{"picture.png", &pictures.angle}, std::pair{"above.png", &pictures.above},
                                    std::pair{"error.png", &pictures.error}}) {
    const auto bytes = picture::png(*image);
    if (!bytes) return bytes.failure();
    if (auto written = write_bytes(fs::path(request.out) / name, *bytes, outputs); !written) return written;
  }
  return {};
}

/// Every name that a run of any formats may leave in its folder; others are the user's own.
auto is_result(const std::string& name) -> bool {
  const auto& own = all_results();
  return std::ranges::find(own, name) != own.end();
}

auto write_all(const Request& request, const std::vector<Target>& targets, const pipeline::Options& options,
               const report::Reconstruction& result, const model::Scene& scene, const base::Run& run,
               Progress& progress) -> base::Result<void> {
  base::Outputs outputs;
  std::vector<formats::Layer> layers;
  if (request.layers) {
    layers = report::segment_layers(scene, result.segmented, result.city.made_by, result.city.buildings);
    layers.push_back(report::diagnostics_layer(result, scene));
  }
  progress.show("write", "", 1);
  const auto warnings = write_models(result.city, targets, options.write, outputs, layers);
  if (!warnings) return warnings.failure();
  for (const auto& warning : *warnings) progress.say(base::to_string(warning));
  const std::string report = report::run_json(result, scene);
  const auto report_path = fs::path(request.out) / "run.json";
  if (auto written = write_bytes(report_path, report, outputs); !written) return written;
  if (!request.scan.report.empty())
    if (auto written = write_bytes(request.scan.report, report, outputs); !written) return written;
  if (request.picture) {
    progress.show("picture", "", 1);
    if (auto written = write_pictures(request, result, scene, run, outputs); !written) return written;
  }
  const auto left = leftovers(request.out, "run.json", is_result);
  if (auto written = outputs.commit(run.cancel); !written) return written;
  std::vector<fs::path> made{report_path};
  for (const auto& target : targets)
    for (const auto& place : places_of(target)) made.push_back(place);
  if (request.picture)
    for (const auto* name : picture_names) made.push_back(fs::path(request.out) / name);
  remove_stale(left, made);
  return {};
}

/// Everything that can be wrong with the outputs, before any work.
auto check_outputs(const Request& request, const std::vector<Target>& targets) -> base::Result<void> {
  std::vector<fs::path> results;
  for (const auto& name : all_results()) results.push_back(fs::path(request.out) / name);
  if (auto spared = spare_inputs(results, {request.scan.inputs.begin(), request.scan.inputs.end()}); !spared)
    return spared;
  if (!request.scan.report.empty())
    if (auto apart = spare_results(request.scan.report, results); !apart) return apart;
  if (auto ready = prepare(request.out, request.scan.overwrite); !ready) return ready;
  if (auto usable = files_free(request.scan, {}); !usable) return usable;
  for (const auto& target : targets)
    if (auto usable = target_free(target, request.scan.overwrite); !usable) return usable;
  return {};
}

auto reconstruct(const Request& request, const base::Cancel& cancel) -> int {
  const auto options = options_of(request.scan);
  if (!options) return give_up(options.errors());
  const auto targets = targets_of(request);
  if (!targets) return give_up(targets.errors());
  if (auto ready = check_outputs(request, *targets); !ready) return give_up(ready.errors());
  Progress progress(request.scan.quiet);
  const auto run = start(request.scan, options->seed, cancel, progress);
  const auto scene = read_scan(request.scan, *options, run, progress);
  if (!scene) return give_up(scene.errors());

  const auto keep = request.layers ? pipeline::Keep::segmentations : pipeline::Keep::models;
  const auto result = pipeline::reconstruct(*scene, *options, run, keep);
  if (!result) return give_up(result.errors());
  if (auto written = write_all(request, *targets, *options, *result, *scene, run, progress); !written)
    return give_up(written.errors());
  summarise(*result, request, progress);

  std::printf("%s\n", targets->front().path.c_str());
  if (request.picture) std::printf("%s\n", (fs::path(request.out) / "picture.png").c_str());
  if (request.layers) std::printf("%s\n", (fs::path(request.out) / "model.gpkg").c_str());
  return count(*result, report::Outcome::full) == result->buildings.size() ? all_done : some_fell_back;
}

}  // namespace

auto reconstruct_verb(CLI::App& app, const base::Cancel& cancel) -> Verb {
  auto* verb = add_verb(app, "reconstruct");
  auto request = std::make_shared<Request>();
  add_to(*verb, request->scan);
  verb->add_option("-o,--output", request->out, "Output folder")->required()->type_name("OUTDIR");
  verb->add_flag("--picture", request->picture,
                 "Also write pictures of scan and models (picture.png, above.png, error.png)");
  verb->add_flag("--layers", request->layers,
                 "Also write the layers of 'mansard segment' and all diagnostics to model.gpkg");
  verb->add_option("--formats", request->formats, formats_help)->type_name("FORMATS")->default_str(default_formats);
  verb->add_option("--error-limit", request->error_limit, "Both limits of the colour scale of the error map, in metres")
      ->check(CLI::Range(0.01, 1000.0));
  return {verb, [request, &cancel] { return reconstruct(*request, cancel); }};
}

}  // namespace mansard::cli
