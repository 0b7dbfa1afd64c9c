#include "apps/cli/scan.hpp"

#include <algorithm>

#include "apps/cli/formats.hpp"
#include "apps/cli/output.hpp"
#include "apps/cli/shell_word.hpp"
#include "mansard/ingest/join.hpp"
#include "mansard/pipeline/placing.hpp"

namespace mansard::cli {

namespace fs = std::filesystem;

namespace {

void add_flags(CLI::App& verb, Common& common, const std::string& silenced) {
  verb.add_flag("--overwrite", common.overwrite, "Replace outputs that already exist");
  add_jobs(verb, common.jobs);
  verb.add_flag("-q,--quiet", common.quiet, "Print no progress and no " + silenced);
}

/// The command line as a shell takes it, with other inputs at the places of the inputs; empty where these places are
/// not clear, because an input is also the value of an option.
auto command_with(const ScanRequest& request, const std::vector<std::string>& inputs) -> std::string {
  const auto is_input = [&](const std::string& word) {
    return std::ranges::find(request.inputs, word) != request.inputs.end();
  };
  if (std::ranges::count_if(request.words, is_input) != std::ranges::ssize(request.inputs)) return {};
  std::string command = "mansard";
  std::size_t next = 0;
  for (std::size_t i = 1; i < request.words.size(); ++i)
    command += " " + quoted(is_input(request.words[i]) ? inputs[next++] : request.words[i]);
  return command;
}

/// "; run: COMMAND", where there is one.
auto to_run(const std::string& command) -> std::string { return command.empty() ? "" : "; run: " + command; }

}  // namespace

void add_jobs(CLI::App& verb, std::size_t& jobs) {
  verb.add_option("-j,--jobs", jobs, "Number of threads; 0 for one per core (the result does not depend on it)")
      ->check(CLI::Range(0, 1024));
}

void add_common(CLI::App& verb, Common& common, const std::string& silenced) {
  add_flags(verb, common, silenced);
  common.settings.add_to(verb);
}

void add_common(CLI::App& verb, Common& common, const std::string& silenced, const Menu& menu) {
  add_flags(verb, common, silenced);
  common.settings.add_to(verb, menu);
}

void Join::add_to(CLI::App& verb) {
  verb.add_option("--join", table,
                  "Table whose columns become attributes of the buildings (CSV, GeoPackage, any of GDAL's)")
      ->type_name("FILE");
  verb.add_option("--on", key, "Column of the table of --join that has the ids of the buildings")->type_name("KEY");
}

auto Join::apply(model::Scene& scene, const ingest::Options& options, Progress& progress) const -> base::Result<void> {
  if (table.empty() && key.empty()) return {};
  if (table.empty()) return base::error("usage", "there is no table to join; name it with --join", "--on");
  if (key.empty()) return base::error("usage", "name the column that has the ids of the buildings with --on", "--join");
  const auto warnings = ingest::join(scene, table, key, options.encoding);
  if (!warnings) return warnings.failure();
  for (const auto& warning : *warnings) progress.say(base::to_string(warning));
  return {};
}

void add_to(CLI::App& verb, ScanRequest& request, bool may_derive) {
  verb.add_option("INPUTS", request.inputs,
                  "Meshes, or point clouds: " + readable_formats().meshes +
                      ". Then the footprints: " + readable_formats().footprints)
      ->type_name("MESH... FOOTPRINTS");
  if (may_derive)
    verb.add_flag("--derive-footprints", request.derive_footprints,
                  "Derive the footprints from the meshes; all inputs are meshes then");
  verb.add_option("--ground-attribute", request.ground_attribute,
                  "Attribute of the footprints that has the z of the ground, in the heights of the files")
      ->type_name("NAME");
  verb.add_flag("--align", request.align,
                "Move the mesh to the footprints where it is beside them by more than the error of that; run.json has "
                "the --mesh-offset");
  verb.add_option("--report", request.report, "Write a copy of the report (run.json) to this file")->type_name("FILE");
  request.join.add_to(verb);
  verb.add_flag("-v,--verbose", request.verbose,
                "Print every warning and every reason, even if there are more than 20");
  add_common(verb, request, "summary");
}

auto check_order(const ScanRequest& request) -> base::Result<void> {
  const std::vector<fs::path> typed(request.inputs.begin(), request.inputs.end());
  if (request.derive_footprints) {
    const auto vector = std::ranges::find_if(typed, pipeline::is_footprints_name);
    if (vector == typed.end()) return {};
    return base::error("usage",
                       "this is a vector file, and --derive-footprints makes the footprints from the mesh; leave out "
                       "the file or the option",
                       vector->string());
  }
  const auto ordered = pipeline::in_order(typed);
  if (!ordered.wrong_order) return {};
  std::vector<std::string> inputs;
  for (const auto& mesh : ordered.paths.meshes) inputs.push_back(mesh.string());
  inputs.push_back(ordered.paths.footprints.string());
  return base::error("usage",
                     "the footprints are given before a mesh; meshes come first, the footprints last" +
                         to_run(command_with(request, inputs)),
                     ordered.paths.footprints.string());
}

auto options_of(const ScanRequest& request) -> base::Result<pipeline::Options> {
  if (request.inputs.size() < (request.derive_footprints ? 1 : 2))
    return base::error("usage", request.derive_footprints ? "expected one or more meshes"
                                                          : "expected one or more meshes, then the footprints; "
                                                            "--derive-footprints derives them from the meshes");
  if (auto order = check_order(request); !order) return order.failure();
  pipeline::Options options;
  if (auto applied = request.settings.apply(options); !applied) return applied.failure();
  if (!request.ground_attribute.empty()) options.roof.ground_attribute = request.ground_attribute;
  return options;
}

auto files_free(const ScanRequest& request, std::vector<fs::path> files) -> base::Result<void> {
  if (!request.report.empty()) files.emplace_back(request.report);
  if (auto spared = spare_inputs(files, {request.inputs.begin(), request.inputs.end()}); !spared) return spared;
  for (const auto& file : files)
    if (auto usable = file_free(file, request.overwrite); !usable) return usable;
  return {};
}

auto start(const Common& common, std::int64_t seed, const base::Cancel& cancel, Progress& progress) -> base::Run {
  base::limit_threads(common.jobs);
  base::Run run;
  run.cancel = &cancel;
  run.seed = static_cast<std::uint64_t>(seed);
  run.progress = [&progress](auto stage, auto subject, double fraction) { progress.show(stage, subject, fraction); };
  return run;
}

auto paths_of(const ScanRequest& request) -> pipeline::InputPaths {
  pipeline::InputPaths paths{{request.inputs.begin(), request.inputs.end()}, {}, request.derive_footprints};
  if (!request.derive_footprints) {
    paths.footprints = std::move(paths.meshes.back());
    paths.meshes.pop_back();
  }
  return paths;
}

namespace {

void tell(const ScanRequest& request, const model::Scene& scene, Progress& progress) {
  for (const auto& warning : scene.warnings) progress.say(base::to_string(warning));
  if (request.derive_footprints)
    progress.say(std::to_string(scene.footprints.size()) + " footprints were derived from the mesh");
}

/// Of mesh and footprints that do not meet: with the options that make them, where they can be found.
auto explained(base::Failure failure, const ScanRequest& request, const pipeline::Options& options,
               const base::Run& run, Progress& progress) -> base::Failure {
  auto& why = failure.diagnostics.front();
  constexpr std::string_view asks = "; give --mesh-offset or --crs";
  if (why.code != "ingest-no-overlap" || request.derive_footprints || !why.message.ends_with(asks)) return failure;
  progress.say("mesh and footprints do not overlap; looking for the CRS or the offset with which they match");
  const auto placing = pipeline::find_placing(paths_of(request), options, run);
  if (!placing || !*placing) return failure;
  why.message.resize(why.message.size() - asks.size());
  auto more = pipeline::options_in_words(**placing, options);
  if (more.empty()) more = "--crs local";  // they match by their numbers alone
  // What is given already is replaced: an option is given once.
  std::vector<std::string> replaced;
  if (more.find("--crs") != std::string::npos) replaced.emplace_back("ingest.crs");
  if (more.find("--mesh-offset") != std::string::npos) replaced.emplace_back("ingest.mesh_offset");
  const auto given = request.settings.typed({});
  const bool again = request.settings.typed(replaced) != given;
  why.message += (again ? "; with " + more + " in place of what is given, " : "; add " + more + ": then ") +
                 pipeline::reason_in_words(**placing);
  if (const auto command = command_with(request, request.inputs); !again && !command.empty())
    why.message += to_run(command + " " + more);
  return failure;
}

/// Sets the offset of the mesh as --align asks for. Returns what was done, to be kept with the warnings.
auto align(const ScanRequest& request, pipeline::Options& options, const base::Run& run, Progress& progress)
    -> base::Result<std::vector<base::Diagnostic>> {
  std::vector<base::Diagnostic> done;
  if (!request.align || request.derive_footprints) return done;
  auto offset = pipeline::align_scan(paths_of(request), options, run);
  if (!offset) return explained(offset.failure(), request, options, run, progress);
  if (!*offset) {
    progress.say("--align: the mesh is where the footprints are, as far as that can be measured");
    return done;
  }
  options.ingest.mesh_offset = **offset;
  done.push_back(
      base::warning("scan-aligned", "the mesh was moved to the footprints: " + pipeline::offset_in_words(**offset)));
  return done;
}

void prepend(std::vector<base::Diagnostic> first, std::vector<base::Diagnostic>& all) {
  all.insert(all.begin(), first.begin(), first.end());
}

}  // namespace

auto read_scan(const ScanRequest& request, pipeline::Options& options, const base::Run& run, Progress& progress)
    -> base::Result<model::Scene> {
  progress.show("ingest", request.inputs.front(), 0);
  auto aligned = align(request, options, run, progress);
  if (!aligned) return aligned.failure();
  auto scene = pipeline::read_inputs(paths_of(request), options, run);
  if (!scene) return explained(scene.failure(), request, options, run, progress);
  prepend(*std::move(aligned), scene->warnings);
  tell(request, *scene, progress);
  if (auto joined = request.join.apply(*scene, options.ingest, progress); !joined) return joined.failure();
  return scene;
}

auto read_city_scan(const ScanRequest& request, pipeline::Options& options, const base::Run& run, Progress& progress)
    -> base::Result<ingest::CityScene> {
  progress.show("ingest", request.inputs.front(), 0);
  auto aligned = align(request, options, run, progress);
  if (!aligned) return aligned.failure();
  auto city = pipeline::read_city_inputs(paths_of(request), options, run);
  if (!city) return explained(city.failure(), request, options, run, progress);
  prepend(*std::move(aligned), city->scene.warnings);
  tell(request, city->scene, progress);
  if (auto joined = request.join.apply(city->scene, options.ingest, progress); !joined) return joined.failure();
  return city;
}

}  // namespace mansard::cli
