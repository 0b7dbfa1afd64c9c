// `mansard extrude INPUT -o OUT`: plan and profiles to solids again, or footprints to solids without a mesh.
#include "apps/cli/extrude.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <memory>

#include "apps/cli/exit.hpp"
#include "apps/cli/output.hpp"
#include "apps/cli/settings.hpp"
#include "apps/cli/verbs.hpp"
#include "mansard/base/files.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;

/// Whether OUT names one file, by its ending; all formats go into a folder otherwise.
auto is_file(const fs::path& out) -> bool {
  return out.filename().string().ends_with(".json") || out.extension() == ".obj" || out.extension() == ".glb";
}

/// The files that OUT stands for.
auto outputs(const fs::path& out) -> std::vector<fs::path> {
  std::vector<fs::path> all;
  if (!is_file(out)) {
    for (const auto* name : result_names) all.push_back(out / name);
    return all;
  }
  all.push_back(out);
  if (out.extension() == ".obj") all.push_back(fs::path(out).replace_extension(".mtl"));
  return all;
}

auto extrude_plans(const ExtrudeRequest& request, const base::Cancel& cancel) -> int {
  if (!request.report.empty())
    return give_up(base::error("usage", "plans are raised without a report; --report is for footprints", "--report"));
  pipeline::Options options;
  if (auto applied = request.settings.apply(options); !applied) return give_up(applied.error());
  auto city = write::read_plans(request.input);
  if (!city) return give_up(city.error());
  if (auto ready = check_outputs(request); !ready) return give_up(ready.error());
  base::Run run;
  run.cancel = &cancel;
  const auto raised = pipeline::raise_plans(std::move(*city), options, run);
  if (!raised) return give_up(raised.error());
  for (const auto& part : raised->fell_short)
    for (const auto& reason : part.reasons)
      if (!request.quiet) std::fprintf(stderr, "mansard: %s\n", base::to_string(reason).c_str());
  if (auto written = write_out(raised->city, {}, request, run); !written) return give_up(written.error());
  std::printf("%s\n", request.out.c_str());
  return raised->fell_short.empty() ? all_done : some_fell_back;
}

auto picture_file(const fs::path& out) -> fs::path {
  return is_file(out) ? fs::path(out).replace_extension(".png") : out / "picture.png";
}

}  // namespace

auto check_outputs(const ExtrudeRequest& request) -> base::Result<void> {
  const bool file = is_file(request.out);
  auto all = outputs(request.out);
  if (file && request.picture) all.push_back(picture_file(request.out));
  std::vector<fs::path> single = file ? all : std::vector<fs::path>();
  if (!request.report.empty()) single.emplace_back(request.report);
  all.insert(all.end(), single.begin(), single.end());
  if (auto spared = spare_inputs(all, {request.input}); !spared) return spared;
  for (const auto& path : single)
    if (auto usable = file_free(path, request.overwrite); !usable) return usable;
  return file ? base::Result<void>() : prepare(request.out, request.overwrite);
}

auto write_out(const write::City& city, const std::string& report, const ExtrudeRequest& request,
               const base::Run& run) -> base::Result<void> {
  const fs::path out(request.out);
  std::vector<std::pair<fs::path, std::string>> files;
  if (!is_file(out)) {
    auto models = model_files(city);
    if (!models) return models.error();
    for (auto& [name, bytes] : *models) files.emplace_back(out / name, std::move(bytes));
    if (!report.empty()) files.emplace_back(out / "run.json", report);
  } else if (out.extension() == ".obj") {
    const auto library = fs::path(out).replace_extension(".mtl");
    auto models = write::obj(city, library.filename().string());
    if (!models) return models.error();
    files.emplace_back(library, std::move(models->mtl));
    files.emplace_back(out, std::move(models->obj));
  } else {
    auto bytes = out.extension() == ".glb" ? write::glb(city) : write::cityjson(city);
    if (!bytes) return bytes.error();
    files.emplace_back(out, std::move(*bytes));
  }
  if (!request.report.empty()) files.emplace_back(request.report, report);
  if (request.picture) {
    auto bytes = picture::png(pipeline::picture_of(city, {}, run));
    if (!bytes) return bytes.error();
    files.emplace_back(picture_file(out), std::move(*bytes));
  }
  std::vector<base::FileToWrite> all;
  for (const auto& [path, bytes] : files) all.push_back({path, bytes});
  return base::write_files(all, run.cancel);
}

auto holds_plans(const fs::path& path) -> bool {
  std::error_code status;
  if (!fs::is_regular_file(path, status)) return false;
  std::string head(1 << 16, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  const auto first = head.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  if (first == std::string::npos || head[first] != '{') return false;
  const auto has = [&](const char* word) { return head.find(word) != std::string::npos; };
  if (has("\"mansard-plan\"") || has("\"CityJSON\"")) return true;
  static constexpr std::array features{"\"Feature", "\"coordinates\"", "\"features\"", "\"Topology\"", "\"geometryType\""};
  return std::ranges::none_of(features, has);
}

auto extrude_verb(CLI::App& app, const base::Cancel& cancel) -> Verb {
  auto* verb = app.add_subcommand("extrude", "Footprints to solids without a mesh; or an edited plan raised again");
  auto request = std::make_shared<ExtrudeRequest>();
  verb->add_option("INPUT", request->input,
                   "Footprints (any OGR vector file), raised by their attributes or by --profile; or a plans.json")
      ->required()
      ->type_name("FOOTPRINTS|PLAN.json");
  verb->add_option("-o,--output", request->out, "A .city.json, .obj or .glb file, or a folder for all of them")
      ->required()
      ->type_name("OUT");
  verb->add_flag("--overwrite", request->overwrite, "Replace results that are there already");
  verb->add_flag("--picture", request->picture, "Also write a picture of the models");
  verb->add_option("--report", request->report, "Write the report (run.json) here too")->type_name("FILE");
  verb->add_option("-j,--jobs", request->jobs, "Threads; 0 for one per core. The result is the same at any number")
      ->check(CLI::Range(0, 1024));
  verb->add_flag("-q,--quiet", request->quiet, "No progress, no summary");
  verb->add_flag("-v,--verbose", request->verbose, "Name what was left out or fell back, building by building");
  verb->set_help_all_flag("--help-all", "Show this and every room's options");
  request->settings.add_to(*verb);
  return {verb, [request, &cancel] {
            base::limit_threads(request->jobs);
            return holds_plans(request->input) ? extrude_plans(*request, cancel) : extrude_footprints(*request, cancel);
          }};
}

}  // namespace mansard::cli
