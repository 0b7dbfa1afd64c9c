// `mansard explore EXPERIMENT MESH... FOOTPRINTS -o OUTDIR`: the experiments of the paper, with a report of each.
#include "lab/explore/explore.hpp"

#include <toml++/toml.h>
#include <algorithm>
#include <cstdio>
#include <memory>

#include "apps/cli/catalogue.hpp"
#include "apps/cli/exit.hpp"
#include "apps/cli/output.hpp"
#include "apps/cli/scan.hpp"
#include "apps/cli/sensitivity.hpp"
#include "apps/cli/verbs.hpp"
#include "mansard/base/files.hpp"
#include "mansard/base/text.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;

struct ExploreRequest {
  ScanRequest scan;
  std::string experiment, out, list, data;
  std::vector<std::string> grids, parameters;
  std::size_t most_runs = 100;
  double error_limit = 2.0;
  bool no_pictures = false;
};

auto bad_list(const ExploreRequest& request, const std::string& what) -> base::Diagnostic {
  return base::error("explore-list", what, request.list);
}

/// A path of the list: it starts at --data, or in the folder of the list.
auto path_from(const ExploreRequest& request, const std::string& path) -> fs::path {
  return (request.data.empty() ? fs::path(request.list).parent_path() : fs::path(request.data)) / path;
}

auto dataset_of(const ExploreRequest& request, const toml::table& table) -> base::Result<explore::Dataset> {
  explore::Dataset dataset;
  for (const auto& [key, node] : table) {
    const auto name = std::string(key.str());
    const auto* text = node.as_string();
    if (name == "name" && text != nullptr) {
      dataset.name = text->get();
    } else if (name == "place" && text != nullptr) {
      dataset.place = text->get();
    } else if (name == "footprints" && text != nullptr) {
      dataset.footprints = path_from(request, text->get());
    } else if (const auto* meshes = node.as_array(); name == "meshes" && meshes != nullptr) {
      for (const auto& mesh : *meshes) {
        if (mesh.as_string() == nullptr) return bad_list(request, "'meshes' is an array of paths; expected strings");
        dataset.meshes.push_back(path_from(request, mesh.as_string()->get()));
      }
    } else if (const auto* options = node.as_table(); name == "options" && options != nullptr) {
      for (const auto& [option, value] : *options) {
        if (value.as_string() == nullptr)
          return bad_list(request,
                          "the option '" + std::string(option.str()) + "' is not a string; put its value in quotes");
        dataset.options.emplace_back(option.str(), value.as_string()->get());
      }
    } else {
      return bad_list(request, "'" + name +
                                   "' is unknown, or of the wrong type; a [[dataset]] has name, place, meshes, "
                                   "footprints and options");
    }
  }
  if (dataset.name.empty() || dataset.meshes.empty() || dataset.footprints.empty())
    return bad_list(request, "a [[dataset]] has no name, no meshes or no footprints; add them");
  return dataset;
}

auto datasets_listed(const ExploreRequest& request) -> base::Result<std::vector<explore::Dataset>> {
  const auto text = base::read_file(request.list);
  if (!text) return text.failure();
  toml::table table;
  try {
    table = toml::parse(*text);
  } catch (const toml::parse_error& e) {
    return bad_list(request, std::string(e.description()) + " (line " + std::to_string(e.source().begin.line) + ")");
  }
  const auto* entries = table["dataset"].as_array();
  if (entries == nullptr || table.size() != 1)
    return bad_list(request, "expected [[dataset]] entries and nothing else");
  std::vector<explore::Dataset> datasets;
  for (const auto& entry : *entries) {
    if (entry.as_table() == nullptr) return bad_list(request, "write [[dataset]] above each entry");
    auto dataset = dataset_of(request, *entry.as_table());
    if (!dataset) return dataset.failure();
    if (std::ranges::find(datasets, dataset->name, &explore::Dataset::name) != datasets.end())
      return bad_list(request, "two datasets have the name '" + dataset->name + "'; give each its own");
    datasets.push_back(std::move(*dataset));
  }
  return datasets;
}

/// From the list, or the one of the command line, which takes its name from the folder of its footprints.
auto datasets_of(const ExploreRequest& request) -> base::Result<std::vector<explore::Dataset>> {
  const auto& inputs = request.scan.inputs;
  if (!request.list.empty()) {
    if (!inputs.empty()) return base::error("usage", "expected either --datasets or meshes and footprints, not both");
    return datasets_listed(request);
  }
  if (inputs.size() < 2)
    return base::error("usage", "expected one or more meshes, then the footprints; or --datasets LIST");
  if (auto order = check_order(request.scan); !order) return order.failure();
  const fs::path footprints = inputs.back();
  auto name = fs::absolute(footprints).parent_path().filename().string();
  if (name.empty()) name = footprints.stem().string();
  return std::vector<explore::Dataset>{{name, {inputs.begin(), inputs.end() - 1}, footprints, {}, {}}};
}

/// Not among the experiments that vary every axis with every other one.
constexpr auto sensitivity = "sensitivity";

