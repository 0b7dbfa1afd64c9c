// `mansard info FILE…`: what a file is, before anything is done with it.
#include "apps/cli/info.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>

#include "apps/cli/exit.hpp"
#include "apps/cli/formats.hpp"
#include "apps/cli/verbs.hpp"
#include "mansard/base/text.hpp"
#include "mansard/pipeline/stored.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;

struct Request {
  std::vector<std::string> files;
  bool json = false, verbose = false;
  std::size_t jobs = 0;
};

auto info_of(const fs::path& path, const Request& request, const base::Run& run) -> base::Result<Json> {
  auto reader = open_city(path);
  if (reader) return info_of_city(path, **reader, request.verbose, run);
  const auto& why = reader.error();
  // A database or a file in an archive is told by who reads it; what mansard wrote and is broken, by the reader.
  const bool broken = why.code.starts_with("write-") && !pipeline::is_foreign(why);
  // Of a folder the reader says no more than that it is no tileset.
  std::error_code status;
  const bool other_folder = fs::is_directory(path, status) && !fs::exists(path / "tileset.json", status);
  if (other_folder) return info_of_other(path, why, run);
  if (broken || (why.code == "file-missing" && path.string().find(':') == std::string::npos)) return why;
  return info_of_other(path, why, run);
}

auto info(const Request& request, const base::Cancel& cancel) -> int {
  base::limit_threads(request.jobs);
  base::Run run;
  run.cancel = &cancel;
  int exit = all_done;
  Json all = Json::array();
  for (const auto& file : request.files) {
    auto told = info_of(file, request, run);
    if (!told) {
      exit = give_up(told.error());
      if (exit == cancelled) return exit;
    } else if (request.json) {
      all.push_back(std::move(*told));
    } else {
      std::fputs(info_text(*told).c_str(), stdout);
    }
  }
  if (request.json) std::puts(all.dump(1, ' ', false, Json::error_handler_t::replace).c_str());
  return exit;
}

}  // namespace

auto info_verb(CLI::App& app, const base::Cancel& cancel) -> Verb {
  auto* verb = app.add_subcommand("info", "Say what files are: models, meshes, footprints, tilesets, rasters");
  auto request = std::make_shared<Request>();
  verb->add_option("FILES", request->files, "Whatever mansard reads or writes")->required()->type_name("FILE…");
  verb->add_flag("--json", request->json, "As JSON: an array with an object per file");
  verb->add_flag("-v,--verbose", request->verbose,
                 "Every option that models were made with, those at their defaults too");
  verb->add_option("-j,--jobs", request->jobs, "Threads; 0 for one per core. The result is the same at any number")
      ->check(CLI::Range(0, 1024));
  return {verb, [request, &cancel] { return info(*request, cancel); }};
}

}  // namespace mansard::cli
