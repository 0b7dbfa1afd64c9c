// `mansard compare OLD NEW [-o OUT]`: what has changed between two states of a city.
#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>

#include "apps/cli/catalogue.hpp"
#include "apps/cli/exit.hpp"
#include "apps/cli/formats.hpp"
#include "apps/cli/output.hpp"
#include "apps/cli/scan.hpp"
#include "apps/cli/verbs.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/foreign.hpp"
#include "mansard/pipeline/states.hpp"
#include "mansard/report/changes.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;
using Named = std::vector<std::pair<std::string, std::string>>;

struct CompareRequest : Common {
  std::string old, now, out, formats;
  std::vector<std::string> old_scan, new_scan;
  bool no_scans = false, json = false;
};

/// What a folder gets, beside models.
constexpr std::array result_names{"changes.json", "changes.csv", "changes.gpkg", "changes.svg"};

auto menu_of(compare::Options& compare, pipeline::Options& pipeline) -> Menu {
  Menu menu;
  menu.lists.push_back(compare::option_list(compare));
  for (auto& list : pipeline::option_lists(pipeline)) menu.lists.push_back(std::move(list));
  return menu;
}

auto is_one_file(const std::string& out) -> bool {
  const auto extension = base::lower(fs::path(out).extension().string());
  return extension == ".json" || extension == ".csv" || extension == ".gpkg" || extension == ".svg";
}

auto targets_of(const CompareRequest& request) -> base::Result<std::vector<Target>> {
  if (request.formats.empty()) return std::vector<Target>();
  if (request.out.empty() || is_one_file(request.out))
    return base::error("usage", "models are written into a folder; name the folder with -o", "--formats");
  auto formats = formats_in(request.formats);
  if (!formats) return formats.failure();
  return targets_in(request.out, *formats);
}

auto check_outputs(const CompareRequest& request, const std::vector<Target>& targets) -> base::Result<void> {
  if (request.out.empty()) return {};
  std::vector<fs::path> results;
  if (is_one_file(request.out)) results.emplace_back(request.out);
  else
    for (const auto* name : result_names) results.push_back(fs::path(request.out) / name);
  for (const auto& target : targets)
    for (const auto& place : places_of(target)) results.push_back(place);
  std::vector<fs::path> inputs{request.old, request.now};
  inputs.insert(inputs.end(), request.old_scan.begin(), request.old_scan.end());
  inputs.insert(inputs.end(), request.new_scan.begin(), request.new_scan.end());
  if (auto spared = spare_inputs(results, inputs); !spared) return spared;
  return is_one_file(request.out) ? file_free(request.out, request.overwrite) : prepare(request.out, request.overwrite);
}

auto bytes_for(const std::string& name, const report::Changes& changes) -> base::Result<std::string> {
  const auto extension = base::lower(fs::path(name).extension().string());
  if (extension == ".csv") return report::changes_csv(changes);
  if (extension == ".svg") return report::changes_svg(changes);
  if (extension == ".gpkg") return formats::geopackage(report::changes_layers(changes), changes.frame);
  return report::changes_json(changes);
}

/// The new models with what has changed as their attributes.
auto write_changed(model::City models, const report::Changes& changes, const std::vector<Target>& targets,
                   const formats::WriteOptions& options, const base::Run& run, Progress& progress)
    -> base::Result<void> {
  if (targets.empty()) return {};
  std::map<std::string, const compare::Change*> of;
  for (const auto& change : changes.found.changes)
    if (!change.now.empty()) of[changes.now.buildings[change.now.front()].id] = &change;
  for (auto& building : models.buildings) {
    const auto found = of.find(building.id);
    if (found == of.end()) continue;
    for (auto& [name, value] : report::change_attributes(changes, *found->second)) {
      std::erase_if(building.attributes, [&](const auto& own) { return own.first == name; });
      if (!std::holds_alternative<std::monostate>(value)) building.attributes.emplace_back(name, std::move(value));
    }
  }
  base::Outputs outputs;
  const auto written = write_models(models, targets, options, outputs);
  if (!written) return written.failure();
  for (const auto& warning : written->warnings) progress.say(base::to_string(warning));
  if (auto committed = outputs.commit(run.cancel); !committed) return committed;
  if (written->missing.empty()) return {};
  return base::Failure{reasons_of(written->missing, targets)};
}

