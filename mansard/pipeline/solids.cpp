#include "mansard/pipeline/solids.hpp"

#include <algorithm>
#include <ranges>

#include "mansard/base/run.hpp"
#include "mansard/model/append.hpp"
#include "mansard/solid/eaves.hpp"
#include "mansard/solid/unite.hpp"

namespace mansard::pipeline {

using model::LabelledSolid;

auto unite_parts(std::span<const std::vector<LabelledSolid*>> buildings) -> std::vector<SolidsOf> {
  std::vector<std::vector<const LabelledSolid*>> models(buildings.size());
  std::vector<std::vector<std::size_t>> numbers(buildings.size());
  for (std::size_t b = 0; b < models.size(); ++b)
    for (std::size_t p = 0; p < buildings[b].size(); ++p) {
      if (buildings[b][p]->solid.faces.empty()) continue;
      models[b].push_back(buildings[b][p]);
      numbers[b].push_back(p);
    }
  auto united = solid::unite_all(models);
  std::vector<SolidsOf> out(buildings.size());
  for (std::size_t b = 0; b < united.size(); ++b) {
    auto& [solids, warnings, simplified, lost] = out[b];
    for (auto& one : united[b].solids) {
      for (auto& p : one.of) p = numbers[b][p];
      solids.push_back({std::move(one.of), std::move(one.model)});
    }
    for (const auto p : united[b].simplified) {
      simplified.push_back(numbers[b][p]);
      auto& model = *buildings[b][simplified.back()];
      model = {};
      for (const auto& solid : solids)
        if (solid.parts == std::vector{simplified.back()}) model::append(solid.model, model);
    }
    for (const auto p : united[b].lost) lost.push_back(numbers[b][p]);
    warnings = std::move(united[b].warnings);
  }
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
  for (auto& one : made.solids) std::ranges::for_each(one.parts, number);
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
    one.model = std::move(eaves.model);
    for (const auto& why : eaves.left)
      made.warnings.push_back(base::warning("pipeline-overhang", "some eaves do not overhang: " + why));
  }
  return made;
}

}  // namespace mansard::pipeline
