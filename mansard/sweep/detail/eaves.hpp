// Walls under eaves that end inside of a footprint.
#pragma once

#include <vector>

#include "mansard/block/block.hpp"
#include "mansard/rays/rays.hpp"
#include "mansard/sweep/sweep.hpp"

namespace mansard::sweep::detail {

/// Walls more than `gis_inward` inside of a footprint's edge, under eaves that end as far inside of it, are moved
/// outward to where these end as seen from above: between them would be a strip that is half roof and half ground.
/// Order and number of edges stay.
[[nodiscard]] auto moved_under_eaves(std::vector<SweepEdge> edges, const block::Block& block,
                                     const Registration& registration, const rays::Scene& mesh, const Options& options)
    -> std::vector<SweepEdge>;

}  // namespace mansard::sweep::detail
