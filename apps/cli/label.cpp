// `mansard label MESH… MODEL -o MESH2`: a scan's triangles as wall, roof, ground or other.
#include <algorithm>
#include <cstdio>
#include <memory>

#include "apps/cli/exit.hpp"
#include "apps/cli/output.hpp"
#include "apps/cli/progress.hpp"
#include "apps/cli/settings.hpp"
#include "apps/cli/verbs.hpp"
#include "mansard/base/text.hpp"
#include "mansard/label/scan.hpp"
#include "mansard/pipeline/evaluation.hpp"
#include "mansard/write/scan.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;
using Classes = std::vector<ingest::SurfaceClass>;

struct Request {
  std::vector<std::string> inputs;  // the meshes, then the model
  std::string truth_mesh, lod, out;
  bool overwrite = false, quiet = false;
  std::size_t jobs = 0;
  label::ScanOptions scan;
  Settings settings;
};

auto check_outputs(const Request& request) -> base::Result<void> {
  const auto ending = fs::path(request.out).extension();
  if (ending != ".ply" && ending != ".glb")
    return base::error("usage", "the output is a mesh; give a name that ends in .ply or .glb", request.out);
  std::vector<fs::path> inputs(request.inputs.begin(), request.inputs.end());
  if (!request.truth_mesh.empty()) inputs.emplace_back(request.truth_mesh);
  if (auto spared = spare_inputs({request.out}, inputs); !spared) return spared;
  return file_free(request.out, request.overwrite);
}

struct Input {
  ingest::ModelSurface model;
  ingest::Frame frame;
  ingest::ScannedMesh mesh;
  Classes truth;  ///< per triangle of the mesh; empty for none
};

auto truth_of(const Request& request, const Input& input, const ingest::Options& options, const base::Run& run)
    -> base::Result<Classes> {
  if (request.truth_mesh.empty()) return Classes();
  auto truth = ingest::read_mesh({request.truth_mesh}, input.frame, options, run);
  if (!truth) return truth.error();
  if (truth->classes.empty())
    return base::error("usage", "its faces have no class; give a PLY file with the face property 'class'",
                       request.truth_mesh);
  if (auto met =
          ingest::check_overlap(input.mesh.mesh, truth->mesh, {"mesh", "true mesh"}, input.frame, request.truth_mesh);
      !met)
    return met.error();
  return label::classes_from(input.mesh.mesh, truth->mesh, truth->classes);
}

auto read(const Request& request, const pipeline::Options& options, const base::Run& run, Progress& progress)
    -> base::Result<Input> {
  auto model = ingest::read_model(request.inputs.back(), {request.lod, options.ingest.crs});
  if (!model) return model.error();
  Input input;
  input.frame = model->frame;
  input.model = ingest::surface_of(*model);
  for (const auto& warning : model->warnings) progress.say(base::to_string(warning));
  auto mesh = ingest::read_mesh({request.inputs.begin(), request.inputs.end() - 1}, input.frame, options.ingest, run);
  if (!mesh) return mesh.error();
  input.mesh = std::move(*mesh);
  for (const auto& warning : input.mesh.warnings) progress.say(base::to_string(warning));
  if (auto met = ingest::check_overlap(input.model.mesh, input.mesh.mesh, {"model", "mesh"}, input.frame,
                                       request.inputs.back());
      !met)
    return met.error();
  auto truth = truth_of(request, input, options.ingest, run);
  if (!truth) return truth.error();
  input.truth = std::move(*truth);
  return input;
}

/// Of the area of the first classes: all four, or those that the trivial rule knows, which has no other.
auto right_share(const label::ScanConfusion& area, std::size_t classes) -> std::string {
  double right = 0, all = 0;
  for (std::size_t t = 0; t < classes; ++t)
    for (std::size_t g = 0; g < area.size(); ++g) {
      all += area[t][g];
      right += t == g ? area[t][g] : 0;
    }
  return all > 0 ? base::to_text(100 * right / all, 1) + " %" : "-";
}

