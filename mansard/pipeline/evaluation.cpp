// The steps of an evaluation: the files in one frame, block after block, building after building, then the truth.
#include "mansard/pipeline/evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mansard/base/stopped.hpp"
#include "mansard/base/text.hpp"
#include "mansard/block/block.hpp"
#include "mansard/ingest/points.hpp"
#include "mansard/pipeline/detail/assemble.hpp"
#include "mansard/pipeline/detail/block_run.hpp"
#include "mansard/pipeline/stored.hpp"

namespace mansard::pipeline {
namespace {

using evaluate::Outline;

/// Footprints as they stand in another frame, which differs by whole metres.
void move_to(const model::Frame& frame, model::Scene& scene) {
  const geometry::Point2 by{static_cast<double>(scene.frame.origin[0] - frame.origin[0]),
                            static_cast<double>(scene.frame.origin[1] - frame.origin[1])};
  const auto move = [&](geometry::Ring& ring) {
    for (auto& p : ring) p = p + by;
  };
  for (auto& footprint : scene.footprints)
    for (auto& polygon : footprint.polygons) {
      move(polygon.outer);
      std::ranges::for_each(polygon.holes, move);
    }
}

using Warnings = std::vector<base::Diagnostic>;

auto unchecked(const std::string& what, const base::Diagnostic& why, const std::string& subject) -> base::Diagnostic {
  return base::warning("pipeline-evaluation-unchecked", what + " (" + why.message + ")", subject);
}

/// The outlines, empty with a warning where one cannot be computed; `subjects` are what they are of.
auto without_failures(const std::vector<base::Result<Outline>>& found, const std::vector<std::string>& subjects,
                      Warnings& warnings) -> std::vector<Outline> {
  std::vector<Outline> out;
  for (std::size_t i = 0; i < found.size(); ++i) {
    out.push_back(found[i] ? *found[i] : Outline());
    if (!found[i])
      warnings.push_back(
          unchecked("its outline could not be computed, and it counts as missing", found[i].error(), subjects[i]));
  }
  return out;
}

auto building_outlines(const model::Model& model, Warnings& warnings) -> std::vector<Outline> {
  std::vector<base::Result<Outline>> found(model.buildings.size(), Outline());
  std::vector<std::string> subjects;
  for (const auto& building : model.buildings) subjects.push_back(building.id);
  base::parallel_for(found.size(), [&](std::size_t b) { found[b] = evaluate::outline_of(model.buildings[b].parts); });
  return without_failures(found, subjects, warnings);
}

auto part_outlines(const model::Model& model, Warnings& warnings) -> std::vector<Outline> {
  std::vector<base::Result<Outline>> found;
  std::vector<std::string> subjects;
  for (const auto& building : model.buildings)
    for (const auto& part : building.parts) {
      found.push_back(evaluate::outline_of({&part, 1}));
      subjects.push_back(building.id);
    }
  return without_failures(found, subjects, warnings);
}

/// The footprints that a model stands on itself.
auto footprints_of(const model::Model& model, Warnings& warnings) -> std::vector<model::Footprint> {
  auto outlines = building_outlines(model, warnings);
  std::vector<model::Footprint> out;
  for (std::size_t b = 0; b < outlines.size(); ++b) {
    auto& footprint = out.emplace_back();
    footprint.id = model.buildings[b].id;
    footprint.polygons = std::move(outlines[b]);
    if (footprint.polygons.empty())
      footprint.defect =
          base::warning("ingest-footprint-area", "its faces seen from above have no outline", footprint.id);
  }
  return out;
}

void append(std::vector<base::Diagnostic>& all, const std::vector<base::Diagnostic>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

auto in_words(const geometry::Box2& box, const model::Frame& frame) -> std::string {
  const auto range = [&](double least, double most, std::size_t axis) {
    const auto at = static_cast<double>(frame.origin[axis]);
    return base::to_text(least + at, 1) + " to " + base::to_text(most + at, 1);
  };
  return "x " + range(box.least.x, box.most.x, 0) + ", y " + range(box.least.y, box.most.y, 1);
}

auto read_reference(const EvaluationFiles& files, const ingest::Options& options, const base::Run& run,
                    report::EvaluationInput& input) -> base::Result<void> {
  auto& scene = input.scene;
  const model::Frame frame = input.model.frame;
  if (files.footprints.empty()) {
    input.reference = input.truth ? report::Reference::truth : report::Reference::model;
    scene.footprints = footprints_of(input.truth ? *input.truth : input.model, scene.warnings);
    return {};
  }
  input.reference = report::Reference::footprints;
  auto wanted = options;
  if (wanted.crs.empty()) wanted.crs = frame.crs;
  auto read = ingest::read_footprints(files.footprints, wanted, run);
  if (!read) return read.error();
  move_to(frame, *read);
  scene.footprints = std::move(read->footprints);  // and not their surroundings: these are not measured
  scene.inputs.insert(scene.inputs.end(), read->inputs.begin(), read->inputs.end());
  append(scene.warnings, read->warnings);
  geometry::Box2 drawn, built;
  for (const auto& footprint : scene.footprints)
    for (const auto& polygon : footprint.polygons)
      for (const auto p : polygon.outer) drawn.add(p);
  for (const auto p : model::surface_of(input.model).mesh.vertices) built.add(xy(p));
  if (drawn.overlaps(built)) return {};
  return base::error("ingest-model-overlap",
                     "footprints and model do not overlap: the footprints lie in " + in_words(drawn, frame) +
                         ", the model in " + in_words(built, frame) + "; check both, and --crs",
                     files.footprints.string());
}

/// Which block each building of the model stands on: the one it shares most ground with; none for one beside all. Where
/// shared ground cannot be computed, the building counts as standing on that block.
auto block_of_buildings(const model::Model& model, const std::vector<Outline>& outlines,
                        const std::vector<block::Block>& blocks, Warnings& warnings)
    -> std::vector<std::optional<std::size_t>> {
  std::vector<std::optional<std::size_t>> out(outlines.size());
  std::vector<Warnings> own(outlines.size());
  base::parallel_for(outlines.size(), [&](std::size_t m) {
    double most = 0;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const auto common = evaluate::common_area(outlines[m], blocks[b].outline);
      if (common && *common > most) {
        most = *common;
        out[m] = b;
      }
      if (common) continue;
      if (!out[m]) out[m] = b;
      own[m].push_back(unchecked("the ground it shares with " + blocks[b].name + " could not be computed",
                                 common.error(), model.buildings[m].id));
    }
  });
  for (const auto& one : own) warnings.insert(warnings.end(), one.begin(), one.end());
  return out;
}

/// Scores of several places, and what their quantiles are of.
struct Total {
  std::vector<evaluate::Scores> scores;
  std::vector<float> built;
  evaluate::Differences differences;

