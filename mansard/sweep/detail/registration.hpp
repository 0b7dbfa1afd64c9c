// Where the footprints lie beside the walls that the mesh shows.
#pragma once

#include <vector>

#include "mansard/block/block.hpp"
#include "mansard/sweep/sweep.hpp"

namespace mansard::sweep::detail {

/// Reads from the sweep-edges that run along the footprints' outline by how much all footprints are displaced, and how
/// near to their walls they are then.
[[nodiscard]] auto register_footprints(const std::vector<SweepEdge>& edges, const block::Block& block,
                                       const Options& options) -> Registration;

/// Of all footprints, displaced by the registration, turned so that outside is on the left.
[[nodiscard]] auto edges_of_footprints(const block::Block& block, const Registration& registration)
    -> std::vector<geometry::Segment2>;

/// Sweep-edges that follow footprints' edges, displaced by the registration, are put on them, piece by piece where the
/// outline bends; the others stay as they are. Pieces share their edge's area by length.
[[nodiscard]] auto put_on_footprints(const std::vector<SweepEdge>& edges, const block::Block& block,
                                     const Registration& registration, const Options& options)
    -> std::vector<SweepEdge>;

}  // namespace mansard::sweep::detail
