// `mansard simulate MODEL | --block KIND | --footprints FILE -o OUTDIR`: known truth, and a mesh as a scan would show
// it.
#include "mansard/simulate/simulate.hpp"

#include <cstdio>
#include <memory>

#include "apps/cli/exit.hpp"
#include "apps/cli/output.hpp"
#include "apps/cli/progress.hpp"
#include "apps/cli/settings.hpp"
#include "apps/cli/verbs.hpp"
#include "mansard/picture/picture.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;

struct Request {
  std::string model, block, footprints, out;
  bool overwrite = false, picture = false, quiet = false;
  std::size_t jobs = 0;
  Settings settings;
};

auto menu_of(simulate::Options& options) -> Menu {
  Menu menu{{simulate::option_list(options)}, {}};
  for (const auto& preset : simulate::presets()) menu.presets.push_back({preset.name, preset.meaning, preset.values});
  return menu;
}

/// What the input is called in truth.json.
auto source_of(const Request& request) -> std::string {
  return !request.block.empty() ? request.block : !request.model.empty() ? request.model : request.footprints;
}

auto truth_for(const Request& request, const simulate::Options& options, const base::Run& run, Progress& progress)
    -> base::Result<simulate::Truth> {
  if (!request.block.empty()) {
    const auto kind = simulate::kind_of(request.block);
    return simulate::make_block(*kind, options.block, run.seed, run);
  }
  if (!request.model.empty()) {
    auto plans = write::read_plans(request.model);
    if (!plans) return plans.error();
    return simulate::truth_of(std::move(*plans), run);
  }
  const auto scene = ingest::read_footprints(request.footprints, {}, run);
  if (!scene) return scene.error();
  auto warnings = scene->warnings;
  auto truth = simulate::furnish(*scene, options.block, run.seed, warnings, run);
  for (const auto& warning : warnings) progress.say(base::to_string(warning));
  return truth;
}

/// The scan, coloured by what its triangles show.
auto picture_of(const simulate::Scan& scan, const base::Run& run) -> base::Result<std::string> {
  constexpr std::array colours{picture::wall_grey, picture::roof_red, picture::ground_grey,
                               picture::Colour{110, 140, 96}};
  picture::Layer layer{scan.mesh, {}};
  for (const auto kind : scan.classes) layer.colours.push_back(colours[static_cast<std::size_t>(kind)]);
  const std::vector layers{layer};
  return picture::png(picture::draw(layers, {}, {}, run));
}

auto write_all(const Request& request, const simulate::Options& options, const simulate::Truth& truth,
               const base::Run& run, Progress& progress) -> base::Result<void> {
  const auto surface = simulate::surface_of(truth.city);
  if (!surface) return surface.error();
  const auto scan = simulate::scan(*surface, options.scan, run.seed, run);
  if (!scan) return scan.error();
  const auto footprints = simulate::survey(truth, options.survey, run.seed);
  if (!footprints) return footprints.error();

  progress.show("write", request.out, 1);
  const auto cityjson = write::cityjson(truth.city);
  if (!cityjson) return cityjson.error();
  auto obj = write::obj(truth.city, "truth.mtl");
  if (!obj) return obj.error();
  std::vector<std::pair<std::string, std::string>> files{
      {"mesh.ply", simulate::ply(*scan, truth.city.frame)},
      {"footprints.geojson", simulate::geojson(*footprints, truth.city.frame)},
      {"truth.city.json", *cityjson},
      {"truth.obj", std::move(obj->obj)},
      {"truth.mtl", std::move(obj->mtl)},
      {"plans.json", write::plans(truth.city)},
      {"truth.json", simulate::truth_json(truth, *footprints, options, source_of(request))}};
  if (request.picture) {
    auto picture = picture_of(*scan, run);
    if (!picture) return picture.error();
    files.emplace_back("picture.png", std::move(*picture));
  }
  if (auto written = base::write_files(in_folder(request.out, files), run.cancel); !written) return written;
  progress.say(std::to_string(truth.city.buildings.size()) + " buildings, " + std::to_string(truth.party_walls.size()) +
               " party walls, " + std::to_string(scan->mesh.triangles.size()) + " triangles");
  return {};
}