  void add(const evaluate::Scores& of, std::span<const float> cells, const evaluate::Differences& inside) {
    scores.push_back(of);
    built.insert(built.end(), cells.begin(), cells.end());
    differences.add(inside);
  }
  void add(const evaluate::Comparison& of) { add(of.scores, of.map.difference, of.differences); }
  void add(const evaluate::Prism& of) { add(of.scores, of.differences.footprints, of.differences); }
  [[nodiscard]] auto all() const -> evaluate::Scores {
    auto sum = evaluate::combined(scores);
    evaluate::set_quantiles(built, sum);
    evaluate::set_quantiles(differences, sum);
    return sum;
  }
};

struct Totals {
  Total model, prism, model_from_truth, prism_from_truth;
};

struct BlockWork {
  report::BlockScores block;
  std::vector<report::BuildingScores> buildings;
  std::vector<std::size_t> features;  ///< of the buildings, in the scene
  std::vector<double> from_model, from_scan;
  evaluate::ErrorMap map;
};

/// One building of a block against the mesh, and against the truth where there is one.
auto building_scores(const block::Member& member, const rays::Scene& model, const rays::Scene& scan,
                     const rays::Scene* truth, const evaluate::Options& options, Totals& totals)
    -> report::BuildingScores {
  report::BuildingScores out;
  out.scores = evaluate::scores_over(model, scan, member.polygons, member.ground, options);
  out.prism = evaluate::prism_over(scan, member.polygons, options);
  totals.prism.add(out.prism);
  out.prism.differences = {};
  if (truth) {
    out.from_truth = evaluate::scores_over(model, *truth, member.polygons, member.ground, options);
    const auto prism = evaluate::prism_over(*truth, member.polygons, out.prism.height, options);
    totals.prism_from_truth.add(prism);
    out.prism_from_truth = prism.scores;
  }
  const double area = std::accumulate(member.polygons.begin(), member.polygons.end(), 0.0,
                                      [](double sum, const auto& p) { return sum + geometry::area(p); });
  out.modelled = out.scores.missed < 0.5 * area;
  return out;
}

auto work_on(const block::Block& block, const model::ModelSurface& model, const rays::Scene* truth,
             const model::Scene& scene, const Options& options, const base::Run& run, Totals& totals) -> BlockWork {
  BlockWork out;
  out.block.name = block.name;
  out.block.buildings = block.members.size();
  std::vector<geometry::Polygon> footprints;
  std::vector<evaluate::Site> sites;
  for (const auto& member : block.members) {
    footprints.insert(footprints.end(), member.polygons.begin(), member.polygons.end());
    sites.push_back({member.polygons, member.ground});
  }
  const rays::Scene scan(block.mesh), top(model.mesh);
  auto comparison = evaluate::compare(model.mesh, scan, footprints, block.ground, options.evaluate, run);
  totals.model.add(comparison);
  out.block.scores = comparison.scores;
  out.map = std::move(comparison.map);
  if (truth)
    totals.model_from_truth.add(evaluate::compare(model.mesh, *truth, footprints, block.ground, options.evaluate, run));
  for (const auto& member : block.members) {
    auto building = building_scores(member, top, scan, truth, options.evaluate, totals);
    building.id = scene.footprints[member.feature].id;
    building.block = block.name;
    out.buildings.push_back(std::move(building));
    out.features.push_back(member.feature);
  }
  out.from_model = evaluate::from_model(model, scan, {}, run.seed, run);
  out.from_scan = evaluate::from_scan(block.mesh, sites, model, {}, run.seed, run);
  out.block.from_model = evaluate::spread_of(out.from_model);
  out.block.from_scan = evaluate::spread_of(out.from_scan);
  return out;
}

/// What is known of all blocks together.
void sum_up(std::vector<BlockWork>& work, report::Evaluation& out) {
  std::vector<evaluate::ErrorMap> maps;
  std::vector<double> from_model, from_scan;
  for (auto& one : work) {
    from_model.insert(from_model.end(), one.from_model.begin(), one.from_model.end());
    from_scan.insert(from_scan.end(), one.from_scan.begin(), one.from_scan.end());
    maps.push_back(std::move(one.map));
    const bool unknown = std::ranges::any_of(one.buildings, [](const auto& b) { return b.scores.union_unknown; });
    if (unknown || one.block.scores.union_unknown) out.warnings.push_back(detail::union_unknown(one.block.name));
    out.blocks.push_back(std::move(one.block));
  }
  out.from_model = evaluate::spread_of(std::move(from_model));
  out.from_scan = evaluate::spread_of(std::move(from_scan));
  out.map = evaluate::merged(maps);

  std::vector<std::pair<std::size_t, report::BuildingScores>> buildings;
  for (auto& one : work)
    for (std::size_t i = 0; i < one.buildings.size(); ++i)
      buildings.emplace_back(one.features[i], std::move(one.buildings[i]));
  std::ranges::sort(buildings, {}, &std::pair<std::size_t, report::BuildingScores>::first);
  for (auto& [feature, building] : buildings) out.buildings.push_back(std::move(building));
}

auto counts_of(const model::Model& model) -> report::ModelCounts {
  report::ModelCounts out;
  out.buildings = model.buildings.size();
  for (const auto& building : model.buildings) {
    out.parts += building.parts.size();
    for (const auto& part : building.parts) out.faces += part.faces.size();
  }
  const auto planes = evaluate::planes_of(model);
  out.planes = planes.planes.size();
  for (const auto& plane : planes.planes) out.area[static_cast<std::size_t>(plane.kind)] += plane.area;
  return out;
}

auto against(const model::Model& truth, const model::Model& model, const std::vector<Outline>& buildings,
             const model::ModelSurface& surface, const Options& options, const base::Run& run, Warnings& warnings)
    -> report::TruthScores {
  report::TruthScores out;
  const auto true_buildings = building_outlines(truth, warnings), true_parts = part_outlines(truth, warnings);
  const auto parts = part_outlines(model, warnings);
  out.parts = evaluate::compare_partition(true_parts, parts);
  out.buildings = evaluate::compare_partition(true_buildings, buildings);
  if (const auto pairs = out.parts.unchecked + out.buildings.unchecked; pairs > 0)
    warnings.push_back(base::warning("pipeline-evaluation-unchecked",
                                     std::to_string(pairs) + " pairs of a true and a modelled outline could not be "
                                                             "intersected, and count as not matched"));
  // A wall between two buildings must be found; a wall between two parts of one may be.
  out.party_walls = evaluate::compare_party_walls(true_buildings, parts);
  out.party_walls.right = evaluate::compare_party_walls(true_parts, parts).right;
  out.roofs = evaluate::compare_roofs(truth, model, options.evaluate.grid);
  out.classes = evaluate::compare_classes(model::surface_of(truth), surface, {}, run.seed, run);
  return out;
}

/// What the form of a model is measured on.
struct Roof {
  const model::Model& model;
  evaluate::RoofPlanes planes;
  std::vector<evaluate::RoofLine> lines;
  std::vector<evaluate::RoofStructure> structures;

