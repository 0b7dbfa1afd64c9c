// `mansard extrude PLAN.json -o OUT`: plan and profiles to solids again.
#include <cstdio>
#include <memory>

#include "apps/cli/exit.hpp"
#include "apps/cli/output.hpp"
#include "apps/cli/settings.hpp"
#include "apps/cli/verbs.hpp"
#include "mansard/base/files.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;

struct Request {
  std::string plan, out;
  bool overwrite = false;
  Settings settings;
};

/// Raises every plan of the file; the count of those that fell back.
auto raise_all(write::City& city, const pipeline::Options& options, const base::Cancel& cancel)
    -> base::Result<std::size_t> {
  base::Run run;
  run.cancel = &cancel;
  std::vector<extrude::Solid> solids;
  std::size_t fell_back = 0;
  for (auto& building : city.buildings)
    for (auto& part : building.parts) {
      if (run.cancelled()) return base::error("cancelled", "stopped on request; nothing was written");
      auto raised = pipeline::raise_part(part.plan, options, run);
      if (!raised) {
        auto why = raised.error();
        why.subject = part.id;
        return why;
      }
      if (raised->outcome != extrude::Outcome::full) {
        ++fell_back;
        for (auto warning : raised->warnings) {
          warning.subject = part.id;
          std::fprintf(stderr, "mansard: %s\n", base::to_string(warning).c_str());
        }
      }
      solids.push_back(std::move(raised->solid));
    }
  auto labelled = label::classify(std::move(solids), options.label, run);
  std::size_t next = 0;
  for (auto& building : city.buildings)
    for (auto& part : building.parts) part.model = std::move(labelled[next++]);
  return fell_back;
}

/// One file when OUT names one by its ending, all formats in a folder otherwise.
auto write_out(const write::City& city, const Request& request) -> base::Result<void> {
  const fs::path out(request.out);
  const std::string name = out.filename().string();
  const auto single = name.ends_with(".json") || out.extension() == ".obj" || out.extension() == ".glb";
  if (!single) {
    if (auto ready = prepare(out, request.overwrite); !ready) return ready;
    auto files = model_files(city);
    if (!files) return files.error();
    for (const auto& [file, bytes] : *files)
      if (auto written = base::write_file(out / file, bytes); !written) return written;
    return {};
  }
  if (fs::exists(out) && !request.overwrite)
    return base::error("output-exists", "this file is there already; choose another, or say --overwrite", out.string());
  if (out.extension() == ".glb") {
    const auto bytes = write::glb(city);
    return bytes ? base::write_file(out, *bytes) : bytes.error();
  }
  if (out.extension() == ".obj") {
    auto library = out;
    library.replace_extension(".mtl");
    const auto files = write::obj(city, library.filename().string());
    if (!files) return files.error();
    if (auto written = base::write_file(library, files->mtl); !written) return written;
    return base::write_file(out, files->obj);
  }
  const auto text = write::cityjson(city);
  return text ? base::write_file(out, *text) : text.error();
}

auto extrude(const Request& request, const base::Cancel& cancel) -> int {
  pipeline::Options options;
  if (auto applied = request.settings.apply(options); !applied) return give_up(applied.error());
  auto city = write::read_plans(request.plan);
  if (!city) return give_up(city.error());
  city->made_by.version = MANSARD_VERSION;
  const auto fell_back = raise_all(*city, options, cancel);
  if (!fell_back) return give_up(fell_back.error());
  if (auto written = write_out(*city, request); !written) return give_up(written.error());
  std::printf("%s\n", request.out.c_str());
  return *fell_back == 0 ? all_done : some_fell_back;
}

}  // namespace

auto extrude_verb(CLI::App& app, const base::Cancel& cancel) -> Verb {
  auto* verb = app.add_subcommand("extrude", "Plan and profiles to solids: an edited building raised again");
  auto request = std::make_shared<Request>();
  verb->add_option("PLAN", request->plan, "A plans.json")->required()->type_name("PLAN.json");
  verb->add_option("-o,--output", request->out, "A .city.json, .obj or .glb file, or a folder for all of them")
      ->required()
      ->type_name("OUT");
  verb->add_flag("--overwrite", request->overwrite, "Replace results that are there already");
  verb->set_help_all_flag("--help-all", "Show this and every room's options");
  request->settings.add_to(*verb);
  return {verb, [request, &cancel] { return extrude(*request, cancel); }};
}

}  // namespace mansard::cli
