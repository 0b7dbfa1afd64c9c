// `mansard simulate MODEL | --block KIND | --footprints FILE -o OUTDIR`: buildings that are known exactly, and a mesh
// as a scan would show them.
#include "lab/simulate/simulate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <memory>

#include "apps/cli/catalogue.hpp"
#include "apps/cli/exit.hpp"
#include "apps/cli/formats.hpp"
#include "apps/cli/layout.hpp"
#include "apps/cli/output.hpp"
#include "apps/cli/scan.hpp"
#include "apps/cli/verbs.hpp"
#include "lab/simulate/points.hpp"
#include "mansard/formats/documents.hpp"
#include "mansard/formats/las_points.hpp"
#include "mansard/formats/plans.hpp"
#include "mansard/picture/picture.hpp"
#include "mansard/pipeline/solids.hpp"
#include "mansard/pipeline/stored.hpp"
#include "mansard/report/attributes.hpp"
#include "mansard/report/measures.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;

struct SimulateRequest : Common {
  std::string model, block, footprints, lod, out;
  std::vector<double> box;
  double points = 0;  ///< a square metre; 0: none are written
  bool picture = false;
};

/// Every name that this verb may give a file, except truth.json, which is always written.
constexpr std::array file_names{"points.las",      "mesh.ply",         "footprints.geojson", "truth.geojson",
                                "truth.city.json", "truth.city.jsonl", "truth.obj",          "truth.mtl",
                                "plans.json",      "picture.png"};

auto block_names() -> std::string {
  using enum simulate::Kind;
  std::vector<std::string> names;
  for (const auto kind : {terrace, perimeter, courtyard, towers, detached})
    names.emplace_back(simulate::to_string(kind));
  return listed(names, "or");
}

auto menu_of(simulate::Options& options) -> Menu {
  Menu menu{{simulate::option_list(options)}, {}};
  for (const auto& preset : simulate::presets()) menu.presets.push_back({preset.name, preset.meaning, preset.values});
  return menu;
}

/// What the input is called in truth.json.
auto source_of(const SimulateRequest& request) -> std::string {
  return !request.block.empty() ? request.block : !request.model.empty() ? request.model : request.footprints;
}

void say_all(const std::vector<base::Diagnostic>& warnings, Progress& progress) {
  for (const auto& warning : warnings) progress.say(base::to_string(warning));
}

/// What is scanned.
using KnownTruth = simulate::ModelTruth;

auto with_surface(base::Result<simulate::Truth> truth) -> base::Result<KnownTruth> {
  if (!truth) return truth.failure();
  auto surface = simulate::surface_of(truth->city);
  if (!surface) return surface.failure();
  return KnownTruth{std::move(*truth), std::move(*surface)};
}

/// Plans where the file has them: less is known of a model of another producer.
auto known_of_model(const SimulateRequest& request, const base::Run& run, Progress& progress)
    -> base::Result<KnownTruth> {
  auto reader = formats::read_city(request.model);
  if (reader) {
    auto plans = formats::read_whole(**reader);
    if (!plans) return plans.failure();
    return with_surface(simulate::truth_of(std::move(*plans), run));
  }
  if (const auto& code = reader.error().code; !pipeline::is_foreign(reader.error()) && code != "write-plan-json")
    return reader.failure();
  auto model = ingest::read_model(request.model, {request.lod, {}});
  if (!model) return model.failure();
  if (!request.box.empty())
    *model = simulate::within(std::move(*model), {{request.box[0], request.box[1]}, {request.box[2], request.box[3]}});
  auto warnings = model->warnings;
  auto known = simulate::truth_of(*model, warnings);
  say_all(warnings, progress);
  return known;
}