void print(const Input& input, const Classes& classes) {
  std::array<std::size_t, ingest::surface_class_count> counts{};
  for (const auto c : classes) ++counts[static_cast<std::size_t>(c)];
  std::printf("triangles");
  for (std::size_t c = 0; c < counts.size(); ++c)
    std::printf("  %s %zu", std::string(ingest::to_string(static_cast<ingest::SurfaceClass>(c))).c_str(), counts[c]);
  std::printf("\n");
  if (input.truth.empty()) return;
  const auto by_normal = label::label_by_normal(input.mesh.mesh);
  for (const auto& [name, given] :
       {std::pair{"by the model", &classes}, std::pair{"by the normal alone", &by_normal}}) {
    const auto area = label::confusion_of(input.mesh.mesh, input.truth, *given);
    const std::string all = right_share(area, area.size()), known = right_share(area, area.size() - 1);
    std::printf("\n%s: %s of the area right; of walls, roofs and ground %s\n%s", name, all.c_str(), known.c_str(),
                pipeline::confusion_table(area).c_str());
  }
}

auto label_mesh(const Request& request, const base::Cancel& cancel) -> int {
  if (request.inputs.size() < 2) return give_up(base::error("usage", "give one mesh or more, then a model"));
  pipeline::Options options;
  if (auto applied = request.settings.apply(options); !applied) return give_up(applied.error());
  if (auto ready = check_outputs(request); !ready) return give_up(ready.error());
  base::limit_threads(request.jobs);
  Progress progress(request.quiet);
  base::Run run;
  run.cancel = &cancel;
  run.progress = [&](auto stage, auto subject, double fraction) { progress.show(stage, subject, fraction); };
  const auto input = read(request, options, run, progress);
  if (!input) return give_up(input.error());

  const auto classes = label::label_scan(input->mesh.mesh, input->model, request.scan, run);
  auto bytes = fs::path(request.out).extension() == ".ply"
                   ? base::Result<std::string>(write::labelled_ply(input->mesh.mesh, classes, input->frame))
                   : write::labelled_glb(input->mesh.mesh, classes, input->frame);
  if (!bytes) return give_up(bytes.error());
  if (auto written = base::write_files({{request.out, *bytes}}, &cancel); !written) return give_up(written.error());
  print(*input, classes);
  std::printf("%s\n", request.out.c_str());
  return all_done;
}

}  // namespace

auto label_verb(CLI::App& app, const base::Cancel& cancel) -> Verb {
  auto* verb = app.add_subcommand("label", "Label a scan's triangles as wall, roof, ground or other by a model");
  auto request = std::make_shared<Request>();
  verb->add_option("INPUTS", request->inputs,
                   "Meshes (OBJ, PLY, OFF, GLB, or folders of them), then the model (CityJSON, CityJSONSeq or OBJ)")
      ->type_name("MESH… MODEL");
  verb->add_option("-o,--output", request->out, "The labelled mesh: a name ending in .ply or .glb")
      ->required()
      ->type_name("MESH2");
  verb->add_option("--truth-mesh", request->truth_mesh, "PLY whose faces have their true class, to count what is right")
      ->type_name("FILE");
  verb->add_option("--lod", request->lod, "Read this LoD of the model; without it, the highest of each object");
  verb->add_option("--reach", request->scan.reach, "How far from the model a wall or roof may be [m]")
      ->check(CLI::Range(0.01, 100.0));
  verb->add_option("--ground-height", request->scan.ground_height, "How far from the terrain ground may be [m]")
      ->check(CLI::Range(0.01, 100.0));
  verb->add_flag("--overwrite", request->overwrite, "Replace a result that is there already");
  verb->add_option("-j,--jobs", request->jobs, "Threads; 0 for one per core. The result is the same at any number")
      ->check(CLI::Range(0, 1024));
  verb->add_flag("-q,--quiet", request->quiet, "No progress, no warnings");
  verb->set_help_all_flag("--help-all", "Show this and every room's options");
  request->settings.add_to(*verb);
  return {verb, [request, &cancel] { return label_mesh(*request, cancel); }};
}

}  // namespace mansard::cli
