// What of a footprint is high enough for a building and has no model.
#pragma once

#include "mansard/pipeline/detail/block_run.hpp"

namespace mansard::pipeline::detail {

/// Adds one to `out.left_out` for every feature of which more than 1 m² has no part although the mesh is at least
/// segment.min_height above the ground there; with the reasons that the segmentation gave.
void add_left_out(const block::Block& block, const segment::Segmentation& segmentation, const rays::Scene& mesh,
                  const Options& options, const std::vector<PartResult>& parts, BlockResult& out);

}  // namespace mansard::pipeline::detail
