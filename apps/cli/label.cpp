// `mansard label MESH… MODEL -o MESH2`: a scan's triangles as wall, roof, ground or other.
#include <algorithm>
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
#include "mansard/base/text.hpp"
#include "mansard/formats/scan.hpp"
#include "mansard/label/scan.hpp"
#include "mansard/pipeline/evaluation.hpp"
#include "mansard/pipeline/stored.hpp"
#include "mansard/report/evaluation.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;
using Classes = std::vector<model::SurfaceClass>;

struct LabelRequest : Common {
  std::vector<std::string> inputs;  // the meshes, then the model
  std::string truth_mesh, truth, lod, out;
  label::ScanOptions scan;
};

auto check_outputs(const LabelRequest& request) -> base::Result<void> {
  const auto ending = fs::path(request.out).extension();
  if (ending != ".ply" && ending != ".glb")
    return base::error("usage", "the output is a mesh; its file extension must be .ply or .glb", request.out);
  std::vector<fs::path> inputs(request.inputs.begin(), request.inputs.end());
  for (const auto& extra : {request.truth_mesh, request.truth})
    if (!extra.empty()) inputs.emplace_back(extra);
  if (auto spared = spare_inputs({request.out}, inputs); !spared) return spared;
  return file_free(request.out, request.overwrite);
}

struct Input {
  model::ModelSurface model;
  model::Frame frame;
  ingest::ScannedMesh mesh;
  Classes truth;  ///< per triangle of the mesh; empty for none
  std::optional<model::ModelSurface> true_model;
};

auto true_model_of(const LabelRequest& request, const Input& input)
    -> base::Result<std::optional<model::ModelSurface>> {
  std::optional<model::ModelSurface> none;
  if (request.truth.empty()) return none;
  auto truth = pipeline::read_any_model(request.truth, {request.lod, {}});
  if (truth) truth = ingest::in_frame(std::move(*truth), input.frame);
  if (!truth) return truth.failure();
  auto surface = model::surface_of(*truth);
  if (auto met = ingest::check_overlap(input.mesh.mesh, surface.mesh, {"mesh", "truth"}, input.frame, request.truth);
      !met)
    return met.failure();
  return std::optional(std::move(surface));
}

auto truth_of(const LabelRequest& request, const Input& input, const ingest::Options& options, const base::Run& run)
    -> base::Result<Classes> {
  if (request.truth_mesh.empty()) return Classes();
  auto truth = ingest::read_mesh({request.truth_mesh}, input.frame, options, run);
  if (!truth) return truth.failure();
  if (truth->classes.empty())
    return base::error("usage", "the faces have no class; expected a PLY file with the face property 'class'",
                       request.truth_mesh);
  if (auto met =
          ingest::check_overlap(input.mesh.mesh, truth->mesh, {"mesh", "true mesh"}, input.frame, request.truth_mesh);
      !met)
    return met.failure();
  return label::classes_from(input.mesh.mesh, truth->mesh, truth->classes);
}

