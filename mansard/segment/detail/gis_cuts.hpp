// Lines the mesh may not show but the GIS knows: where two features touch, and where walls are torn.
#pragma once

#include <vector>

#include "mansard/block/block.hpp"
#include "mansard/geometry/points.hpp"
#include "mansard/segment/options.hpp"
#include "mansard/sweep/sweep.hpp"

namespace mansard::segment::detail {

/// The stretches of members' edges that run along another member's boundary, one of the two where both know the
/// stretch: the one of the member listed first. Longest first; ties by coordinates.
[[nodiscard]] auto party_lines(const block::Block& block, const Options& options) -> std::vector<geometry::Segment2>;

/// The stretches of the members' other edges on which no sweep-edge stands: walls the mesh does not show, because
/// they are torn, too low, or cut off at the end of a tile, and walls it shows elsewhere. Longest first; ties by
/// coordinates.
[[nodiscard]] auto torn_lines(const block::Block& block, const sweep::SweepEdges& sweeps, const Options& options)
    -> std::vector<geometry::Segment2>;

}  // namespace mansard::segment::detail
