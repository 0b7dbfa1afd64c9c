// Which sides become sweep-edges.
#pragma once

#include <vector>

#include "mansard/block/block.hpp"
#include "mansard/sweep/detail/clusters.hpp"
#include "mansard/sweep/sweep.hpp"

namespace mansard::sweep::detail {

/// Puts sides together that stand on one line, drops those below gamma and those far from the outline; the rest stand
/// on the ground as sweep-edges, longest first.
[[nodiscard]] auto select_edges(std::vector<std::vector<WeighedLine>> sides, const slice::SliceStack& stack,
                                const block::Block& block, const Options& options) -> SweepEdges;

/// Ties by coordinates, then by cluster.
void sort_longest_first(std::vector<SweepEdge>& edges);

}  // namespace mansard::sweep::detail
