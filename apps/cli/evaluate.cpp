// `mansard evaluate MODEL MESH… [--truth T] [-o REPORT]`: how good a model is, ours or another's.
#include <cstdio>
#include <memory>
#include <optional>

#include "apps/cli/catalogue.hpp"
#include "apps/cli/exit.hpp"
#include "apps/cli/formats.hpp"
#include "apps/cli/output.hpp"
#include "apps/cli/scan.hpp"
#include "apps/cli/shell_word.hpp"
#include "apps/cli/verbs.hpp"
#include "mansard/formats/scan.hpp"
#include "mansard/picture/picture.hpp"
#include "mansard/pipeline/evaluation.hpp"
#include "mansard/report/evaluation.hpp"
#include "mansard/report/plane_plans.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;
using ReportBytes = std::vector<std::pair<std::string, std::string>>;

struct EvaluateRequest : Common {
  std::vector<std::string> inputs;  // the model, then the meshes
  std::string truth, footprints, lod, out;
  double error_limit = 2.0;
  std::optional<std::size_t> plane_plans;  // buildings in planes.png
};

constexpr std::size_t usual_plane_plans = 24;

/// What a folder gets, with and without a truth.
auto report_names(const EvaluateRequest& request) -> std::vector<std::string> {
  std::vector<std::string> names{"report.json", "error.png", "error.tif"};
  if (!request.truth.empty()) names.emplace_back("planes.png");
  return names;
}

auto is_file(const std::string& out) -> bool { return fs::path(out).extension() == ".json"; }

auto check_outputs(const EvaluateRequest& request) -> base::Result<void> {
  if (request.out.empty()) return {};
  std::vector<fs::path> results;
  if (is_file(request.out)) results.emplace_back(request.out);
  else
    for (const auto& name : report_names(request)) results.push_back(fs::path(request.out) / name);
  std::vector<fs::path> inputs(request.inputs.begin(), request.inputs.end());
  for (const auto& extra : {request.truth, request.footprints})
    if (!extra.empty()) inputs.emplace_back(extra);
  if (auto spared = spare_inputs(results, inputs); !spared) return spared;
  return is_file(request.out) ? file_free(request.out, request.overwrite) : prepare(request.out, request.overwrite);
}

auto check_plane_plans(const EvaluateRequest& request) -> base::Result<void> {
  if (!request.plane_plans) return {};
  if (request.truth.empty())
    return base::error("usage", "planes are compared with those of a truth; name it with --truth", "--plane-plans");
  if (request.out.empty() || is_file(request.out))
    return base::error("usage", "planes.png is written into a folder; name the folder with -o", "--plane-plans");
  return {};
}

auto files_of(const EvaluateRequest& request) -> pipeline::EvaluationFiles {
  return {request.inputs.front(),
          {request.inputs.begin() + 1, request.inputs.end()},
          request.truth,
          request.footprints,
          request.lod};
}

/// The report, and in a folder the error maps too, in a colour scale that is the same for every model and as numbers,
/// and with a truth the planes of both.
auto write_all(const EvaluateRequest& request, const report::Evaluation& result, const report::EvaluationInput& input,
               const std::string& report, const base::Cancel& cancel) -> base::Result<void> {
  if (is_file(request.out)) return base::write_files({{request.out, report}}, &cancel);
  ReportBytes files{{"report.json", report}};
  const auto& map = result.map;
  auto png =
      picture::png(picture::error_map(map.difference, map.columns, map.rows, request.error_limit, "model - mesh, m"));
  if (!png) return png.failure();
  auto tiff = formats::geotiff({map.origin, map.grid, map.columns, map.rows, map.difference}, input.scene.frame);
  if (!tiff) return tiff.failure();
  files.emplace_back("error.png", std::move(*png));
  files.emplace_back("error.tif", std::move(*tiff));
  if (result.truth) {
    auto planes = picture::png(report::plane_plans(result, input, request.plane_plans.value_or(usual_plane_plans)));
    if (!planes) return planes.failure();
    files.emplace_back("planes.png", std::move(*planes));
  }
  const auto left = leftovers(request.out, "report.json", [](const std::string& name) { return name == "planes.png"; });
  const auto all = in_folder(request.out, files);
  if (auto written = base::write_files(all, &cancel); !written) return written;
  remove_stale(left, all);
  return {};
}

auto evaluate(const EvaluateRequest& request, const base::Cancel& cancel) -> int {
  if (request.inputs.size() < 2) return give_up(base::error("usage", "expected a model, then one or more meshes"));
  if (auto order =
          check_model_place(request.inputs.front(), request.inputs.back(),
                            "mansard evaluate " + quoted(request.inputs.back()) + " " + quoted(request.inputs.front()));
      !order)
    return give_up(order.errors());
  pipeline::Options options;
  if (auto applied = request.settings.apply(options); !applied) return give_up(applied.errors());
  if (auto plans = check_plane_plans(request); !plans) return give_up(plans.errors());
  if (auto ready = check_outputs(request); !ready) return give_up(ready.errors());
  Progress progress(request.quiet);
  const auto run = start(request, options.seed, cancel, progress);

  const auto input = pipeline::read_evaluation(files_of(request), options.ingest, run);
  if (!input) return give_up(input.errors());
  for (const auto& warning : input->scene.warnings) progress.say(base::to_string(warning));
  const auto result = pipeline::evaluate_model(*input, options, run);
  if (!result) return give_up(result.errors());
  for (const auto& warning : result->warnings) progress.say(base::to_string(warning));
  if (!request.out.empty()) {
    const auto report = report::evaluation_json(*result, *input);
    if (auto written = write_all(request, *result, *input, report, cancel); !written) return give_up(written.errors());
  }
  std::fputs(report::evaluation_table(*result, *input).c_str(), stdout);
  if (!request.out.empty()) std::printf("%s\n", request.out.c_str());
  return all_done;
}

}  // namespace

auto evaluate_verb(CLI::App& app, const base::Cancel& cancel) -> Verb {
  auto* verb = add_verb(app, "evaluate");
  auto request = std::make_shared<EvaluateRequest>();
  verb->add_option("INPUTS", request->inputs,
                   "The model: " + readable_formats().models + ". Then the meshes: " + readable_formats().meshes)
      ->type_name("MODEL MESH...");
  verb->add_option("--truth", request->truth, "Model that is known to be right, in any format of a model")
      ->type_name("MODEL");
  verb->add_option("--footprints", request->footprints,
                   "Footprints to measure over; without it, those of the true model or of the model")
      ->type_name("FILE");
  verb->add_option("--lod", request->lod, "LoD to read of both models; without it, the highest of each object");
  verb->add_option("-o,--output", request->out, "Report (.json), or a folder for the report and the pictures")
      ->type_name("REPORT");
  verb->add_option("--error-limit", request->error_limit, "Both limits of the colour scale of the error map, in metres")
      ->check(CLI::Range(0.01, 1000.0));
  verb->add_option("--plane-plans", request->plane_plans,
                   "Number of buildings in planes.png, those with most wrong roof planes first; default 24")
      ->check(CLI::Range(std::size_t{1}, std::size_t{120}))
      ->type_name("N");
  add_common(*verb, *request, "warnings");
  return {verb, [request, &cancel] { return evaluate(*request, cancel); }};
}

}  // namespace mansard::cli
