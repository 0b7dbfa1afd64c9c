// Where strips of a tile overlap, and how their heights differ there.
#pragma once

#include "mansard/cloud/detail/metres.hpp"
#include "mansard/cloud/strips.hpp"

namespace mansard::cloud::detail {

/// In each cell of 1 m of the tile in which strips have three points or more each: planes of one slope and of a height
/// for each strip through their points, by least squares, so that it does not matter where in the cell these are. Cells
/// count that are flat: no steeper than 10°, and no rougher than 0.2 m (RMS around the planes). Points that
/// count are ground, and only returns that are neither vegetation nor wires. Reference: USGS, Lidar Base Specification,
/// relative vertical accuracy: single returns, slopes below 10°.
[[nodiscard]] auto compare_strips(const Metres& metres) -> StripOverlaps;

}  // namespace mansard::cloud::detail
