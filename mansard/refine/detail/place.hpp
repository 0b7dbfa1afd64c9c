// Where the line of a cut lies, to a centimetre where the samples say so.
#pragma once

#include "mansard/geometry/polygon.hpp"
#include "mansard/refine/detail/heights.hpp"
#include "mansard/refine/options.hpp"

namespace mansard::refine::detail {

/// The piece with every free side, one that does not follow the part's own outline, moved and turned to where the
/// planes on its two sides leave the least squared difference. A side stays where that takes off less than a number of
/// a roof costs (`value_price`), where it goes on in the line of an edge and the scan's edges are no more certain,
/// where either side shows no plane, and where the piece would not stay simple or in the part. With points, these are
/// the samples: where a wall is between two of them is known better than to a cell of a grid. Cost: sides × samples
/// within 2 m of them, for points sides × points; where a side is not straight by them, times the turns that are
/// tried, 2.5 a metre of its length.
[[nodiscard]] auto placed(const geometry::Polygon& part, geometry::Polygon piece, const Heights& measured,
                          const Options& options, const OnPlanes& samples = {}) -> geometry::Polygon;

}  // namespace mansard::refine::detail
