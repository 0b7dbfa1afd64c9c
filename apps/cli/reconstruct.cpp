// `mansard reconstruct MESH… FOOTPRINTS -o OUTDIR`.
#include <malloc.h>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "apps/cli/catalogue.hpp"
#include "apps/cli/exit.hpp"
#include "apps/cli/formats.hpp"
#include "apps/cli/made.hpp"
#include "apps/cli/output.hpp"
#include "apps/cli/run_folder.hpp"
#include "apps/cli/scan.hpp"
#include "apps/cli/terrain.hpp"
#include "apps/cli/verbs.hpp"
#include "mansard/accuracy/accuracy.hpp"
#include "mansard/base/files.hpp"
#include "mansard/base/text.hpp"
#include "mansard/pipeline/scan_pieces.hpp"
#include "mansard/pipeline/since.hpp"
#include "mansard/report/layers.hpp"
#include "mansard/report/pictures.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;

struct ReconstructRequest {
  ScanRequest scan;
  TerrainOut terrain;
  std::string out;
  std::string formats = "default";
  std::string since;  ///< an earlier run; empty: all is made
  bool picture = false, layers = false, no_resume = false;
  double error_limit = 2.0;
  std::size_t share = 0, shares = 0;  ///< of the work, from 1; 0: all of it
};

auto summarise(const Made& made, const ReconstructRequest& request, Progress& progress) -> base::Result<void> {
  if (const auto reuse = in_words(made.summary.reuse, made.summary.blocks.size(), "blocks"); !reuse.empty())
    progress.say(reuse);
  const auto& n = made.outcomes;
  progress.say(in_words(n));
  if (const auto scan = report::accuracy_of(made.summary))
    progress.say("accuracy of the scan: " + accuracy::in_a_sentence(*scan));
  const auto& scores = made.summary.scores;
  progress.say("vertical error against the scan (RMSE): " + base::to_text(std::sqrt(scores.footprint_mse), 2) +
               " m over the footprints, " + base::to_text(std::sqrt(scores.mse), 2) + " m with the ground around them");
  if (n.full == n.all() || (!request.scan.verbose && n.all() > 20)) return {};
  return made.each([&](const auto&, const report::BuildingReport& building) -> base::Result<void> {
    if (building.outcome != report::Outcome::full)
      for (const auto& reason : building.reasons) progress.say(base::to_string(reason));
    return {};
  });
}

/// What `--formats` and `--layers` ask for.
auto targets_of(const ReconstructRequest& request) -> base::Result<std::vector<Target>> {
  auto formats = formats_in(request.formats + (request.layers ? ",geopackage" : ""));
  if (!formats) return formats.failure();
  return targets_in(request.out, *formats);
}

