// `mansard doctor [MESH… FOOTPRINTS]`: what this machine lacks, and how inputs fit together.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/cli/catalogue.hpp"
#include "apps/cli/checks.hpp"
#include "apps/cli/exit.hpp"
#include "apps/cli/formats.hpp"
#include "apps/cli/scan.hpp"
#include "apps/cli/shell_word.hpp"
#include "apps/cli/verbs.hpp"
#include "mansard/accuracy/accuracy.hpp"
#include "mansard/pipeline/placing.hpp"

namespace mansard::cli {
namespace {

using Json = nlohmann::ordered_json;

struct DoctorRequest : Common {
  std::vector<std::string> inputs;
  bool json = false;
};

/// `more` replaces what was typed of the same options.
auto command_of(const pipeline::InputPaths& paths, const Settings& settings, const std::string& more) -> std::string {
  std::vector<std::string> replaced;
  if (more.find("--crs") != std::string::npos) replaced.emplace_back("ingest.crs");
  if (more.find("--mesh-offset") != std::string::npos) replaced.emplace_back("ingest.mesh_offset");
  std::string command = "mansard reconstruct";
  for (const auto& mesh : paths.meshes) command += " " + quoted(mesh.string());
  return command + " " + quoted(paths.footprints.string()) + settings.typed(replaced) +
         (more.empty() ? "" : " " + more) + " -o models";
}

auto inputs_of(const DoctorRequest& request, const pipeline::Options& options, const base::Run& run)
    -> base::Result<std::vector<Finding>> {
  std::vector<Finding> all;
  if (request.inputs.size() == 1) {
    const bool footprints = pipeline::is_footprints_name(request.inputs.front());
    all.push_back(
        {Found::note, "inputs", footprints ? "these are footprints; there is no mesh" : "there are no footprints",
         footprints ? "mansard extrude " + quoted(request.inputs.front()) + " -o models"
                    : "mansard reconstruct " + quoted(request.inputs.front()) + " --derive-footprints -o models"});
    return all;
  }
  const auto [paths, wrong_order] = pipeline::in_order({request.inputs.begin(), request.inputs.end()});
  if (wrong_order)
    all.push_back(
        {Found::problem, "order", "the footprints come before a mesh; meshes come first, the footprints last", ""});
  const auto placing = pipeline::find_placing(paths, options, run);
  if (!placing) {
    if (placing.error().code == "cancelled") return placing.failure();
    for (const auto& why : placing.errors()) all.push_back({Found::problem, "inputs", base::to_string(why), ""});
    return all;
  }
  if (!*placing) {
    // What makes it so may be known: another axis, another unit.
    const auto scan = pipeline::accuracy_of_scan(paths, options, run);
    if (!scan && scan.error().code == "cancelled") return scan.failure();
    const auto findings = scan ? scan->findings : scan.errors();
    const bool known = std::ranges::any_of(findings, [](const auto& why) {
      return why.code.starts_with("scan-") || !why.message.ends_with("give --mesh-offset or --crs");
    });
    for (const auto& why : findings)
      if (known) all.push_back({Found::problem, "scan", base::to_string(why), ""});
    if (known) return all;
    all.push_back({Found::problem, "place",
                   "mesh and footprints do not match, and neither a CRS nor an offset of the mesh was found that makes "
                   "them: they seem to be of different places, or nothing in the mesh rises above its ground",
                   "compare the extents: mansard info"});
    return all;
  }
  const auto more = pipeline::options_in_words(**placing, options);
  all.push_back({more.empty() && !wrong_order ? Found::fine : Found::problem, "place",
                 (more.empty() ? "mesh and footprints match: " : "mesh and footprints match with " + more + ": ") +
                     pipeline::reason_in_words(**placing),
                 command_of(paths, request.settings, more)});
  if (more.empty()) {
    const auto scan = pipeline::accuracy_of_scan(paths, options, run);
    if (!scan && scan.error().code == "cancelled") return scan.failure();
    if (scan) {
      all.push_back({Found::fine, "accuracy", accuracy::in_a_sentence(scan->accuracy), ""});
      for (const auto& why : scan->findings) all.push_back({Found::note, "scan", base::to_string(why), ""});
    } else {
      for (const auto& why : scan.errors()) all.push_back({Found::problem, "accuracy", base::to_string(why), ""});
    }
  }
  return all;
}

auto doctor(const DoctorRequest& request, const base::Cancel& cancel) -> int {
  pipeline::Options options;
  if (auto applied = request.settings.apply(options); !applied) return give_up(applied.errors());
  auto all = machine();
  for (auto& finding : libraries()) all.push_back(std::move(finding));
  if (!request.inputs.empty()) {
    Progress progress(request.quiet);
    auto of_inputs = inputs_of(request, options, start(request, options.seed, cancel, progress));
    if (!of_inputs) return give_up(of_inputs.errors());
    for (auto& finding : *of_inputs) all.push_back(std::move(finding));
  }
  Json json = Json::array();
  std::string text = "mansard " MANSARD_VERSION "\n";
  for (const auto& finding : all) {
    json.push_back({{"found", word_of(finding.found)},
                    {"subject", finding.subject},
                    {"what", finding.what},
                    {"remedy", finding.remedy}});
    text += line_of(finding);
  }
  std::fputs(request.json ? (json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n").c_str() : text.c_str(),
             stdout);
  const bool problems = std::ranges::any_of(all, [](const Finding& f) { return f.found == Found::problem; });
  return problems ? some_fell_back : all_done;
}

}  // namespace

auto doctor_verb(CLI::App& app, const base::Cancel& cancel) -> Verb {
  auto* verb = add_verb(app, "doctor");
  auto request = std::make_shared<DoctorRequest>();
  verb->add_option("INPUTS", request->inputs,
                   "Meshes, or point clouds: " + readable_formats().meshes +
                       ". Then the footprints: " + readable_formats().footprints)
      ->type_name("MESH... FOOTPRINTS");
  verb->add_flag("--json", request->json, "Print JSON");
  add_jobs(*verb, request->jobs);
  verb->add_flag("-q,--quiet", request->quiet, "Print no progress");
  request->settings.add_to(*verb);
  return {verb, [request, &cancel] { return doctor(*request, cancel); }};
}

}  // namespace mansard::cli
