// Puts the parts of all blocks together as buildings, with their attributes and their reports.
#pragma once

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

/// Gives a building its solids. Where they are several, or simpler, the reasons of its report say so. `z0` is the
/// height of the frame's origin, for attributes.
void add_solids(model::Building& building, report::BuildingReport& report, SolidsOf made, double z0);

void add(label::Areas& sum, const label::Areas& more);
/// Of mansard.
[[nodiscard]] auto version() -> std::string;
/// Version, inputs and every option.
[[nodiscard]] auto made_by(const model::Scene& scene, const Options& options) -> model::MadeBy;

}  // namespace mansard::pipeline::detail
