#include "mansard/pipeline/solids.hpp"

#include "mansard/solid/unite.hpp"

namespace mansard::pipeline {

auto unite_parts(std::span<model::Building> buildings) -> std::vector<SolidsOf> {
  std::vector<std::vector<const model::LabelledSolid*>> models(buildings.size());
  std::vector<std::vector<std::size_t>> numbers(buildings.size());
  for (std::size_t b = 0; b < models.size(); ++b)
    for (std::size_t p = 0; p < buildings[b].parts.size(); ++p) {
      const auto& model = buildings[b].parts[p].model;
      if (model.solid.faces.empty()) continue;
      models[b].push_back(&model);
      numbers[b].push_back(p);
    }
  auto united = solid::unite_all(models);
  std::vector<SolidsOf> out;
  for (std::size_t b = 0; b < united.size(); ++b) {
    auto& solids = buildings[b].solids;
    solids.clear();
    for (auto& one : united[b].solids) {
      for (auto& p : one.of) p = numbers[b][p];
      solids.push_back({std::move(one.of), std::move(one.model)});
    }
    for (auto& p : united[b].simplified) {
      p = numbers[b][p];
      for (const auto& solid : solids)
        if (solid.parts == std::vector{p}) buildings[b].parts[p].model = solid.model;
    }
    if (united[b].warnings.empty()) continue;
    for (auto& warning : united[b].warnings) warning.subject = buildings[b].id;
    out.push_back({b, std::move(united[b].warnings), std::move(united[b].simplified)});
  }
  return out;
}

}  // namespace mansard::pipeline
