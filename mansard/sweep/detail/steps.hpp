// Roof steps: straight lines along which the top surface jumps inside the footprints.
#pragma once

#include <vector>

#include "mansard/block/block.hpp"
#include "mansard/rays/rays.hpp"
#include "mansard/sweep/sweep.hpp"

namespace mansard::sweep::detail {

/// The roof steps that no wall and no footprint's edge stands for already, longest first; without clusters.
[[nodiscard]] auto roof_steps(const block::Block& block, const rays::Scene& mesh, const SweepEdges& walls,
                              const Options& options, const base::Run& run) -> std::vector<SweepEdge>;

}  // namespace mansard::sweep::detail
