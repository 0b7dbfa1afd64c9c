// Puts the parts of a block together as buildings, with their attributes and their reports.
#pragma once

#include <utility>
#include <vector>

#include "mansard/pipeline/detail/block_run.hpp"

namespace mansard::pipeline::detail {

/// A feature as it is written and as it is reported.
struct Finished {
  model::Building building;
  report::BuildingReport report;
};

/// A feature of which no block is known: what is wrong with it, if anything.
[[nodiscard]] auto unbuilt(const model::Scene& scene, std::size_t feature, const Options& options) -> Finished;

/// The features of a block with what was made of them, by their numbers. Moves the parts out of `result`. Appends to
/// `warnings` what the run says of the block.
[[nodiscard]] auto finish_block(const model::Scene& scene, BlockResult& result, const Options& options,
                                std::vector<base::Diagnostic>& warnings)
    -> std::vector<std::pair<std::size_t, Finished>>;

/// Files have 0.1 mm: what is checked is what is written.
[[nodiscard]] inline auto with_grid(extrude::Options options) -> extrude::Options {
  options.grid = 1e-4;
  return options;
}

/// Gives a building its solids. Where they are several, or simpler, the reasons of its report say so. `z0` is the
/// height of the frame's origin, for attributes.
void add_solids(model::Building& building, report::BuildingReport& report, SolidsOf made, double z0);

/// Takes the parts of a building that are lost off it and off those that fell short; they are refused.
void drop_lost(RaisedPlans& raised, std::size_t building, SolidsOf& made);

/// The attributes of the whole building, by its report and its solids, in the heights of a frame with its origin at
/// `z0`. `measures` are those that took the mesh, or the levels of detail. After everything else is known of it.
void add_attributes(model::Building& building, const report::BuildingReport& report, const model::Attributes& measures,
                    const Options& options, double z0);

void add(label::Areas& sum, const label::Areas& more);
/// Of mansard.
[[nodiscard]] auto version() -> std::string;
/// Version, inputs and every option.
[[nodiscard]] auto made_by(const model::Scene& scene, const Options& options) -> model::MadeBy;

}  // namespace mansard::pipeline::detail
