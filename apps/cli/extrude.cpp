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

auto check_outputs(const Request& request) -> base::Result<void> {
  if (auto spared = spare_inputs(outputs(request.out), {request.plan}); !spared) return spared;
  if (!is_file(request.out)) return prepare(request.out, request.overwrite);
  for (const auto& file : outputs(request.out))
    if (auto usable = file_free(file, request.overwrite); !usable) return usable;
  return {};
}

auto write_out(const write::City& city, const Request& request, const base::Cancel& cancel) -> base::Result<void> {
  const fs::path out(request.out);
  if (!is_file(out)) {
    auto files = model_files(city);
    return files ? base::write_files(in_folder(out, *files), &cancel) : files.error();
  }
  if (out.extension() == ".obj") {
    const auto library = fs::path(out).replace_extension(".mtl");
    const auto files = write::obj(city, library.filename().string());
    if (!files) return files.error();
    return base::write_files({{library, files->mtl}, {out, files->obj}}, &cancel);
  }
  const auto bytes = out.extension() == ".glb" ? write::glb(city) : write::cityjson(city);
  return bytes ? base::write_files({{out, *bytes}}, &cancel) : bytes.error();
}

auto extrude(const Request& request, const base::Cancel& cancel) -> int {
  pipeline::Options options;
  if (auto applied = request.settings.apply(options); !applied) return give_up(applied.error());
  auto city = write::read_plans(request.plan);
  if (!city) return give_up(city.error());
  if (auto ready = check_outputs(request); !ready) return give_up(ready.error());
  city->made_by.version = MANSARD_VERSION;
  const auto fell_back = raise_all(*city, options, cancel);
  if (!fell_back) return give_up(fell_back.error());
  if (auto written = write_out(*city, request, cancel); !written) return give_up(written.error());
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