auto write_results(const CompareRequest& request, const report::Changes& changes, const base::Run& run)
    -> base::Result<void> {
  Named files;
  if (is_one_file(request.out)) {
    auto bytes = bytes_for(request.out, changes);
    if (!bytes) return bytes.failure();
    return base::write_files({{request.out, *bytes}}, run.cancel);
  }
  for (const auto* name : result_names) {
    auto bytes = bytes_for(name, changes);
    if (!bytes) return bytes.failure();
    files.emplace_back(name, std::move(*bytes));
  }
  const auto all = in_folder(request.out, files);
  return base::write_files(all, run.cancel);
}

/// Of another producer only formats without plans can be written.
auto check_targets(const pipeline::StateFiles& now, const std::vector<Target>& targets) -> base::Result<void> {
  if (targets.empty()) return {};
  if (!now.city)
    return base::error("usage", "models of this format cannot be written again; leave --formats out",
                       now.models.string());
  if (now.own) return {};
  for (const auto& target : targets)
    if (!formats::takes_foreign(target.format))
      return base::error("usage", "this format needs plans, which models of other producers do not have",
                         target.path.string());
  return {};
}

auto compare_states(const CompareRequest& request, const base::Cancel& cancel) -> int {
  const auto targets = targets_of(request);
  if (!targets) return give_up(targets.errors());
  pipeline::Options options;
  compare::Options asked;
  if (auto applied = request.settings.apply(menu_of(asked, options)); !applied) return give_up(applied.errors());
  if (auto ready = check_outputs(request, *targets); !ready) return give_up(ready.errors());
  Progress progress(request.quiet);
  const auto run = start(request, options.seed, cancel, progress);

  const auto read = [&](const std::string& path, const std::vector<std::string>& scan, bool keep_city) {
    progress.show("ingest", path, 0);
    pipeline::StateOptions wanted{{scan.begin(), scan.end()}, !request.no_scans, keep_city};
    auto state = pipeline::read_state(path, wanted, options, run);
    if (state)
      for (const auto& warning : state->warnings) progress.say(base::to_string(warning));
    return state;
  };
  auto old = read(request.old, request.old_scan, false);
  if (!old) return give_up(old.errors());
  auto now = read(request.now, request.new_scan, !targets->empty());
  if (!now) return give_up(now.errors());
  if (auto can = check_targets(*now, *targets); !can) return give_up(can.errors());
  const auto found = pipeline::changes_between(*old, *now, asked, run);
  if (!found) return give_up(found.errors());
  const auto& changes = *found;
  if (!request.out.empty()) {
    if (auto written = write_results(request, changes, run); !written) return give_up(written.errors());
    if (now->city)
      if (auto written = write_changed(std::move(*now->city), changes, *targets, options.write, run, progress);
          !written)
        return give_up(written.errors());
  }
  std::fputs(request.json ? report::changes_json(changes).c_str() : report::changes_summary(changes).c_str(), stdout);
  if (!request.out.empty() && !request.json) std::printf("%s\n", request.out.c_str());
  return all_done;
}

}  // namespace

auto compare_verb(CLI::App& app, const base::Cancel& cancel) -> Verb {
  auto* verb = add_verb(app, "compare");
  auto request = std::make_shared<CompareRequest>();
  const std::string state =
      "a folder of 'mansard reconstruct', models (" + readable_formats().models + "), or footprints with heights";
  verb->add_option("OLD", request->old, "The old state: " + state)->required()->type_name("OLD");
  verb->add_option("NEW", request->now, "The new state: as the old one")->required()->type_name("NEW");
  verb->add_option("-o,--output", request->out,
                   "Output folder, or one file: a table (.csv), a layer (.gpkg), a map (.svg) or a report (.json)")
      ->type_name("OUT");
  verb->add_option("--formats", request->formats,
                   "Also write the new models, with what has changed as attributes: a list of formats, or 'all'")
      ->type_name("LIST");
  verb->add_option("--old-scan", request->old_scan,
                   "Scan that the old models were made from; without it, that of the run where it is still there")
      ->type_name("FILE...");
  verb->add_option("--new-scan", request->new_scan,
                   "Scan that the new models were made from; without it, that of the run where it is still there")
      ->type_name("FILE...");
  verb->add_flag("--no-scans", request->no_scans, "Compare models alone, without the scans of the runs");
  verb->add_flag("--json", request->json, "Print the report (changes.json) instead of a summary");
  compare::Options compare;
  pipeline::Options options;
  add_common(*verb, *request, "warnings", menu_of(compare, options));
  return {verb, [request, &cancel] { return compare_states(*request, cancel); }};
}

}  // namespace mansard::cli
