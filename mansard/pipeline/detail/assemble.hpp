// Puts the parts of all blocks together as buildings, with their attributes and their reports.
#pragma once

#include <vector>

#include "mansard/pipeline/detail/block_run.hpp"

namespace mansard::pipeline::detail {

/// `results[i]` belongs to `blocks[i]`. Fills the city, the reports and the warnings.
[[nodiscard]] auto assemble(const ingest::Scene& scene, const std::vector<block::Block>& blocks,
                            std::vector<BlockResult> results, const Options& options) -> Reconstruction;

}  // namespace mansard::pipeline::detail
