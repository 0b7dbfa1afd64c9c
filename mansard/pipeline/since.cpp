#include "mansard/pipeline/since.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "mansard/accuracy/accuracy.hpp"
#include "mansard/base/stopped.hpp"
#include "mansard/block/block.hpp"
#include "mansard/model/find.hpp"
#include "mansard/model/move.hpp"
#include "mansard/pipeline/detail/assemble.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::pipeline {
namespace {

using compare::Change;

/// The footprints and the scan as a state without models.
auto state_of(const model::Scene& scene, const Options& options) -> compare::State {
  compare::State out;
  std::vector<geometry::Polygon> outlines;
  for (const auto& footprint : scene.footprints) {
    auto& building = out.buildings.emplace_back();
    building.id = footprint.id;
    if (footprint.defect) continue;
    building.outline = footprint.polygons;
    outlines.insert(outlines.end(), footprint.polygons.begin(), footprint.polygons.end());
  }
  out.scan = scene.mesh;
  out.accuracy = accuracy::measure(scene.mesh, rays::Scene(scene.mesh), outlines, options.accuracy);
  return out;
}

/// Whether an old building may stand for a new one.
auto is_as_it_was(const Since& since, const compare::State& now, const Change& change) -> bool {
  constexpr double covered = 0.5;
  if (change.kind != compare::Kind::unchanged || change.old.size() != 1 || change.differing > 0) return false;
  if (change.new_seen < covered) return false;
  const auto& old = since.old.city->buildings[change.old.front()];
  const bool has_model =
      std::ranges::any_of(old.parts, [](const auto& part) { return !part.model.solid.faces.empty(); });
  const auto area = [](const std::vector<geometry::Polygon>& outline) {
    double sum = 0;
    for (const auto& polygon : outline) sum += geometry::area(polygon);
    return sum;
  };
  // Of both outlines together, by their areas alone: what one has more than the other is among the cells that differ.
  constexpr double alike = 0.8;
  const double before = area(since.old.state.buildings[change.old.front()].outline),
               after = area(now.buildings[change.now.front()].outline);
  return has_model && std::min(before, after) >= alike * std::max(before, after);
}

/// Which block every footprint is in, by name, in the order of the blocks.
auto blocks_of(const model::Scene& scene, const Options& options, const base::Run& run, compare::State& now)
    -> std::vector<std::pair<std::string, std::vector<std::size_t>>> {
  std::vector<std::pair<std::string, std::vector<std::size_t>>> out;
  const block::Partition partition(scene, options.block, run);
  for (std::size_t i = 0; i < partition.size() && !run.cancelled(); ++i) {
    const auto block = partition.make(i);
    auto& [name, features] = out.emplace_back(block.name, std::vector<std::size_t>());
    for (const auto& member : block.members) {
      if (member.feature >= scene.footprints.size()) continue;
      features.push_back(member.feature);
      now.buildings[member.feature].ground = member.ground;
    }
  }
  return out;
}

// ---- an old building in the new city

/// What the earlier run said of it, as far as its attributes have it.
auto report_of(const model::Building& building, const std::string& block, bool derived) -> report::BuildingReport {
  report::BuildingReport out;
  const auto& all = building.attributes;
  const auto real = [&](const char* name) -> std::optional<double> {
    const auto* number = model::find<double>(all, name);
    return number != nullptr ? std::optional(*number) : std::nullopt;
  };
  const auto text = [&](const char* name) {
    const auto* found = model::find<std::string>(all, name);
    return found != nullptr ? *found : std::string();
  };
  out.id = building.id;
  out.block = block;
  out.derived = derived;
  out.outcome = text("ms_outcome") == "fallback" ? report::Outcome::fallback : report::Outcome::full;
  out.parts = building.parts.size();
  out.ground = real("ms_h_ground").value_or(0);
  out.roof_min = real("ms_h_roof_min").value_or(0);
  out.roof_max = real("ms_h_roof_max").value_or(0);
  out.ground_mean = real("ms_h_ground_mean");
  out.ground_max = real("ms_h_ground_max");
  out.ground_source = text("ms_ground_source");
  out.volume = real("ms_volume_lod22").value_or(0);
  out.areas.wall = real("ms_area_wall").value_or(0);
  out.areas.party_wall = real("ms_area_party_wall").value_or(0);
  out.areas.roof_flat = real("ms_area_roof_flat").value_or(0);
  out.areas.roof_sloped = real("ms_area_roof_sloped").value_or(0);
  out.areas.ground = real("ms_area_ground").value_or(0);
  out.rmse = real("ms_rmse_lod22");
  if (const auto right = real("ms_confidence"))
    out.confidence = confidence::Confidence{*right, real("ms_error").value_or(0), {}};
  return out;
}

/// The attributes of the new footprint, then those that describe the model.
auto taken_over(const model::Building& old, const model::Footprint& footprint, const Since& since) -> model::Building {
  auto out = old;
  out.id = footprint.id;
  out.attributes = footprint.attributes;
  std::set<std::string> own;
  for (const auto& [name, value] : out.attributes) own.insert(name);
  constexpr std::array of_citygml{"measuredHeight", "roofType", "storeysAboveGround"};
  for (const auto& [name, value] : old.attributes) {
    const bool of_model = name.starts_with("ms_") || std::ranges::find(of_citygml, name) != of_citygml.end();
    if (of_model && name != "ms_kept_from" && own.insert(name).second) out.attributes.emplace_back(name, value);
  }
  out.attributes.emplace_back("ms_kept_from", since.old.path.string());
  for (std::size_t p = 0; p < out.parts.size(); ++p) out.parts[p].id = footprint.part_id(p + 1);
  return out;
}

}  // namespace

