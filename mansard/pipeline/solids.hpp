// The solids that are written of buildings.
#pragma once

#include <span>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/model/city.hpp"

namespace mansard::pipeline {

/// A building's solids, and what came otherwise than as one valid solid of all its parts: codes of solid::unite.
struct SolidsOf {
  std::vector<model::PartsSolid> solids;
  std::vector<base::Diagnostic> warnings;  ///< without subject
  std::vector<std::size_t> simplified;     ///< parts whose model is a prism now
  std::vector<std::size_t> lost;           ///< parts of which there is no valid solid
};

/// Numbers of parts as they are without those that are lost: nothing is measured of what no file has, so that these are
/// no parts of the building any more.
void renumber(SolidsOf& made);
/// Takes the lost parts off their building, and renumbers the others.
void drop_lost(model::Building& building, SolidsOf& made);

/// Overhanging eaves where the plans of a building have them, on its solids. "pipeline-overhang" where they cannot be
/// made, which leaves the solid there as it was. `plans`: of the building's parts.
[[nodiscard]] auto with_eaves(SolidsOf made, std::span<const model::Plan* const> plans) -> SolidsOf;
[[nodiscard]] auto has_overhangs(const model::Plan& plan) -> bool;

/// Of every building, the union of its parts (solid::unite_all), over one plan of each group of buildings that touch.
/// `buildings[b]` are the models of the parts of b. Those of simplified parts become prisms.
[[nodiscard]] auto unite_parts(std::span<const std::vector<model::LabelledSolid*>> buildings) -> std::vector<SolidsOf>;
/// The same, with the overhanging eaves of the plans.
[[nodiscard]] auto unite_parts(std::span<model::Building> buildings) -> std::vector<SolidsOf>;

}  // namespace mansard::pipeline
