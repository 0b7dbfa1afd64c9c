// `mansard extrude INPUT -o OUT`: solids from footprints without a mesh, or again from plan and profiles.
#include "apps/cli/extrude.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/cli/catalogue.hpp"
#include "apps/cli/exit.hpp"
#include "apps/cli/formats.hpp"
#include "apps/cli/output.hpp"
#include "apps/cli/scan.hpp"
#include "apps/cli/settings.hpp"
#include "apps/cli/verbs.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/input_name.hpp"
#include "mansard/pipeline/stored.hpp"
#include "mansard/report/layers.hpp"
#include "mansard/report/pictures.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;

/// Whether OUT names one result, by its ending; several formats go into a folder otherwise.
auto is_one(const fs::path& out) -> bool {
  if (formats::is_database_name(out)) return true;
  const auto format = formats::format_of(out);
  if (!format) return false;
  if (*format != formats::Format::tiles) return true;
  return out.extension() == ".3dtiles" || out.filename() == "tileset.json";
}

}  // namespace

auto targets_of(const ExtrudeRequest& request) -> base::Result<std::vector<Target>> {
  if (!is_one(request.out)) {
    const auto formats = formats_in(request.formats.empty() ? "default" : request.formats);
    if (!formats) return formats.failure();
    return targets_in(request.out, *formats);
  }
  if (!request.formats.empty())
    return base::error(
        "usage", "'" + request.out + "' already names the format by its file extension; give an output folder instead",
        "--formats");
  auto target = target_at(request.out);
  if (!target) return target.failure();
  return std::vector{*target};
}

namespace {

void tell(const std::vector<base::Diagnostic>& diagnostics, const ExtrudeRequest& request) {
  for (const auto& diagnostic : diagnostics)
    if (!request.quiet) std::fprintf(stderr, "mansard: %s\n", base::to_string(diagnostic).c_str());
}

auto extrude_plans(formats::CityReader& reader, const ExtrudeRequest& request, const base::Cancel& cancel) -> int {
  if (!request.report.empty())
    return give_up(
        base::error("usage", "there is no report where models are rebuilt from plans; leave it out", "--report"));
  if (request.terrain.asked())
    return give_up(base::error("usage",
                               "there is no terrain where models are rebuilt from plans; extrude the footprints with "
                               "--dtm instead",
                               "--terrain-out"));
  pipeline::Options options;
  tell(pipeline::take_options(reader.header().made_by, options), request);
  if (auto applied = request.settings.apply(options); !applied) return give_up(applied.errors());
  std::vector<base::Diagnostic> refused;
  auto city = formats::read_whole(reader, &refused);
  if (!city) return give_up(city.errors());
  if (!refused.empty() && std::ranges::all_of(city->buildings, [](const auto& b) { return b.parts.empty(); }))
    return give_up(refused);
  const auto targets = targets_of(request);
  if (!targets) return give_up(targets.errors());
  const auto beside = layers_beside(reader, request.input, *targets);
  if (!beside) return give_up(beside.errors());
  if (auto ready = check_outputs(request); !ready) return give_up(ready.errors());
  const auto folder = open_run(request);
  if (!folder) return give_up(folder.errors());
  base::Run run;
  run.cancel = &cancel;
  pipeline::note_options(options, city->made_by);
  const auto raised = pipeline::raise_plans(std::move(*city), options, run);
  if (!raised) return give_up(raised.errors());
  refused.insert(refused.end(), raised->refused.begin(), raised->refused.end());
  for (const auto& part : refused) std::fprintf(stderr, "mansard: %s\n", base::to_string(part).c_str());
  for (const auto& part : raised->fell_short) tell(part.reasons, request);
  tell(raised->remarks, request);
  tell(beside->warnings, request);
  const auto missing = write_out(raised->city, options, request, run, beside->layers);
  if (!missing) return give_up(missing.errors());
  if (*folder) (*folder)->finished_without_kept();
  if (!missing->empty()) return give_up(reasons_of(*missing, *targets));
  std::printf("%s\n", formats::name_to_show(request.out).c_str());
  return raised->fell_short.empty() && refused.empty() ? all_done : some_fell_back;
}

/// JSON in which no member is what GeoJSON, TopoJSON, ESRI JSON or CityJSON have: a plan file that lacks its type,
/// rather than footprints.
auto looks_like_plans(const fs::path& path) -> bool {
  const auto bytes = base::read_file(path);
  if (!bytes) return false;
  const auto json = nlohmann::json::parse(*bytes, nullptr, false);
  if (!json.is_object()) return false;
  const auto type = json.contains("type") && json["type"].is_string() ? json["type"].get<std::string>() : std::string();
  return !json.contains("features") && !json.contains("coordinates") && !json.contains("geometry") &&
         !json.contains("geometries") && type != "Topology" && type != "CityJSON";
}

auto extrude(const ExtrudeRequest& request, const base::Cancel& cancel) -> int {
  auto reader = formats::read_city(request.input);
  if (reader) return extrude_plans(**reader, request, cancel);
  const bool plans = formats::format_of(request.input) == formats::Format::plans;
  if (!pipeline::is_foreign(reader.error()) && reader.error().code.starts_with("write-"))
    return give_up(reader.errors());
  if (plans && looks_like_plans(request.input)) return give_up(reader.errors());
  return extrude_footprints(request, cancel);
}

auto picture_file(const fs::path& out) -> fs::path {
  return is_one(out) ? fs::path(out).replace_extension(".png") : out / "picture.png";
}

}  // namespace