auto truth_for(const SimulateRequest& request, const simulate::Options& options, const base::Run& run,
               Progress& progress) -> base::Result<simulate::Truth> {
  if (const auto kind = simulate::kind_of(request.block))
    return simulate::make_block(*kind, options.block, run.seed, run);
  ingest::Options ingest;
  if (!request.box.empty()) std::ranges::copy(request.box, ingest.bbox.begin());
  const auto scene = ingest::read_footprints(request.footprints, ingest, run);
  if (!scene) return scene.failure();
  auto warnings = scene->warnings;
  auto truth = simulate::furnish(*scene, options.block, run.seed, warnings, run);
  say_all(warnings, progress);
  return truth;
}

/// The scan, coloured by what its triangles show.
auto picture_of(const simulate::Scan& scan, const base::Run& run) -> base::Result<std::string> {
  constexpr std::array colours{picture::wall_grey, picture::roof_red, picture::ground_grey,
                               picture::Colour{110, 140, 96}};
  picture::Layer layer{scan.mesh, {}};
  for (const auto kind : scan.classes) layer.colours.push_back(colours[static_cast<std::size_t>(kind)]);
  const std::vector layers{layer};
  return picture::png(picture::draw(layers, {}, {}, run));
}

/// A model of another producer is the truth as it is: a copy of its file; of a part of it, its triangles.
auto add_copy(const SimulateRequest& request, const KnownTruth& known,
              std::vector<std::pair<std::string, std::string>>& files) -> base::Result<void> {
  if (!request.box.empty()) {
    files.emplace_back("truth.obj", simulate::surface_obj(known.surface, known.truth.city));
    return {};
  }
  auto bytes = base::read_file(request.model);
  if (!bytes) return bytes.failure();
  const auto ending = fs::path(request.model).extension();
  files.emplace_back(ending == ".obj"     ? "truth.obj"
                     : ending == ".jsonl" ? "truth.city.jsonl"
                                          : "truth.city.json",
                     std::move(*bytes));
  return {};
}

/// Whether a part stands on another one, as dormers do: the union of both would not show it.
auto stands_on_another(const model::City& city) -> bool {
  return std::ranges::any_of(city.buildings, [](const model::Building& building) {
    return std::ranges::any_of(building.parts, [](const model::Part& part) {
      return std::ranges::any_of(part.attributes, [](const auto& attribute) {
        const auto* role = std::get_if<std::string>(&attribute.second);
        return attribute.first == "ms_role" && role && (*role == "dormer" || *role == "plant room");
      });
    });
  });
}

/// Moves what is at the base of a building to another height.
void set_base(model::Building& building, double z) {
  constexpr double same = 1e-3;  // m; vertices are on a grid
  const auto move = [&](model::LabelledSolid& model) {
    for (auto& vertex : model.solid.vertices)
      if (std::abs(vertex.z - building.ground) < same) vertex.z = z;
  };
  for (auto& part : building.parts) move(part.model);
  for (auto& united : building.solids) move(united.model);
  building.ground = z;
}

/// Buildings with what is measured of them, as of models that are reconstructed: what those are compared with.
auto measured(model::City city, const simulate::Scan& scan) -> model::City {
  const auto z0 = static_cast<double>(city.frame.origin[2]);
  auto united = pipeline::unite_parts(city.buildings);
  constexpr double storey = 3;  // m; the default of roof.level_height
  for (std::size_t b = 0; b < city.buildings.size(); ++b) {
    auto& building = city.buildings[b];
    model::Building plain{building.id, {}, building.footprint, building.ground, building.parts, building.solids};
    if (plain.solids.empty()) plain.solids = std::move(united[b].solids);
    const auto ground = b < scan.at_walls.size() ? scan.at_walls[b] : std::nullopt;
    // Walls go down to the terrain, as those of models do; the planted base may be anywhere in its waves.
    if (ground) set_base(plain, ground->lowest);
    auto found = report::building_measures(plain, z0, storey);
    double volume = 0, top = plain.ground;
    for (const auto* solid : report::solids_of(plain))
      volume += solid::volume(solid->solid), top = std::max(top, report::top_of(solid->solid));
    found.emplace_back("ms_h_ground", z0 + plain.ground);
    if (ground) found.emplace_back("ms_h_ground_mean", z0 + ground->mean);
    if (ground) found.emplace_back("ms_h_ground_max", z0 + ground->highest);
    found.emplace_back("ms_h_roof_max", z0 + top);
    found.emplace_back("ms_volume_lod22", volume);
    report::round_measures(found);
    std::ranges::move(found, std::back_inserter(building.attributes));
  }
  return city;
}