auto study_of(const ExploreRequest& request, const std::vector<std::string>& words) -> base::Result<explore::Request> {
  const bool one_by_one = request.experiment == sensitivity;
  if (one_by_one && !request.grids.empty())
    return base::error("usage", "the experiment 'sensitivity' takes --parameters, not --grid");
  if (!one_by_one && !request.parameters.empty())
    return base::error("usage", "--parameters is for the experiment 'sensitivity'; use --grid");
  const auto experiment = one_by_one ? explore::Experiment::table : explore::experiment_of(request.experiment);
  if (!experiment) {
    auto known = explore::experiment_names();
    known.emplace_back(sensitivity);
    std::string all;
    for (const auto& name : known) all += (all.empty() ? "" : ", ") + name;
    return base::error(
        "usage",
        "unknown experiment; expected " + all + base::did_you_mean(base::nearest_word(request.experiment, known)),
        request.experiment);
  }
  explore::Request study;
  study.experiment = *experiment;
  if (auto applied = request.scan.settings.apply(study.options); !applied) return applied.failure();
  auto datasets = datasets_of(request);
  if (!datasets) return datasets.failure();
  study.datasets = std::move(*datasets);
  std::vector<explore::Axis> asked;
  for (const auto& grid : request.grids) {
    auto axis = explore::axis_of(grid);
    if (!axis) return axis.failure();
    asked.push_back(std::move(*axis));
  }
  auto axes = explore::axes_of(*experiment, asked);
  if (!axes) return axes.failure();
  study.axes = std::move(*axes);
  study.most_runs = request.most_runs;
  study.pictures = !request.no_pictures;
  study.error_limit = request.error_limit;
  study.command = words;
  study.command.front() = "mansard";  // wherever it is installed
  study.version = MANSARD_VERSION;
  return study;
}

auto check_outputs(const ExploreRequest& request, const explore::Request& study) -> base::Result<void> {
  std::vector<fs::path> inputs;
  if (!request.list.empty()) inputs.emplace_back(request.list);
  for (const auto& dataset : study.datasets) {
    inputs.insert(inputs.end(), dataset.meshes.begin(), dataset.meshes.end());
    inputs.push_back(dataset.footprints);
  }
  std::vector<fs::path> results;
  for (const auto* name : {"index.html", "results.json", "results.csv"})
    results.push_back(fs::path(request.out) / name);
  if (auto spared = spare_inputs(results, inputs); !spared) return spared;
  return prepare(request.out, request.scan.overwrite);
}

void summarise(const explore::Study& study, Progress& progress) {
  std::size_t failures = 0;
  for (const auto& row : study.rows) {
    if (!row.failure) continue;
    ++failures;
    progress.say(base::to_string(*row.failure));
  }
  progress.say(std::to_string(study.rows.size() - failures) + " of " + std::to_string(study.rows.size()) +
               " runs succeeded");
}

auto explore_scans(const ExploreRequest& request, const std::vector<std::string>& words, const base::Cancel& cancel)
    -> int {
  const auto study = study_of(request, words);
  if (!study) return give_up(study.errors());
  if (request.experiment == sensitivity)
    return explore_sensitivity(request.scan, *study, request.parameters, request.out, cancel);
  if (auto ready = check_outputs(request, *study); !ready) return give_up(ready.errors());
  Progress progress(request.scan.quiet);
  const auto run = start(request.scan, study->options.seed, cancel, progress);
  const auto result = explore::investigate(*study, run);
  if (!result) return give_up(result.errors());

  progress.show("write", request.out, 1);
  const auto named = explore::report(*result);
  const auto files = in_folder(request.out, named);
  const auto left = leftovers(request.out, "results.json", explore::is_picture);
  if (auto written = base::write_files(files, run.cancel); !written) return give_up(written.errors());
  remove_stale(left, files);
  summarise(*result, progress);
  std::printf("%s\n", (fs::path(request.out) / "index.html").c_str());
  const bool all = std::ranges::none_of(result->rows, [](const auto& row) { return row.failure.has_value(); });
  return all ? all_done : some_fell_back;
}

}  // namespace

auto explore_verb(CLI::App& app, std::vector<std::string> words, const base::Cancel& cancel) -> Verb {
  auto* verb = add_verb(app, "explore");
  auto request = std::make_shared<ExploreRequest>();
  std::string names;
  for (const auto& name : explore::experiment_names()) names += (names.empty() ? "" : ", ") + name;
  names += std::string(", ") + sensitivity;
  verb->add_option("EXPERIMENT", request->experiment, "The experiment: " + names)->required()->type_name("");
  add_to(*verb, request->scan, false);
  request->scan.words = words;
  verb->remove_option(verb->get_option("--report"));  // the report is what it writes
  verb->remove_option(verb->get_option("--verbose"));
  verb->add_option("-o,--output", request->out, "Output folder for the report")->required()->type_name("OUTDIR");
  verb->add_option("--grid", request->grids,
                   "Option with the values to run; may be given for several options, which are combined")
      ->type_name("KEY=A,B,C")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);
  verb->add_option("--parameters", request->parameters,
                   "Parameters that the experiment 'sensitivity' halves and doubles: module.name or module.*")
      ->type_name("NAME")
      ->delimiter(',')
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);
  verb->add_option("--datasets", request->list, "TOML list of datasets, in place of meshes and footprints")
      ->type_name("LIST");
  verb->add_option("--data", request->data,
                   "Folder that the paths of the list start in; without it, the folder of the list")
      ->type_name("DIR");
  verb->add_option("--most-runs", request->most_runs, "Maximum number of runs; more are refused")
      ->check(CLI::Range(1, 100000));
  verb->add_flag("--no-pictures", request->no_pictures, "Write plans, plots and numbers only");
  verb->add_option("--error-limit", request->error_limit,
                   "Both limits of the colour scale of the error maps, in metres")
      ->check(CLI::Range(0.01, 1000.0));
  return {verb, [request, words = std::move(words), &cancel] { return explore_scans(*request, words, cancel); }};
}

}  // namespace mansard::cli