auto check_outputs(const ExtrudeRequest& request) -> base::Result<void> {
  const bool one = is_one(request.out);
  const auto targets = targets_of(request);
  if (!targets) return targets.failure();
  const bool database = formats::is_database_name(request.out);
  if (database && request.picture)
    return base::error("usage", "a picture is written beside a file or into a folder, and the output is a database",
                       "--picture");
  std::vector<fs::path> all, single;
  for (const auto& target : *targets)
    if (!database)
      for (const auto& place : places_of(target)) all.push_back(place);
  if (request.picture || !one) all.push_back(picture_file(request.out));
  if (!one) all.push_back(fs::path(request.out) / "run.json");
  if (one && request.picture) single.push_back(picture_file(request.out));
  if (!request.report.empty()) {
    if (auto apart = spare_results(request.report, all); !apart) return apart;
    single.emplace_back(request.report);
  }
  all.insert(all.end(), single.begin(), single.end());
  if (auto spared = spare_inputs(all, {request.input}); !spared) return spared;
  // A run that was killed while its results took their places left some of them: they are its own.
  const bool replace = request.overwrite || (!database && began_empty(request.out));
  const auto ready = one ? target_free(targets->front(), replace) : prepare(request.out, request.overwrite);
  if (!ready) return ready;
  for (const auto& path : single)
    if (auto usable = file_free(path, replace); !usable) return usable;
  return request.terrain.check(all, {request.input}, replace);
}

auto open_run(const ExtrudeRequest& request) -> base::Result<std::unique_ptr<RunFolder>> {
  if (formats::is_database_name(request.out)) return std::unique_ptr<RunFolder>();
  return RunFolder::open(request.out, "extrude", is_one(request.out) ? RunFolder::Use::file : RunFolder::Use::whole);
}

namespace {

auto write_picture(const model::City& city, const ExtrudeRequest& request, const base::Run& run, base::Outputs& outputs)
    -> base::Result<void> {
  auto bytes = picture::png(report::picture_of(city, {}, run));
  if (!bytes) return bytes.failure();
  return write_bytes(picture_file(request.out), *bytes, outputs);
}

}  // namespace

auto write_out(const model::City& city, const pipeline::Options& options, const ExtrudeRequest& request,
               const base::Run& run, const std::vector<formats::Layer>& more) -> base::Result<Missing> {
  const auto targets = targets_of(request);
  if (!targets) return targets.failure();
  base::Outputs outputs;
  auto written = write_models(city, *targets, options.write, outputs, more);
  if (!written) return written.failure();
  tell(written->warnings, request);
  if (request.picture)
    if (auto drawn = write_picture(city, request, run, outputs); !drawn) return drawn.failure();
  if (auto committed = outputs.commit(run.cancel); !committed) return committed.failure();
  return std::move(written->missing);
}

auto write_out(const Made& made, const model::Scene& scene, const pipeline::Options& options,
               const ExtrudeRequest& request, const base::Run& run, Progress& progress) -> base::Result<Missing> {
  const auto targets = targets_of(request);
  if (!targets) return targets.failure();
  base::Outputs outputs;
  std::vector<formats::Layer> layers;
  if (auto overlaps = report::overlaps_layer(made.summary)) layers.push_back(std::move(*overlaps));
  auto missing = write_targets(made, *targets, options.write, layers, outputs, run, progress);
  if (!missing) return missing.failure();
  if (auto written = request.terrain.write(made, scene, nullptr, options, outputs, run, progress); !written)
    return written.failure();
  std::vector<fs::path> reports;
  if (!is_one(request.out)) reports.push_back(fs::path(request.out) / "run.json");
  if (!request.report.empty()) reports.emplace_back(request.report);
  for (const auto& path : reports)
    if (auto written = write_report(made, scene, path, outputs); !written) return written.failure();
  if (request.picture) {
    model::City city{made.frame, made.made_by, {}};
    auto all = made.each([&](model::Building building, const auto&) -> base::Result<void> {
      city.buildings.push_back(std::move(building));
      return {};
    });
    if (all) all = write_picture(city, request, run, outputs);
    if (!all) return all.failure();
  }
  if (auto committed = outputs.commit(run.cancel); !committed) return committed.failure();
  return missing;
}

auto extrude_verb(CLI::App& app, const base::Cancel& cancel) -> Verb {
  auto* verb = add_verb(app, "extrude");
  auto request = std::make_shared<ExtrudeRequest>();
  verb->add_option(
          "INPUT", request->input,
          "Footprints: " + readable_formats().footprints + ". Or a model with plans: " + readable_formats().own_models)
      ->required()
      ->type_name("FOOTPRINTS|MODEL");
  verb->add_option("-o,--output", request->out,
                   "Output file, with its format by its file extension (" + extensions() + "), or a folder")
      ->required()
      ->type_name("OUT");
  verb->add_option("--formats", request->formats, formats_help)->type_name("FORMATS")->default_str(default_formats);
  verb->add_flag("--overwrite", request->overwrite, "Replace outputs that already exist");
  verb->add_flag("--picture", request->picture, "Also write a picture of the models");
  verb->add_option("--report", request->report, "Write a copy of the report (run.json) to this file")
      ->type_name("FILE");
  verb->add_flag(
      "--no-resume", request->no_resume,
      "Keep nothing in OUT/.mansard or OUT.mansard for a later run, and take nothing over from an earlier one");
  request->join.add_to(*verb);
  request->terrain.add_to(*verb);
  add_jobs(*verb, request->jobs);
  verb->add_flag("-q,--quiet", request->quiet, "Print no progress and no summary");
  verb->add_flag("-v,--verbose", request->verbose,
                 "Print every remark and every reason, even for more than 20 buildings");
  request->settings.add_to(*verb);
  return {verb, [request, &cancel] {
            base::limit_threads(request->jobs);
            return extrude(*request, cancel);
          }};
}

}  // namespace mansard::cli
