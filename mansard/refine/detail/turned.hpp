// Roofs that rise in another direction than across a wall: over bent, splayed and oblique sides.
#pragma once

#include <vector>

#include "mansard/refine/detail/judge.hpp"

namespace mansard::refine::detail {

/// The plan with one more roof plane each, from an edge at a corner (extrude/corner_edges.hpp): that of the samples of
/// a face, of a plane of the scan's points, or one of the roof's own where samples off the roof lie on it; where it
/// fits these samples better than the roof does by what a face costs. The walls that it rises along go up to it. Those
/// that save most come first.
[[nodiscard]] auto turned_roofs(const Judged& judged, const Judge& judge) -> std::vector<model::Plan>;

}  // namespace mansard::refine::detail