auto simulate_block(const Request& request, const base::Cancel& cancel) -> int {
  const int inputs =
      (request.model.empty() ? 0 : 1) + (request.block.empty() ? 0 : 1) + (request.footprints.empty() ? 0 : 1);
  if (inputs != 1) return give_up(base::error("usage", "simulate takes one of a MODEL, --block and --footprints"));
  if (!request.block.empty() && !simulate::kind_of(request.block))
    return give_up(base::error("option-value", "there are the blocks terrace, perimeter, courtyard, towers, detached",
                               request.block));
  simulate::Options options;
  if (auto applied = request.settings.apply(menu_of(options)); !applied) return give_up(applied.error());
  std::vector<fs::path> results, given;
  for (const auto* name : {"mesh.ply", "footprints.geojson", "truth.city.json", "truth.obj", "truth.mtl", "plans.json",
                           "truth.json", "picture.png"})
    results.push_back(fs::path(request.out) / name);
  for (const auto& input : {request.model, request.footprints})
    if (!input.empty()) given.emplace_back(input);
  if (auto spared = spare_inputs(results, given); !spared) return give_up(spared.error());
  if (auto ready = prepare(request.out, request.overwrite); !ready) return give_up(ready.error());
  base::limit_threads(request.jobs);

  Progress progress(request.quiet);
  base::Run run;
  run.cancel = &cancel;
  run.seed = static_cast<std::uint64_t>(options.seed);
  run.progress = [&](auto stage, auto subject, double fraction) { progress.show(stage, subject, fraction); };
  auto truth = truth_for(request, options, run, progress);
  if (!truth) return give_up(truth.error());
  if (request.model.empty()) {  // plans that are there keep the word of who made them
    truth->city.made_by.version = MANSARD_VERSION;
    const auto list = simulate::option_list(options);
    for (const auto& option : list.options())
      truth->city.made_by.options.emplace_back("simulate." + option.name, option.get());
  }
  if (auto written = write_all(request, options, *truth, run, progress); !written) return give_up(written.error());
  std::printf("%s\n", (fs::path(request.out) / "mesh.ply").c_str());
  return all_done;
}

}  // namespace

auto simulate_verb(CLI::App& app, const base::Cancel& cancel) -> Verb {
  auto* verb = app.add_subcommand("simulate", "A block with known truth, and a mesh as a scan would show it");
  auto request = std::make_shared<Request>();
  verb->add_option("MODEL", request->model, "A plans.json, or a model.city.json that carries plans")
      ->type_name("PLANS.json");
  verb->add_option("--block", request->block, "Invent one: terrace, perimeter, courtyard, towers, detached")
      ->type_name("KIND");
  verb->add_option("--footprints", request->footprints, "Real outlines (any OGR vector file) with invented buildings")
      ->type_name("FILE");
  verb->add_option("-o,--output", request->out, "Folder for the results")->required()->type_name("OUTDIR");
  verb->add_flag("--overwrite", request->overwrite, "Replace results that are there already");
  verb->add_flag("--picture", request->picture, "Also write picture.png: the scan, coloured by class");
  verb->add_option("-j,--jobs", request->jobs, "Threads; 0 for one per core. The result is the same at any number")
      ->check(CLI::Range(0, 1024));
  verb->add_flag("-q,--quiet", request->quiet, "No progress, no summary");
  verb->set_help_all_flag("--help-all", "Show this and the options of what is simulated");
  simulate::Options defaults;
  request->settings.add_to(*verb, menu_of(defaults));
  return {verb, [request, &cancel] { return simulate_block(*request, cancel); }};
}

}  // namespace mansard::cli
