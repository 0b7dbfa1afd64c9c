// From an outline along cells to one of straight walls, most of them in the few directions that the building has.
#pragma once

#include <vector>

#include "mansard/base/result.hpp"

#include "mansard/derive/options.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::derive::detail {

/// Directions of walls, radians from east, 0 … π/2: each stands for itself and those at right angles to it. The one
/// with
/// the longest sides comes first; later ones only where their sides make direction_share of the perimeter.
[[nodiscard]] auto directions_of(const geometry::Polygon& outline, const Options& how) -> std::vector<double>;

/// Simple polygons near the outline; the outline itself, simplified, where no straight walls are. Fails with
/// "geometry-boolean" where the straight outline cannot be compared with the other, or the simplified one crosses
/// itself and cannot be repaired.
[[nodiscard]] auto regularised(const geometry::Polygon& outline, const Options& how)
    -> base::Result<std::vector<geometry::Polygon>>;

}  // namespace mansard::derive::detail
