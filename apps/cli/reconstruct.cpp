// `mansard reconstruct MESH… FOOTPRINTS -o OUTDIR`.
#include <cstdio>
#include <memory>

#include "apps/cli/exit.hpp"
#include "apps/cli/output.hpp"
#include "apps/cli/progress.hpp"
#include "apps/cli/settings.hpp"
#include "apps/cli/verbs.hpp"
#include "mansard/base/files.hpp"
#include "mansard/base/text.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;

struct Request {
  std::vector<std::string> inputs;  // meshes, then the footprints
  std::string out;
  std::string report;
  bool overwrite = false, picture = false, quiet = false, verbose = false;
  std::size_t jobs = 0;
  double error_limit = 2.0;
  Settings settings;
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
    if (building.outcome != pipeline::Outcome::full && (request.verbose || r.buildings.size() <= 20))
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
  auto all = in_folder(request.out, *files);
  if (!request.report.empty()) all.push_back({request.report, report});
  return base::write_files(all, run.cancel);
}

/// Whatever may be wrong with the outputs, before any work.
auto check_outputs(const Request& request) -> base::Result<void> {
  const std::vector<fs::path> inputs(request.inputs.begin(), request.inputs.end());
  std::vector<fs::path> outputs;
  for (const auto* name : result_names) outputs.push_back(fs::path(request.out) / name);
  if (!request.report.empty()) outputs.emplace_back(request.report);
  if (auto spared = spare_inputs(outputs, inputs); !spared) return spared;
  if (!request.report.empty())
    if (auto usable = file_free(request.report, request.overwrite); !usable) return usable;
  return prepare(request.out, request.overwrite);
}

auto reconstruct(const Request& request, const base::Cancel& cancel) -> int {
  if (request.inputs.size() < 2)
    return give_up(base::error("usage", "reconstruct takes one mesh or more, then the footprints"));
  pipeline::Options options;
  if (auto applied = request.settings.apply(options); !applied) return give_up(applied.error());
  if (auto ready = check_outputs(request); !ready) return give_up(ready.error());
  base::limit_threads(request.jobs);

  Progress progress(request.quiet);
  base::Run run;
  run.cancel = &cancel;
  run.seed = static_cast<std::uint64_t>(options.seed);
  run.progress = [&](auto stage, auto subject, double fraction) { progress.show(stage, subject, fraction); };

  progress.show("ingest", request.inputs.front(), 0);
  const std::vector<fs::path> meshes(request.inputs.begin(), request.inputs.end() - 1);
  const auto scene = ingest::read_scene(meshes, request.inputs.back(), options.ingest, run);
  if (!scene) return give_up(scene.error());
  for (const auto& warning : scene->warnings) progress.say(base::to_string(warning));

  const auto result = pipeline::reconstruct(*scene, options, run);
  if (!result) return give_up(result.error());
  if (auto written = write_all(request, *result, *scene, run, progress); !written) return give_up(written.error());
  summarise(*result, request, progress);

  std::printf("%s\n", (fs::path(request.out) / "model.city.json").c_str());
  if (request.picture) std::printf("%s\n", (fs::path(request.out) / "picture.png").c_str());
  return count(*result, pipeline::Outcome::full) == result->buildings.size() ? all_done : some_fell_back;
}

}  // namespace

auto reconstruct_verb(CLI::App& app, const base::Cancel& cancel) -> Verb {
  auto* verb = app.add_subcommand("reconstruct", "Mesh and footprints to labelled, watertight building models");
  auto request = std::make_shared<Request>();
  verb->add_option("INPUTS", request->inputs,
                   "Meshes (OBJ, PLY, OFF, GLB, or folders of them), then the footprints (any OGR vector file)")
      ->type_name("MESH… FOOTPRINTS");
  verb->add_option("-o,--output", request->out, "Folder for the results")->required()->type_name("OUTDIR");
  verb->add_flag("--overwrite", request->overwrite, "Replace results that are there already");
  verb->add_flag("--picture", request->picture, "Also write picture.png, above.png and error.png");
  verb->add_option("--error-limit", request->error_limit, "Ends of the error map's colour scale [m]")
      ->check(CLI::Range(0.01, 1000.0));
  verb->add_option("--report", request->report, "Write the report (run.json) here too")->type_name("FILE");
  verb->add_option("-j,--jobs", request->jobs, "Threads; 0 for one per core. The result is the same at any number")
      ->check(CLI::Range(0, 1024));
  verb->add_flag("-q,--quiet", request->quiet, "No progress, no summary");
  verb->add_flag("-v,--verbose", request->verbose, "Name the reason of every building that is not in full");
  verb->set_help_all_flag("--help-all", "Show this and every room's options");
  request->settings.add_to(*verb);
  return {verb, [request, &cancel] { return reconstruct(*request, cancel); }};
}

}  // namespace mansard::cli