auto find_changed(const model::Scene& scene, const std::filesystem::path& old, const Options& options,
                  const base::Run& run) -> base::Result<Since> {
  auto read = read_state(old, {{}, false, true}, options, run);
  if (!read) return read.failure();
  Since out;
  out.old = std::move(*read);
  if (!out.old.own || !out.old.city)
    return base::error("since-models",
                       "these models have no plans, so that they cannot be taken over; give a folder of 'mansard "
                       "reconstruct'",
                       old.string());
  StateFiles now;
  now.frame = scene.frame;
  now.state = state_of(scene, options);
  const auto blocks = blocks_of(scene, options, run, now.state);
  const auto by = model::between(out.old.frame, scene.frame);
  if (auto one = in_one_frame(out.old, now); !one) return one.failure();
  for (auto& building : out.old.city->buildings) model::move(building, by);
  out.found = compare::changes(out.old.state, now.state, {}, run);
  if (run.cancelled()) return base::stopped();

  // What differs of old buildings that no footprint has any more is not seen in the blocks: they are gone.
  std::vector<const Change*> of(scene.footprints.size(), nullptr);
  for (const auto& change : out.found.changes)
    if (!change.now.empty()) of[change.now.front()] = &change;
  out.kept.resize(scene.footprints.size());
  out.all_blocks = blocks.size();
  for (const auto& [name, features] : blocks) {
    const bool as_it_was = std::ranges::all_of(
        features, [&](std::size_t f) { return of[f] != nullptr && is_as_it_was(out, now.state, *of[f]); });
    std::set<std::uint32_t> old_ones;
    if (as_it_was)
      for (const auto f : features) old_ones.insert(of[f]->old.front());
    if (!as_it_was || old_ones.size() != features.size()) {
      out.blocks.push_back(name);
      continue;
    }
    for (const auto f : features) out.kept[f] = of[f]->old.front();
  }
  return out;
}

auto reconstruct_since(const model::Scene& scene, const Since& since, const Options& options, const base::Run& run,
                       Keep keep, const Schedule& schedule) -> base::Result<report::Reconstruction> {
  report::Reconstruction out;
  if (!since.blocks.empty()) {
    auto made = reconstruct(scene, options, run, keep, since.blocks, schedule);
    if (!made) return made;
    out = std::move(*made);
  }
  std::map<std::string, std::size_t> place;
  for (std::size_t i = 0; i < out.buildings.size(); ++i) place[out.buildings[i].id] = i;
  std::vector<model::Building> buildings;
  std::vector<report::BuildingReport> reports;
  for (std::size_t f = 0; f < scene.footprints.size(); ++f) {
    const auto& footprint = scene.footprints[f];
    if (const auto old = since.kept[f]) {
      buildings.push_back(taken_over(since.old.city->buildings[*old], footprint, since));
      reports.push_back(report_of(buildings.back(), "", footprint.derived));
    } else if (const auto found = place.find(footprint.id); found != place.end()) {
      buildings.push_back(std::move(out.city.buildings[found->second]));
      reports.push_back(std::move(out.buildings[found->second]));
    } else {
      auto none = detail::unbuilt(scene, f, options);
      buildings.push_back(std::move(none.building));
      reports.push_back(std::move(none.report));
    }
  }
  out.city.frame = scene.frame;
  out.city.made_by = detail::made_by(scene, options);
  out.city.buildings = std::move(buildings);
  out.buildings = std::move(reports);
  return out;
}

}  // namespace mansard::pipeline
