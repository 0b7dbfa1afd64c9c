// Puts the parts of all blocks together as buildings, with their attributes and their reports.
#pragma once

#include <span>
#include <vector>

#include "mansard/pipeline/detail/block_run.hpp"

namespace mansard::pipeline::detail {

/// `results[i]` belongs to `blocks[i]`. Fills the city, the reports and the warnings.
[[nodiscard]] auto assemble(const model::Scene& scene, const std::vector<block::Block>& blocks,
                            std::vector<BlockResult> results, const Options& options) -> report::Reconstruction;

/// Files have 0.1 mm: what is checked is what is written.
[[nodiscard]] inline auto with_grid(extrude::Options options) -> extrude::Options {
  options.grid = 1e-4;
  return options;
}

/// Gives the buildings their solids; `reports[i]` is on `buildings[i]`. Of a building that is more than one solid, or a
/// simpler one, the reasons say so. `z0` is the height of the frame's origin, for attributes.
void add_solids(std::span<model::Building> buildings, std::span<report::BuildingReport> reports, double z0);

void add(label::Areas& sum, const label::Areas& more);
/// Of mansard.
[[nodiscard]] auto version() -> std::string;
/// Version, inputs and every option.
[[nodiscard]] auto made_by(const model::Scene& scene, const Options& options) -> model::MadeBy;

}  // namespace mansard::pipeline::detail