auto write_pictures(const ReconstructRequest& request, const pipeline::Options& options, const Made& made,
                    const texture::Baked& baked, const ingest::CityScene& city, const base::Run& run,
                    base::Outputs& outputs) -> base::Result<void> {
  ::malloc_trim(0);  // what the blocks took is not kept beside the pixels
  const auto& scene = city.scene;
  model::City textured;
  report::TexturedLayers layers;
  if (baked.textures) {  // in memory as a whole
    auto all = with_textures(made, *baked.textures).each([&](const model::Building& building, const auto&) {
      textured.buildings.push_back(building);
      return base::Result<void>();
    });
    if (!all) return all;
    auto scan = report::textured_scan(*baked.scan, scene);
    if (!scan) return scan.failure();
    layers = {std::move(*scan), report::textured_models(textured, options.write.solids)};
  }
  const report::Drawn drawn{
      scene, pipeline::scan_pieces(city, report::frame_of(scene)),
      [&](const auto& visit) {
        return made.each([&](const model::Building& building, const auto&) { return visit(building); });
      },
      made.each_error_map};
  const auto pictures = report::pictures(drawn, request.error_limit, run, baked.textures ? &layers : nullptr);
  if (!pictures) return pictures.failure();
  for (const auto& [name, image] :
       {std::pair{"picture.png", &pictures->angle}, std::pair{"above.png", &pictures->above},
        std::pair{"error.png", &pictures->error}}) {
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

auto write_all(const ReconstructRequest& request, const std::vector<Target>& targets, const pipeline::Options& options,
               const Made& made, const ingest::CityScene& city, const base::Run& run, Progress& progress)
    -> base::Result<Missing> {
  const auto& scene = city.scene;
  base::Outputs outputs;
  std::vector<formats::Layer> layers;
  if (request.layers) {
    layers = report::segment_layers(scene, made.whole->segmented, made.made_by, made.whole->city.buildings);
    layers.push_back(report::diagnostics_layer(*made.whole, scene));
  }
  if (auto overlaps = report::overlaps_layer(made.summary)) layers.push_back(std::move(*overlaps));
  texture::Baked baked;
  if (options.texture.bake) {
    auto done = textures_of(made, paths_of(request.scan).meshes, options, run, progress);
    if (!done) return done.failure();
    baked = std::move(*done);
  }
  progress.show("write", "", 1);
  auto missing = write_targets(baked.textures ? with_textures(made, *baked.textures) : made, targets, options.write,
                               layers, outputs, run, progress);
  if (!missing) return missing.failure();
  if (auto written = request.terrain.write(made, scene, city.cells.get(), options, outputs, run, progress); !written)
    return written.failure();
  const auto report_path = fs::path(request.out) / "run.json";
  if (auto written = write_report(made, scene, report_path, outputs); !written) return written.failure();
  if (!request.scan.report.empty())
    if (auto written = write_report(made, scene, request.scan.report, outputs); !written) return written.failure();
  if (request.picture) {
    progress.show("picture", "", 1);
    if (auto written = write_pictures(request, options, made, baked, city, run, outputs); !written)
      return written.failure();
  }
  const auto left = leftovers(request.out, "run.json", is_result);
  if (auto written = outputs.commit(run.cancel); !written) return written.failure();
  std::vector<fs::path> results{report_path};
  for (const auto& target : targets) {
    if (std::ranges::any_of(*missing, [&](const auto& one) { return one.target.path == target.path; })) continue;
    for (const auto& place : places_of(target)) results.push_back(place);
    if (options.texture.bake)
      if (const auto folder = formats::textures_of(target)) results.push_back(*folder);
  }
  if (request.picture)
    for (const auto* name : picture_names) results.push_back(fs::path(request.out) / name);
  remove_stale(left, results);
  return missing;
}

/// Everything that can be wrong with the outputs, before any work.
auto check_outputs(const ReconstructRequest& request, const std::vector<Target>& targets) -> base::Result<void> {
  std::vector<fs::path> results;
  for (const auto& name : all_results()) results.push_back(fs::path(request.out) / name);
  if (auto spared = spare_inputs(results, {request.scan.inputs.begin(), request.scan.inputs.end()}); !spared)
    return spared;
  if (!request.scan.report.empty())
    if (auto apart = spare_results(request.scan.report, results); !apart) return apart;
  if (!request.scan.report.empty()) results.emplace_back(request.scan.report);
  if (auto ready = prepare(request.out, request.scan.overwrite); !ready) return ready;
  if (auto usable = request.terrain.check(results, {request.scan.inputs.begin(), request.scan.inputs.end()},
                                          request.scan.overwrite);
      !usable)
    return usable;
  if (auto usable = files_free(request.scan, {}); !usable) return usable;
  // A run that was killed while its results took their places left some of them: they are its own.
  const bool replace = request.scan.overwrite || began_empty(request.out);
  for (const auto& target : targets)
    if (auto usable = target_free(target, replace); !usable) return usable;
  return {};
}

auto check_share(const ReconstructRequest& request) -> base::Result<void> {
  if ((request.share > 0) != (request.shares > 0))
    return base::error("usage", "--share and --shares belong together: --share 1 --shares 8");
  if (request.share > request.shares)
    return base::error("usage", "there are only " + std::to_string(request.shares) + " shares", "--share");
  if (request.shares > 0 && !request.since.empty())
    return base::error("usage", "what has changed is found for the whole run; leave --shares out", "--since");
  if (request.shares > 0 && request.no_resume)
    return base::error("usage", "a share is made to be kept; leave --no-resume out", "--share");
  return {};
}

auto reconstruct(const ReconstructRequest& request, const base::Cancel& cancel) -> int {
  auto options = options_of(request.scan);
  if (!options) return give_up(options.errors());
  if (auto right = check_share(request); !right) return give_up(right.errors());
  const auto targets = targets_of(request);
  if (!targets) return give_up(targets.errors());
  if (auto ready = check_outputs(request, *targets); !ready) return give_up(ready.errors());
  const auto folder =
      RunFolder::open(request.out, "reconstruct", request.shares > 0 ? RunFolder::Use::share : RunFolder::Use::whole);
  if (!folder) return give_up(folder.errors());
  Progress progress(request.scan.quiet);
  auto run = start(request.scan, options->seed, cancel, progress);
  run.progress = [show = std::move(run.progress), &folder](auto stage, auto subject, double fraction) {
    (*folder)->note(stage, fraction);
    show(stage, subject, fraction);
  };
  const auto stopped = [&](const auto& failed) {
    const auto code = give_up(failed.errors());
    if (const auto kept = (*folder)->kept_in_words(); !kept.empty() && !request.no_resume) progress.say(kept);
    return code;
  };
  // Layers are made of everything at once, and textured pictures of the whole mesh.
  const bool whole = request.layers || !request.since.empty();
  const auto city = (whole || (request.picture && options->texture.bake)) && request.shares == 0
                        ? read_scan(request.scan, *options, run, progress).transform([](model::Scene&& scene) {
                            return ingest::CityScene{std::move(scene), nullptr};
                          })
                        : read_city_scan(request.scan, *options, run, progress);
  if (!city) return give_up(city.errors());

  const auto keep = request.layers ? pipeline::Keep::segmentations : pipeline::Keep::models;
  const pipeline::Schedule schedule{request.no_resume ? nullptr : (*folder)->kept(), &(*folder)->tally()};
  if (request.shares > 0) {
    const auto made = pipeline::make_share(*city, *options, run, keep, schedule, request.share - 1, request.shares);
    if (!made) return stopped(made);
    const auto& tally = (*folder)->tally();
    progress.say("share " + std::to_string(request.share) + " of " + std::to_string(request.shares) + ": " +
                 std::to_string(tally.blocks_done) + " blocks with " + std::to_string(tally.buildings_done) +
                 " buildings are kept");
    return all_done;
  }
  const auto finish = [&](const Made& made) -> int {
    const auto missing = write_all(request, *targets, *options, made, *city, run, progress);
    if (!missing) return stopped(missing);
    if (missing->empty()) (*folder)->finished();
    if (auto done = summarise(made, request, progress); !done) return stopped(done);
    if (!missing->empty()) return give_up(reasons_of(*missing, *targets));
    std::printf("%s\n", targets->front().path.c_str());
    if (request.picture) std::printf("%s\n", (fs::path(request.out) / "picture.png").c_str());
    if (request.layers) std::printf("%s\n", (fs::path(request.out) / "model.gpkg").c_str());
    return made.outcomes.full == made.outcomes.all() ? all_done : some_fell_back;
  };
  if (!request.since.empty()) {
    const auto since = pipeline::find_changed(city->scene, request.since, *options, run);
    if (!since) return stopped(since);
    for (const auto& warning : since->old.warnings) progress.say(base::to_string(warning));
    progress.say(std::to_string(since->all_blocks - since->blocks.size()) + " of " + std::to_string(since->all_blocks) +
                 " blocks are as " + request.since + " has them and are taken over; the others are made again");
    const auto result = pipeline::reconstruct_since(city->scene, *since, *options, run, keep, schedule);
    return result ? finish(made_of(*result)) : stopped(result);
  }
  if (whole) {
    const auto result = pipeline::reconstruct(city->scene, *options, run, keep, {}, schedule);
    return result ? finish(made_of(*result)) : stopped(result);
  }
  const auto aside =
      pipeline::reconstruct_aside(*city, *options, run, schedule,
                                  request.picture ? pipeline::Aside::models_and_error_maps : pipeline::Aside::models);
  return aside ? finish(made_of(*aside)) : stopped(aside);
}

}  // namespace

auto reconstruct_verb(CLI::App& app, std::vector<std::string> words, const base::Cancel& cancel) -> Verb {
  auto* verb = add_verb(app, "reconstruct");
  auto request = std::make_shared<ReconstructRequest>();
  add_to(*verb, request->scan);
  request->scan.words = std::move(words);
  verb->add_option("-o,--output", request->out, "Output folder")->required()->type_name("OUTDIR");
  verb->add_flag("--picture", request->picture,
                 "Also write pictures of scan and models (picture.png, above.png, error.png)");
  verb->add_flag("--layers", request->layers,
                 "Also write the layers of 'mansard segment' and all diagnostics to model.gpkg");
  verb->add_option("--formats", request->formats, formats_help)->type_name("FORMATS")->default_str(default_formats);
  request->terrain.add_to(*verb);
  verb->add_option("--since", request->since,
                   "Make again only what has changed since an earlier run, by the new scan, and take over the other "
                   "models of that with their edits")
      ->type_name("RUN");
  verb->add_flag("--no-resume", request->no_resume,
                 "Keep no blocks in OUTDIR/.mansard for a later run, and take none over from an earlier one");
  verb->add_option("--shares", request->shares, "Number of shares that the work is divided into; see --share")
      ->check(CLI::Range(1, 100000));
  verb->add_option("--share", request->share,
                   "Only make and keep the blocks of this share, from 1; the same command without --share and --shares "
                   "then writes the models")
      ->check(CLI::Range(1, 100000));
  verb->add_option("--error-limit", request->error_limit, "Both limits of the colour scale of the error map, in metres")
      ->check(CLI::Range(0.01, 1000.0));
  return {verb, [request, &cancel] { return reconstruct(*request, cancel); }};
}

}  // namespace mansard::cli
