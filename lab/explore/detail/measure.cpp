#include "lab/explore/detail/measure.hpp"

#include <algorithm>

#include "mansard/block/block.hpp"
#include "mansard/evaluate/evaluate.hpp"
#include "mansard/extrude/extrude.hpp"
#include "mansard/fracture/fracture.hpp"
#include "mansard/model/city.hpp"
#include "mansard/picture/picture.hpp"
#include "mansard/profile/profile.hpp"
#include "mansard/rays/rays.hpp"
#include "mansard/report/pictures.hpp"

namespace mansard::explore::detail {
namespace {

auto numbers_of(const report::BlockReport& block, const report::SegmentedBlock& segmented) -> Numbers {
  Numbers n;
  n.triangles = block.triangles;
  n.footprints = block.buildings;
  n.blocks = 1;
  n.optimal = block.status == "optimal" ? 1 : 0;
  n.sweep_edges = block.sweep_edges;
  n.faces = block.faces;
  n.inside_faces = block.inside_faces;
  n.candidates = block.candidates;
  n.conflicts = block.conflicts;
  n.variables = block.variables;
  n.reference_variables = reference_variables(segmented);
  n.parts = block.parts;
  n.terms = block.terms;
  n.objective = block.objective;
  n.bound = block.bound;
  n.scores = block.scores;
  if (segmented.segmentation) n.optimise_cpu_seconds = segmented.segmentation->solve_cpu_seconds;
  n.cpu_seconds = block.times.total.cpu_seconds;
  return n;
}

void add(const Numbers& block, Numbers& sum) {
  sum.blocks += block.blocks;
  sum.optimal += block.optimal;
  sum.sweep_edges += block.sweep_edges;
  sum.faces += block.faces;
  sum.inside_faces += block.inside_faces;
  sum.candidates += block.candidates;
  sum.conflicts += block.conflicts;
  sum.variables += block.variables;
  sum.reference_variables += block.reference_variables;
  sum.parts += block.parts;
  sum.terms += block.terms;
  sum.objective += block.objective;
  sum.bound += block.bound;
  sum.optimise_cpu_seconds += block.optimise_cpu_seconds;
}

/// Blocks know neither their buildings' outcomes nor the faces of their models.
void count_buildings(const report::Reconstruction& result, Row& row) {
  const auto in = [&](const std::string& block) -> Numbers* {
    const auto at = std::ranges::find(row.blocks, block, &BlockRow::name);
    return at == row.blocks.end() ? nullptr : &at->numbers;
  };
  const auto count = [](Numbers& n, report::Outcome outcome) {
    switch (outcome) {
      case report::Outcome::full: ++n.full; return;
      case report::Outcome::fallback: ++n.fallback; return;
      case report::Outcome::covered: ++n.covered; return;
      case report::Outcome::refused: ++n.refused; return;
    }
  };
  for (const auto& building : result.buildings) {
    count(row.numbers, building.outcome);
    Numbers* block = in(building.block);
    if (block != nullptr) count(*block, building.outcome);
    const auto model = std::ranges::find(result.city.buildings, building.id, &model::Building::id);
    if (model == result.city.buildings.end()) continue;
    for (const auto& part : model->parts) {
      row.numbers.model_faces += part.model.solid.faces.size();
      if (block != nullptr) block->model_faces += part.model.solid.faces.size();
      row.plan.push_back(model::polygon_of(part.plan));
    }
  }
}

/// The profile up to a height. Its last part goes on, a level one upwards.
auto up_to(model::Profile profile, double height) -> model::Profile {
  while (profile.size() > 2 && (profile.end() - 2)->height >= height) profile.pop_back();
  const auto before = *(profile.end() - 2), last = profile.back();
  const double rise = last.height - before.height;
  if (rise > 0)
    profile.back() = {before.inward + (height - before.height) * (last.inward - before.inward) / rise, height};
  else if (last.height < height) profile.push_back({last.inward, height});
  return profile;
}

void add_rises(const profile::ProfiledFootprint& part, const pipeline::Options& options, const base::Run& run,
               std::vector<Rise>& rises) {
  const auto& plan = part.plan;
  std::vector<double> length(plan.profiles.size(), 0);
  const auto add = [&](const model::PlanRing& ring) {
    for (std::size_t i = 0; i < ring.points.size(); ++i)
      length[ring.profile_of_edge[i]] += geometry::length(ring.points[(i + 1) % ring.points.size()] - ring.points[i]);
  };
  add(plan.outer);
  for (const auto& hole : plan.holes) add(hole);
  const auto crest = extrude::crest(plan, options.extrude, run);
  for (std::size_t i = 0; i < plan.profiles.size(); ++i)
    rises.push_back({up_to(plan.profiles[i], crest ? *crest : plan.cap), length[i], part.evidence[i].slices,
                     part.evidence[i].attempted});
}

auto rises_of(const report::Reconstruction& result, const model::Scene& scene, const pipeline::Options& options,
              const base::Run& run) -> std::vector<Rise> {
  std::vector<Rise> rises;
  auto profiling = options.profile;
  profiling.assumed_height = options.assumed_height;
  for (const auto& block : block::partition(scene, options.block, run)) {
    const auto segmented = std::ranges::find(result.segmented, block.name, &report::SegmentedBlock::name);
    if (segmented == result.segmented.end() || !segmented->segmentation) continue;
    const rays::Scene mesh(block.mesh);
    for (const auto& part : profile::fit(*segmented->segmentation, block, mesh, profiling, run))
      add_rises(part, options, run, rises);
  }
  return rises;
}

void add_picture(const picture::Image& image, std::string name, std::string alt, Row& row) {
  auto bytes = picture::png(image);
  if (bytes) row.pictures.push_back({std::move(name), std::move(alt), std::move(*bytes)});
  else row.warnings.push_back(bytes.error());
}

constexpr auto error_alt =
    "vertical error, model minus mesh: blue where the model is too low, red where it is too high";

void draw(const report::Reconstruction& result, const model::Scene& scene, const Request& request, std::size_t number,
          const base::Run& run, Row& row) {
  const std::string prefix = "run-" + std::to_string(number) + "-";
  if (request.experiment == Experiment::datasets) {
    const auto pictures = report::pictures(result, scene, request.error_limit, run);
    if (pictures) {
      add_picture(pictures->angle, prefix + "angle.png", "scan with footprints, and models, at an angle", row);
      add_picture(pictures->above, prefix + "above.png", "scan with footprints, and models, from above", row);
      add_picture(pictures->error, prefix + "error.png", error_alt, row);
    } else {
      row.warnings.push_back(pictures.error());
    }
  }
  if (!request.axes.empty()) {
    picture::View view;
    const bool large = request.experiment == Experiment::quality;
    view.width = large ? 1000 : 600, view.height = large ? 750 : 450;
    add_picture(report::picture_of(result.city, view, run), prefix + "models.png", "models at an angle", row);
    const auto map = evaluate::merged(result.error_maps);
    add_picture(picture::error_map(map.difference, map.columns, map.rows, request.error_limit, "model - mesh, m"),
                prefix + "error.png", error_alt, row);
  }
}

auto quoted(const std::string& word) -> std::string {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("-_./=:,+@%").find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::ranges::all_of(word, plain)) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// As it is typed: several numbers are several words.
auto typed(const std::string& key, const std::string& value, bool words) -> std::string {
  std::string name = "--" + key;
  std::ranges::replace(name, '.', '-');
  std::ranges::replace(name, '_', '-');
  return name + " " + (words ? value : quoted(value));
}

}  // namespace

auto reference_variables(const report::SegmentedBlock& block) -> std::size_t {
  if (!block.segmentation) return 0;
  const auto& faces = block.segmentation->faces;
  const auto inside = [&](const fracture::HalfEdge& h) { return h.face && faces[*h.face].inside; };
  std::size_t around = 0, interior = 0;
  for (const auto& half : block.arrangement.half_edges) {
    if (!inside(half)) continue;
    ++around;
    interior += inside(block.arrangement.half_edges[half.twin]) ? 1 : 0;
  }
  const auto face_count = static_cast<std::size_t>(std::ranges::count_if(faces, &segment::FaceEvidence::inside));
  return 6 * face_count + 4 * around + 6 * interior + block.segmentation->conflicts.size();
}

auto measure(const model::Scene& scene, const pipeline::Options& options, const Request& request, std::size_t number,
             const base::Run& run) -> Row {
  Row row;
  auto result = pipeline::reconstruct(scene, options, run, pipeline::Keep::segmentations);
  if (!result) {
    row.failure = result.error();
    return row;
  }
  for (std::size_t i = 0; i < result->blocks.size(); ++i) {
    row.blocks.push_back({result->blocks[i].name, numbers_of(result->blocks[i], result->segmented[i])});
    add(row.blocks.back().numbers, row.numbers);
  }
  row.numbers.triangles = scene.mesh.triangles.size();
  row.numbers.footprints = scene.footprints.size();
  row.numbers.scores = result->scores;
  row.numbers.cpu_seconds = result->times.total.cpu_seconds;
  count_buildings(*result, row);
  row.warnings = result->warnings;
  if (request.experiment == Experiment::profiles) row.profiles = rises_of(*result, scene, options, run);
  if (request.pictures) draw(*result, scene, request, number, run, row);
  return row;
}

auto values_of(pipeline::Options options) -> Setting {
  Setting values;
  for (const auto& list : pipeline::option_lists(options))
    for (const auto& option : list.options()) values.emplace_back(list.module() + "." + option.name, option.get());
  return values;
}

auto quoted(const std::vector<std::string>& words) -> std::string {
  std::string all;
  for (const auto& word : words) all += (all.empty() ? "" : " ") + quoted(word);
  return all;
}

auto with(pipeline::Options options, const Setting& setting) -> base::Result<pipeline::Options> {
  auto lists = pipeline::option_lists(options);
  for (const auto& [key, value] : setting)
    if (auto set = pipeline::set_option(lists, key, value); !set) return set.error();
  return options;
}

auto command_of(const Dataset& dataset, pipeline::Options options) -> std::string {
  std::string command = "mansard reconstruct";
  for (const auto& mesh : dataset.meshes) command += " " + quoted(mesh.string());
  command += " " + quoted(dataset.footprints.string());
  pipeline::Options defaults;
  const auto before = pipeline::option_lists(defaults);
  const auto now = pipeline::option_lists(options);
  for (std::size_t module = 0; module < now.size(); ++module)
    for (const auto& option : now[module].options()) {
      const auto usual = before[module].find(option.name)->get();
      if (option.get() == usual) continue;
      const bool words = option.kind == base::Option::Kind::string && usual.find(' ') != std::string::npos;
      command += " " + typed(now[module].module() + "." + option.name, option.get(), words);
    }
  return command + " -o out";
}

}  // namespace mansard::explore::detail
