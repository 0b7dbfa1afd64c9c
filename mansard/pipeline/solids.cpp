#include "mansard/pipeline/solids.hpp"

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
    auto& [solids, warnings, simplified] = out[b];
    for (auto& one : united[b].solids) {
      for (auto& p : one.of) p = numbers[b][p];
      solids.push_back({std::move(one.of), std::move(one.model)});
    }
    for (const auto p : united[b].simplified) {
      simplified.push_back(numbers[b][p]);
      for (const auto& solid : solids)
        if (solid.parts == std::vector{simplified.back()}) *buildings[b][simplified.back()] = solid.model;
    }
    warnings = std::move(united[b].warnings);
  }
  return out;
}

auto unite_parts(std::span<model::Building> buildings) -> std::vector<SolidsOf> {
  std::vector<std::vector<LabelledSolid*>> models(buildings.size());
  for (std::size_t b = 0; b < buildings.size(); ++b)
    for (auto& part : buildings[b].parts) models[b].push_back(&part.model);
  return unite_parts(models);
}

}  // namespace mansard::pipeline
