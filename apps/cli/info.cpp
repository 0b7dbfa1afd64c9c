// `mansard info FILE…`: what a file is, before anything is done with it.
#include "apps/cli/info.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>

#include "apps/cli/catalogue.hpp"
#include "apps/cli/exit.hpp"
#include "apps/cli/formats.hpp"
#include "apps/cli/scan.hpp"
#include "apps/cli/verbs.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/drivers.hpp"
#include "mansard/pipeline/stored.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;

struct InfoRequest {
  std::vector<std::string> files;
  bool json = false, verbose = false;
  std::size_t jobs = 0;
  Settings settings;
};

auto info_of(const fs::path& path, const InfoRequest& request, const cloud::ClassMap& classes, const base::Run& run)
    -> base::Result<Json> {
  // A CityJSON of terrain alone has no models for a reader of models.
  const auto extension = formats::extension_of(path);
  if (extension.ends_with("json") || extension.ends_with("jsonl"))
    if (const auto terrain = formats::terrain_info(path); terrain && terrain->others == 0)
      return info_of_terrain(path, *terrain, request.verbose);
  // What is beside an OBJ is described with it.
  for (const std::string_view beside : {".plans.jsonl", ".mtl"})
    if (const auto name = path.filename().string(); name.ends_with(beside)) {
      const auto obj = path.parent_path() / (name.substr(0, name.size() - beside.size()) + ".obj");
      std::error_code status;
      if (fs::is_regular_file(obj, status)) return info_of(obj, request, classes, run);
    }
  auto reader = open_city(path);
  if (reader) return info_of_city(path, **reader, request.verbose, run);
  const auto& why = reader.error();
  // A database or a file in an archive is reported by what reads it; a broken file of mansard by its reader.
  const bool broken = why.code.starts_with("write-") && !pipeline::is_foreign(why);
  // Of a folder the reader only reports that it is not a tileset.
  std::error_code status;
  const bool other_folder = fs::is_directory(path, status) && !fs::exists(path / "tileset.json", status);
  if (other_folder) return info_of_other(path, why, request.verbose, classes, run);
  if (broken || (why.code == "file-missing" && path.string().find(':') == std::string::npos)) return why;
  return info_of_other(path, why, request.verbose, classes, run);
}

auto info(const InfoRequest& request, const base::Cancel& cancel) -> int {
  pipeline::Options options;
  if (auto applied = request.settings.apply(options); !applied) return give_up(applied.errors());
  const auto classes = cloud::class_map(options.ingest.cloud);
  if (!classes) return give_up(classes.errors());
  base::limit_threads(request.jobs);
  base::Run run;
  run.cancel = &cancel;
  int exit = all_done;
  Json all = Json::array();
  for (const auto& file : request.files) {
    auto described = info_of(file, request, *classes, run);
    if (!described) {
      exit = give_up(described.errors());
      if (exit == cancelled) return exit;
    } else if (request.json) {
      all.push_back(std::move(*described));
    } else {
      std::fputs(info_text(*described).c_str(), stdout);
    }
  }
  if (request.json) std::puts(all.dump(1, ' ', false, Json::error_handler_t::replace).c_str());
  return exit;
}

}  // namespace

auto info_verb(CLI::App& app, const base::Cancel& cancel) -> Verb {
  auto* verb = add_verb(app, "info");
  auto request = std::make_shared<InfoRequest>();
  verb->add_option("FILES", request->files,
                   "Models: " + readable_formats().models + ", STL. Meshes: " + readable_formats().meshes +
                       ". Footprints: " + readable_formats().footprints)
      ->required()
      ->type_name("FILE...");
  verb->add_flag("--json", request->json, "Print JSON: an array with one object for each file");
  verb->add_flag("-v,--verbose", request->verbose,
                 "Also print the options that models were made with where they have their defaults");
  add_jobs(*verb, request->jobs);
  request->settings.add_to(*verb);
  return {verb, [request, &cancel] { return info(*request, cancel); }};
}

}  // namespace mansard::cli
