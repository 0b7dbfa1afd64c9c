#include "mansard/pipeline/solids.hpp"

#include <algorithm>
#include <ranges>

#include "mansard/base/run.hpp"
#include "mansard/model/append.hpp"
#include "mansard/solid/eaves.hpp"
#include "mansard/solid/stack.hpp"
#include "mansard/solid/unite.hpp"

namespace mansard::pipeline {

using model::LabelledSolid;

namespace {

/// What a union is made of: the parts of a building, or of one of the layers of a building whose parts are stacked.
struct Layer {
  std::size_t building = 0;
  std::vector<const LabelledSolid*> models;
  std::vector<std::size_t> numbers;  ///< the part that each model is of, by its place in the building
};

/// `owned` keeps the pieces of stacked parts.
auto layers_of(std::span<const std::vector<LabelledSolid*>> buildings, std::vector<std::vector<solid::Stacked>>& owned)
    -> std::vector<Layer> {
  std::vector<Layer> whole(buildings.size());
  for (std::size_t b = 0; b < buildings.size(); ++b) {
    whole[b].building = b;
    for (std::size_t p = 0; p < buildings[b].size(); ++p) {
      if (buildings[b][p]->solid.faces.empty()) continue;
      whole[b].models.push_back(buildings[b][p]);
      whole[b].numbers.push_back(p);
    }
  }
  owned.resize(buildings.size());
  base::parallel_for(buildings.size(), [&](std::size_t b) { owned[b] = solid::stack(whole[b].models); });
  std::vector<Layer> out;
  for (std::size_t b = 0; b < buildings.size(); ++b) {
    if (owned[b].empty()) {
      out.push_back(std::move(whole[b]));
      continue;
    }
    const std::size_t first = out.size();
    for (const auto& piece : owned[b]) {
      while (out.size() <= first + piece.layer) out.push_back({b, {}, {}});
      out[first + piece.layer].models.push_back(&piece.model);
      out[first + piece.layer].numbers.push_back(whole[b].numbers[piece.part]);
    }
  }
  return out;
}

/// Parts that are in no solid of any layer.
void settle_pieces(const std::vector<std::size_t>& lost, SolidsOf& made) {
  for (const auto p : lost)
    if (std::ranges::find(made.lost, p) == made.lost.end() && std::ranges::none_of(made.solids, [&](const auto& one) {
          return std::ranges::find(one.parts, p) != one.parts.end();
        }))
      made.lost.push_back(p);
  std::ranges::sort(made.lost);
}

}  // namespace

auto unite_parts(std::span<const std::vector<LabelledSolid*>> buildings) -> std::vector<SolidsOf> {
  std::vector<std::vector<solid::Stacked>> owned;
  const auto layers = layers_of(buildings, owned);
  std::vector<std::vector<const LabelledSolid*>> models;
  std::vector<std::size_t> of;
  for (const auto& layer : layers) {
    models.push_back(layer.models);
    of.push_back(layer.building);
  }
  auto united = solid::unite_all(models, of);
  std::vector<SolidsOf> out(buildings.size());
  std::vector<std::vector<std::size_t>> lost(buildings.size());
  for (std::size_t l = 0; l < united.size(); ++l) {
    const auto& numbers = layers[l].numbers;
    const std::size_t b = layers[l].building;
    const bool stacked = !owned[b].empty();
    auto& made = out[b];
    for (auto& one : united[l].solids) {
      for (auto& p : one.of) p = numbers[p];
      std::ranges::sort(one.of);
      one.of.erase(std::unique(one.of.begin(), one.of.end()), one.of.end());
      for (auto& p : one.part_of_face) p = static_cast<std::uint32_t>(numbers[p]);
      made.solids.push_back({std::move(one.of), std::move(one.model), std::move(one.part_of_face)});
    }
    for (const auto p : united[l].simplified) {
      if (stacked) continue;  // it may be one piece of several: the part keeps its model
      made.simplified.push_back(numbers[p]);
      auto& model = *buildings[b][made.simplified.back()];
      model = {};
      for (const auto& solid : made.solids)
        if (solid.parts == std::vector{made.simplified.back()}) model::append(solid.model, model);
    }
    for (const auto p : united[l].lost) lost[b].push_back(numbers[p]);
    for (auto& warning : united[l].warnings)
      // Of what stands on another part, both are on its ground.
      if (!stacked || warning.code != "solid-parted") made.warnings.push_back(std::move(warning));
  }
  base::parallel_for(buildings.size(), [&](std::size_t b) {
    settle_pieces(lost[b], out[b]);
    if (owned[b].empty()) return;
    std::ranges::stable_sort(out[b].solids, {}, [](const auto& one) { return one.parts.front(); });
    std::vector<const LabelledSolid*> solids;
    for (const auto& one : out[b].solids) solids.push_back(&one.model);
    for (auto& found : solid::overlapping(solids)) {
      found.what.severity = base::Severity::warning;
      out[b].warnings.push_back(std::move(found.what));
    }
  });
  return out;
}

auto unite_parts(std::span<model::Building> buildings) -> std::vector<SolidsOf> {
  std::vector<std::vector<LabelledSolid*>> models(buildings.size());
  for (std::size_t b = 0; b < buildings.size(); ++b)
    for (auto& part : buildings[b].parts) models[b].push_back(&part.model);
  auto out = unite_parts(models);
  base::parallel_for(buildings.size(), [&](std::size_t b) {
    std::vector<const model::Plan*> plans;
    for (const auto& part : buildings[b].parts) plans.push_back(&part.plan);
    out[b] = with_eaves(std::move(out[b]), plans);
  });
  return out;
}

void renumber(SolidsOf& made) {
  const auto number = [&](std::size_t& p) {
    p -= static_cast<std::size_t>(std::ranges::count_if(made.lost, [&](std::size_t lost) { return lost < p; }));
  };
  for (auto& one : made.solids) {
    std::ranges::for_each(one.parts, number);
    for (auto& p : one.part_of_face)
      p -= static_cast<std::uint32_t>(std::ranges::count_if(made.lost, [&](std::size_t lost) { return lost < p; }));
  }
  std::ranges::for_each(made.simplified, number);
}

void drop_lost(model::Building& building, SolidsOf& made) {
  for (const std::size_t p : made.lost | std::views::reverse)
    building.parts.erase(building.parts.begin() + static_cast<std::ptrdiff_t>(p));
  renumber(made);
}

namespace {

/// The edges of a plan that have eaves.
void add_eaves(const model::Plan& plan, std::vector<solid::Eaves>& wanted) {
  const auto add = [&](const model::PlanRing& ring) {
    for (std::size_t i = 0; i < ring.overhang_of_edge.size(); ++i)
      if (ring.overhang_of_edge[i] > 0)
        wanted.push_back({ring.points[i], ring.points[(i + 1) % ring.points.size()], ring.overhang_of_edge[i]});
  };
  add(plan.outer);
  for (const auto& hole : plan.holes) add(hole);
}

}  // namespace

auto has_overhangs(const model::Plan& plan) -> bool {
  std::vector<solid::Eaves> wanted;
  add_eaves(plan, wanted);
  return !wanted.empty();
}

auto with_eaves(SolidsOf made, std::span<const model::Plan* const> plans) -> SolidsOf {
  for (auto& one : made.solids) {
    std::vector<solid::Eaves> wanted;
    for (const auto p : one.parts)
      // What became a prism has no roof that could overhang.
      if (std::ranges::find(made.simplified, p) == made.simplified.end()) add_eaves(*plans[p], wanted);
    if (wanted.empty()) continue;
    // Eaves that extrude.overhang made.
    if (std::ranges::find(one.model.classes, model::FaceClass::soffit) != one.model.classes.end()) continue;
    auto eaves = solid::with_eaves(one.model, wanted);
    if (eaves.model.solid.faces.size() != one.part_of_face.size()) one.part_of_face.clear();
    one.model = std::move(eaves.model);
    for (const auto& why : eaves.left)
      made.warnings.push_back(base::warning("pipeline-overhang", "some eaves do not overhang: " + why));
  }
  return made;
}

}  // namespace mansard::pipeline
