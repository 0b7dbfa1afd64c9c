// `mansard reconstruct MESH… FOOTPRINTS -o OUTDIR`.
#include <cstdio>
#include <memory>

#include "apps/cli/exit.hpp"
#include "apps/cli/output.hpp"
#include "apps/cli/scan.hpp"
#include "apps/cli/verbs.hpp"
#include "mansard/base/files.hpp"
#include "mansard/base/text.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;

struct Request {
  ScanRequest scan;
  std::string out;
  bool picture = false, layers = false;
  double error_limit = 2.0;
};

auto count(const pipeline::Reconstruction& r, pipeline::Outcome outcome) -> std::size_t {
  std::size_t n = 0;
  for (const auto& building : r.buildings) n += building.outcome == outcome ? 1 : 0;
  return n;
}

void summarise(const pipeline::Reconstruction& r, const Request& request, Progress& progress) {
  const auto full = count(r, pipeline::Outcome::full);
  progress.say(std::to_string(full) + " of " + std::to_string(r.buildings.size()) + " buildings in full, " +
               std::to_string(count(r, pipeline::Outcome::fallback)) + " fell back, " +
               std::to_string(count(r, pipeline::Outcome::covered)) + " covered by neighbours, " +
               std::to_string(count(r, pipeline::Outcome::refused)) + " refused");
  progress.say("vertical error " + base::to_text(r.scores.mse, 3) + " m² (paper's measure), " +
               base::to_text(r.scores.footprint_mse, 3) + " m² over the footprints");
  for (const auto& building : r.buildings)
    if (building.outcome != pipeline::Outcome::full && (request.scan.verbose || r.buildings.size() <= 20))
      for (const auto& reason : building.reasons) progress.say(base::to_string(reason));
}

auto write_all(const Request& request, const pipeline::Reconstruction& result, const ingest::Scene& scene,
               const base::Run& run, Progress& progress) -> base::Result<void> {
  auto files = model_files(result.city);
  if (!files) return files.error();
  const std::string report = pipeline::report_json(result, scene);
  files->emplace_back("run.json", report);
  if (request.picture) {
    progress.show("picture", "", 1);
    const auto pictures = pipeline::pictures(result, scene, request.error_limit, run);
    for (const auto& [name, image] : {std::pair{"picture.png", &pictures.angle}, std::pair{"above.png", &pictures.above},
                                      std::pair{"error.png", &pictures.error}}) {
      auto bytes = picture::png(*image);
      if (!bytes) return bytes.error();
      files->emplace_back(name, std::move(*bytes));
    }
  }
  if (request.layers) {
    auto layers = write::geopackage(pipeline::segment_layers(scene, result.segmented, result.city.made_by), scene.frame);
    if (!layers) return layers.error();
    files->emplace_back("segment.gpkg", std::move(*layers));
  }
  auto all = in_folder(request.out, *files);
  if (!request.scan.report.empty()) all.push_back({request.scan.report, report});
  const auto left = leftovers(request.out, "run.json", [](const auto& name) {
    return name == "picture.png" || name == "above.png" || name == "error.png";
  });
  if (auto written = base::write_files(all, run.cancel); !written) return written;
  remove_stale(left, all);
  return {};
}

/// Whatever may be wrong with the outputs, before any work.
auto check_outputs(const Request& request) -> base::Result<void> {
  std::vector<fs::path> results;
  for (const auto* name : result_names) results.push_back(fs::path(request.out) / name);
  if (auto spared = spare_inputs(results, {request.scan.inputs.begin(), request.scan.inputs.end()}); !spared)
    return spared;
  if (auto usable = files_free(request.scan, {}); !usable) return usable;
  return prepare(request.out, request.scan.overwrite);
}

auto reconstruct(const Request& request, const base::Cancel& cancel) -> int {
  const auto options = options_of(request.scan);
  if (!options) return give_up(options.error());
  if (auto ready = check_outputs(request); !ready) return give_up(ready.error());
  Progress progress(request.scan.quiet);
  const auto run = start(request.scan, options->seed, cancel, progress);
  const auto scene = read_scan(request.scan, *options, run, progress);
  if (!scene) return give_up(scene.error());

  const auto keep = request.layers ? pipeline::Keep::segmentations : pipeline::Keep::models;
  const auto result = pipeline::reconstruct(*scene, *options, run, keep);
  if (!result) return give_up(result.error());
  if (auto written = write_all(request, *result, *scene, run, progress); !written) return give_up(written.error());
  summarise(*result, request, progress);

  std::printf("%s\n", (fs::path(request.out) / "model.city.json").c_str());
  if (request.picture) std::printf("%s\n", (fs::path(request.out) / "picture.png").c_str());
  if (request.layers) std::printf("%s\n", (fs::path(request.out) / "segment.gpkg").c_str());
  return count(*result, pipeline::Outcome::full) == result->buildings.size() ? all_done : some_fell_back;
}

}  // namespace

auto reconstruct_verb(CLI::App& app, const base::Cancel& cancel) -> Verb {
  auto* verb = app.add_subcommand("reconstruct", "Mesh and footprints to labelled, watertight building models");
  auto request = std::make_shared<Request>();
  add_to(*verb, request->scan);
  verb->add_option("-o,--output", request->out, "Folder for the results")->required()->type_name("OUTDIR");
  verb->add_flag("--picture", request->picture, "Also write picture.png, above.png and error.png");
  verb->add_flag("--layers", request->layers, "Also write segment.gpkg, as 'mansard segment' does");
  verb->add_option("--error-limit", request->error_limit, "Ends of the error map's colour scale [m]")
      ->check(CLI::Range(0.01, 1000.0));
  return {verb, [request, &cancel] { return reconstruct(*request, cancel); }};
}

}  // namespace mansard::cli