/// The truth as models and plans. Where a solid of a file is simpler than what is scanned, that is said.
auto add_models(const model::City& city, const simulate::Scan& scan,
                std::vector<std::pair<std::string, std::string>>& files, Progress& progress) -> base::Result<void> {
  const auto solids = stands_on_another(city) ? formats::Solids::part : formats::Solids::building;
  std::vector<base::Diagnostic> warnings;
  auto cityjson = formats::cityjson(measured(city, scan), solids, &warnings);
  if (!cityjson) return cityjson.failure();
  std::erase_if(warnings,
                [](const auto& warning) { return warning.code == "solid-not-united"; });  // as parts: as exact
  say_all(warnings, progress);
  auto obj = formats::obj(city, "truth.mtl", solids);
  if (!obj) return obj.failure();
  files.emplace_back("truth.city.json", std::move(*cityjson));
  files.emplace_back("truth.obj", std::move(obj->obj));
  files.emplace_back("truth.mtl", std::move(obj->mtl));
  files.emplace_back("plans.json", formats::plans(city));
  return {};
}

auto write_all(const SimulateRequest& request, const simulate::Options& options, const KnownTruth& known,
               const base::Run& run, Progress& progress) -> base::Result<void> {
  const auto& truth = known.truth;
  auto scan = simulate::scan(known.surface, options.scan, run.seed, run);
  if (!scan) return scan.failure();
  auto footprints = simulate::survey(truth, options.survey, run.seed);
  if (!footprints) return footprints.failure();
  const auto faults =
      simulate::faults_of(truth, options.scan.faults, request.points > 0, options.survey.heights, run.seed);
  simulate::plant(faults, truth, run.seed, *scan);
  simulate::plant(faults, truth, *footprints);

  progress.show("write", request.out, 1);
  simulate::Planted planted{scan->planted, {}, faults};
  std::optional<std::string> points;
  if (request.points > 0) {
    auto drawn = simulate::airborne_points(
        *scan, {request.points, options.scan.points_noise, options.scan.points_noise_plan}, run.seed);
    simulate::plant(faults, truth, run.seed, drawn);
    planted.points = drawn.planted;
    auto bytes = formats::las(drawn.points, truth.city.frame);
    if (!bytes) return bytes.failure();
    points = std::move(*bytes);
  }
  std::vector<std::pair<std::string, std::string>> files{
      {"mesh.ply", simulate::ply(*scan, truth.city.frame)},
      {"footprints.geojson", simulate::geojson(*footprints, truth.city.frame)},
      {"truth.geojson", simulate::geojson(simulate::true_footprints(truth), truth.city.frame)},
      {"truth.json", simulate::truth_json(truth, *footprints, options, source_of(request), scan->crowns, planted)}};
  if (auto added = truth.model ? add_copy(request, known, files) : add_models(truth.city, *scan, files, progress);
      !added)
    return added;
  if (points) files.emplace_back("points.las", std::move(*points));
  if (request.picture) {
    auto picture = picture_of(*scan, run);
    if (!picture) return picture.failure();
    files.emplace_back("picture.png", std::move(*picture));
  }
  const auto all = in_folder(request.out, files);
  const auto left = leftovers(request.out, "truth.json",
                              [](const auto& name) { return std::ranges::find(file_names, name) != file_names.end(); });
  if (auto written = base::write_files(all, run.cancel); !written) return written;
  remove_stale(left, all);
  progress.say(std::to_string(truth.city.buildings.size()) + " buildings, " + std::to_string(truth.party_walls.size()) +
               " party walls, " + std::to_string(scan->mesh.triangles.size()) + " triangles");
  return {};
}