auto read(const LabelRequest& request, const pipeline::Options& options, const base::Run& run, Progress& progress)
    -> base::Result<Input> {
  auto model = pipeline::read_any_model(request.inputs.back(), {request.lod, options.ingest.crs}, run);
  if (!model) return model.failure();
  Input input;
  input.frame = model->frame;
  input.model = model::surface_of(*model);
  for (const auto& warning : model->warnings) progress.say(base::to_string(warning));
  auto mesh = ingest::read_mesh({request.inputs.begin(), request.inputs.end() - 1}, input.frame, options.ingest, run);
  if (!mesh) return mesh.failure();
  input.mesh = std::move(*mesh);
  for (const auto& warning : input.mesh.warnings) progress.say(base::to_string(warning));
  if (auto met = ingest::check_overlap(input.model.mesh, input.mesh.mesh, {"model", "mesh"}, input.frame,
                                       request.inputs.back());
      !met)
    return met.failure();
  auto truth = truth_of(request, input, options.ingest, run);
  if (!truth) return truth.failure();
  input.truth = std::move(*truth);
  auto true_model = true_model_of(request, input);
  if (!true_model) return true_model.failure();
  input.true_model = std::move(*true_model);
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

/// Of what is above the ground, which by the true model is wall or roof.
void print_walls_and_roofs(const Input& input, const Classes& classes, const label::ScanOptions& options) {
  const auto& mesh = input.mesh.mesh;
  auto truth = label::nearest_wall_or_roof(mesh, *input.true_model);
  const auto above = label::above_ground(mesh, *input.true_model, options);
  for (std::size_t t = 0; t < truth.size(); ++t)
    if (!above[t]) truth[t] = model::SurfaceClass::ground;
  double all = 0;
  const auto share = [&](const Classes& given) {
    const auto area = label::confusion_of(mesh, truth, given);
    double right = 0;
    all = 0;
    for (const std::size_t t : {0U, 1U}) {  // wall, roof
      right += area[t][t];
      for (const double m2 : area[t]) all += m2;
    }
    return all > 0 ? base::to_text(100 * right / all, 1) + " %" : std::string("-");
  };
  const std::string nearest = share(label::nearest_wall_or_roof(mesh, input.model)), labelled = share(classes),
                    normal = share(label::wall_or_roof_by_normal(mesh));
  std::printf(
      "walls and roofs of the true model that are labelled right, of %s m²: by the nearest wall or roof of the model "
      "%s, "
      "by this labelling %s, by the normal alone %s\n",
      base::to_text(all, 0).c_str(), nearest.c_str(), labelled.c_str(), normal.c_str());
}

void print(const Input& input, const Classes& classes) {
  std::array<std::size_t, model::surface_class_count> counts{};
  for (const auto c : classes) ++counts[static_cast<std::size_t>(c)];
  std::printf("triangles");
  for (std::size_t c = 0; c < counts.size(); ++c)
    std::printf("  %s %zu", std::string(model::to_string(static_cast<model::SurfaceClass>(c))).c_str(), counts[c]);
  std::printf("\n");
  if (input.truth.empty()) return;
  const auto by_normal = label::label_by_normal(input.mesh.mesh);
  for (const auto& [name, given] :
       {std::pair{"by the model", &classes}, std::pair{"by the normal alone", &by_normal}}) {
    const auto area = label::confusion_of(input.mesh.mesh, input.truth, *given);
    const std::string all = right_share(area, area.size()), known = right_share(area, area.size() - 1);
    std::printf("\n%s: %s of the area is right; %s without the class other\n%s", name, all.c_str(), known.c_str(),
                report::confusion_table(area).c_str());
  }
}

auto label_mesh(const LabelRequest& request, const base::Cancel& cancel) -> int {
  if (request.inputs.size() < 2) return give_up(base::error("usage", "expected one or more meshes, then a model"));
  if (auto order = check_model_place(request.inputs.back(), request.inputs.front(),
                                     "mansard label " + quoted(request.inputs.back()) + " " +
                                         quoted(request.inputs.front()) + " -o " + quoted(request.out));
      !order)
    return give_up(order.errors());
  pipeline::Options options;
  if (auto applied = request.settings.apply(options); !applied) return give_up(applied.errors());
  if (auto ready = check_outputs(request); !ready) return give_up(ready.errors());
  Progress progress(request.quiet);
  const auto run = start(request, options.seed, cancel, progress);
  const auto input = read(request, options, run, progress);
  if (!input) return give_up(input.errors());

  const auto classes = label::label_scan(input->mesh.mesh, input->model, request.scan, run);
  auto bytes = fs::path(request.out).extension() == ".ply"
                   ? base::Result<std::string>(formats::labelled_ply(input->mesh.mesh, classes, input->frame))
                   : formats::labelled_glb(input->mesh.mesh, classes, input->frame);
  if (!bytes) return give_up(bytes.errors());
  if (auto written = base::write_files({{request.out, *bytes}}, &cancel); !written) return give_up(written.errors());
  print(*input, classes);
  if (input->true_model) print_walls_and_roofs(*input, classes, request.scan);
  std::printf("%s\n", request.out.c_str());
  return all_done;
}

}  // namespace

auto label_verb(CLI::App& app, const base::Cancel& cancel) -> Verb {
  auto* verb = add_verb(app, "label");
  auto request = std::make_shared<LabelRequest>();
  verb->add_option("INPUTS", request->inputs,
                   "Meshes: " + readable_formats().meshes + ". Then the model: " + readable_formats().models)
      ->type_name("MESH... MODEL");
  verb->add_option("-o,--output", request->out,
                   "Labelled mesh: .ply with a class for each face, or .glb with a material for each class")
      ->required()
      ->type_name("MESH2");
  verb->add_option("--truth-mesh", request->truth_mesh,
                   "PLY with the true class of each face; the share that is right is printed")
      ->type_name("FILE");
  verb->add_option("--truth", request->truth,
                   "Model that is known to be right; the share of walls and roofs that are right is printed")
      ->type_name("MODEL");
  verb->add_option("--lod", request->lod, "LoD to read of the models; without it, the highest of each object");
  verb->add_option("--reach", request->scan.reach, "Maximum distance of a wall or roof from the model, in metres")
      ->check(CLI::Range(0.01, 100.0));
  verb->add_option("--ground-height", request->scan.ground_height,
                   "Maximum distance of the ground from the terrain, in metres")
      ->check(CLI::Range(0.01, 100.0));
  add_common(*verb, *request, "warnings");
  return {verb, [request, &cancel] { return label_mesh(*request, cancel); }};
}

}  // namespace mansard::cli