  Roof(const model::Model& of, double grid)
      : model(of),
        planes(evaluate::roof_planes_of(of)),
        lines(evaluate::roof_lines_of(of, planes)),
        structures(evaluate::roof_structures_of(of, planes, grid)) {}
  [[nodiscard]] auto input() const -> evaluate::FormInput { return {model, planes, lines, structures}; }
};

void measure_form(const report::EvaluationInput& input, double grid, report::Evaluation& out) {
  const Roof model(input.model, grid);
  out.form = evaluate::form_of(model.input(), input.scene.mesh);
  auto unchecked = out.form.unchecked;
  if (auto& scores = out.truth; input.truth && scores) {
    const Roof truth(*input.truth, grid);
    scores->form = evaluate::compare_form(truth.input(), model.input(), grid);
    scores->form.form = evaluate::form_of(truth.input(), input.scene.mesh);
    unchecked += scores->form.unchecked + scores->form.form.unchecked;
  }
  if (unchecked > 0)
    out.warnings.push_back(base::warning("pipeline-evaluation-unchecked",
                                         "the plan of " + std::to_string(unchecked) +
                                             " roof planes or parts could not be computed for the form scores"));
}

}  // namespace

auto read_evaluation(const EvaluationFiles& files, const ingest::Options& options, const base::Run& run)
    -> base::Result<report::EvaluationInput> {
  report::EvaluationInput input;
  auto model = read_any_model(files.model, {files.lod, options.crs}, run);
  if (!model) return model.error();
  input.model = std::move(*model);
  auto& scene = input.scene;
  scene.frame = input.model.frame;
  scene.inputs = input.model.inputs;
  scene.warnings = input.model.warnings;
  const auto surface = model::surface_of(input.model);
  if (surface.lost > 0)
    scene.warnings.push_back(base::warning("ingest-model-face",
                                           std::to_string(surface.lost) + " faces cross themselves and were left out",
                                           files.model.string()));
  auto mesh = ingest::read_mesh(files.meshes, scene.frame, options, run);
  if (!mesh) return mesh.error();
  if (auto met = ingest::check_overlap(surface.mesh, mesh->mesh, {"model", "mesh"}, scene.frame, files.model.string());
      !met)
    return met.error();
  scene.mesh = std::move(mesh->mesh);
  scene.mesh_counts = mesh->counts;
  scene.inputs.insert(scene.inputs.end(), mesh->inputs.begin(), mesh->inputs.end());
  append(scene.warnings, mesh->warnings);
  constexpr std::uint8_t building = 6;
  auto points = ingest::read_points_of_class(files.meshes, building, scene.frame, options, run);
  if (!points) return points.failure();
  input.building_points = std::move(*points);

  if (!files.truth.empty()) {
    auto truth = read_any_model(files.truth, {files.lod, {}}, run);
    if (truth) truth = ingest::in_frame(std::move(*truth), scene.frame);
    if (!truth) return truth.error();
    if (auto met = ingest::check_overlap(surface.mesh, model::surface_of(*truth).mesh, {"model", "truth"}, scene.frame,
                                         files.truth.string());
        !met)
      return met.error();
    scene.inputs.insert(scene.inputs.end(), truth->inputs.begin(), truth->inputs.end());
    append(scene.warnings, truth->warnings);
    input.truth = std::move(*truth);
  }
  if (auto done = read_reference(files, options, run, input); !done) return done.error();
  return input;
}

auto evaluate_model(const report::EvaluationInput& input, const Options& options, const base::Run& run)
    -> base::Result<report::Evaluation> {
  report::Evaluation out;
  out.options = options.evaluate;
  out.seed = options.seed;
  out.version = detail::version();
  for (const auto& footprint : input.scene.footprints)
    if (footprint.defect) out.warnings.push_back(*footprint.defect);
  const auto blocks = block::partition(input.scene, options.block, run);
  if (blocks.empty() && !run.cancelled())
    return base::error("pipeline-nothing", "there is no footprint to measure over",
                       std::string(to_string(input.reference)));

  for (const auto& block : blocks)
    for (auto warning : block.warnings) {
      warning.subject = block.name;
      out.warnings.push_back(std::move(warning));
    }
  const auto surface = model::surface_of(input.model);
  const auto outlines = building_outlines(input.model, out.warnings);
  const auto stands_on = block_of_buildings(input.model, outlines, blocks, out.warnings);
  std::optional<rays::Scene> truth;
  if (input.truth) truth.emplace(model::surface_of(*input.truth).mesh);
  Totals totals;
  std::vector<BlockWork> work;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (run.cancelled()) return base::stopped();
    run.report("evaluate", blocks[b].name, static_cast<double>(b) / static_cast<double>(blocks.size()));
    std::vector<bool> own(outlines.size());
    for (std::size_t m = 0; m < own.size(); ++m) own[m] = stands_on[m] == b;
    base::Run inner = run;
    inner.progress = nullptr;
    work.push_back(work_on(blocks[b], model::part_of(surface, own), truth ? &*truth : nullptr, input.scene, options,
                           inner, totals));
    work.back().block.model_buildings = static_cast<std::size_t>(std::ranges::count(own, true));
  }
  sum_up(work, out);
  out.scores = totals.model.all();
  out.prism = totals.prism.all();
  for (std::size_t m = 0; m < outlines.size(); ++m) {
    if (stands_on[m]) continue;
    out.beside.push_back(input.model.buildings[m].id);
    for (const auto& polygon : outlines[m]) out.scores.invented += geometry::area(polygon);
  }
  out.counts = counts_of(input.model);
  if (input.truth) {
    out.truth = against(*input.truth, input.model, outlines, surface, options, run, out.warnings);
    out.truth->scores = totals.model_from_truth.all();
    out.truth->prism = totals.prism_from_truth.all();
  }
  if (!input.building_points.empty()) out.points = evaluate::point_scores(surface.mesh, input.building_points);
  measure_form(input, options.evaluate.grid, out);
  if (run.cancelled()) return base::stopped();
  return out;
}

}  // namespace mansard::pipeline