auto simulate_block(const SimulateRequest& request, const base::Cancel& cancel) -> int {
  const int inputs =
      (request.model.empty() ? 0 : 1) + (request.block.empty() ? 0 : 1) + (request.footprints.empty() ? 0 : 1);
  if (inputs != 1) return give_up(base::error("usage", "expected exactly one of MODEL, --block and --footprints"));
  if (!request.block.empty() && !simulate::kind_of(request.block))
    return give_up(base::error("option-value",
                               "unknown kind of block '" + request.block + "'; expected " + block_names(), "--block"));
  if (!request.box.empty() && !request.block.empty())
    return give_up(
        base::error("usage", "--bbox applies to a MODEL or to --footprints; the size of a --block is --simulate-size"));
  simulate::Options options;
  if (auto applied = request.settings.apply(menu_of(options)); !applied) return give_up(applied.errors());
  std::vector<fs::path> results{fs::path(request.out) / "truth.json"}, given;
  for (const auto* name : file_names) results.push_back(fs::path(request.out) / name);
  for (const auto& input : {request.model, request.footprints})
    if (!input.empty()) given.emplace_back(input);
  if (auto spared = spare_inputs(results, given); !spared) return give_up(spared.errors());
  if (auto ready = prepare(request.out, request.overwrite); !ready) return give_up(ready.errors());
  Progress progress(request.quiet);
  const auto run = start(request, options.seed, cancel, progress);
  auto known = request.model.empty() ? with_surface(truth_for(request, options, run, progress))
                                     : known_of_model(request, run, progress);
  if (!known) return give_up(known.errors());
  if (request.model.empty()) {  // plans of a file keep how they were made
    auto& made_by = known->truth.city.made_by;
    made_by.version = MANSARD_VERSION;
    const auto list = simulate::option_list(options);
    for (const auto& option : list.options()) made_by.options.emplace_back("simulate." + option.name, option.get());
  }
  if (auto written = write_all(request, options, *known, run, progress); !written) return give_up(written.errors());
  std::printf("%s\n", (fs::path(request.out) / "mesh.ply").c_str());
  return all_done;
}

}  // namespace

auto simulate_verb(CLI::App& app, const base::Cancel& cancel) -> Verb {
  auto* verb = add_verb(app, "simulate");
  auto request = std::make_shared<SimulateRequest>();
  verb->add_option("MODEL", request->model, "Model to scan: " + readable_formats().models)->type_name("MODEL");
  verb->add_option("--block", request->block, "Generate a block of this kind: " + block_names())->type_name("KIND");
  verb->add_option("--footprints", request->footprints,
                   "Generate buildings on these footprints: " + readable_formats().footprints)
      ->type_name("FILE");
  verb->add_option("--lod", request->lod,
                   "LoD to read of a MODEL without plans; without it, the highest of each object");
  verb->add_option("-o,--output", request->out, "Output folder")->required()->type_name("OUTDIR");
  verb->add_option("--bbox", request->box,
                   "Keep the buildings of a MODEL, or the footprints, that intersect this box, in the CRS of the model "
                   "or the working CRS")
      ->type_name("XMIN YMIN XMAX YMAX")
      ->delimiter(',')
      ->expected(4);
  verb->add_option(
          "--points", request->points,
          "Also write the scan as an airborne point cloud (points.las), with this number of points a square metre")
      ->type_name("DENSITY")
      ->check(CLI::Range(0.0, 10000.0));
  verb->add_flag("--picture", request->picture, "Also write a picture of the scan, coloured by class (picture.png)");
  simulate::Options defaults;
  add_common(*verb, *request, "summary", menu_of(defaults));
  return {verb, [request, &cancel] { return simulate_block(*request, cancel); }};
}

}  // namespace mansard::cli
