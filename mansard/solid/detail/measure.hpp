// Measures of a solid's faces, shared by the public functions and the check.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "mansard/solid/solid.hpp"
#include "mansard/solid/triangulator.hpp"

namespace mansard::solid::detail {

/// Newell's vector of a face: along its normal, of twice its area.
[[nodiscard]] auto area_vector(const model::Solid& solid, const model::Face& face) -> geometry::Point3;

/// Triangles of one face over solid.vertices.
[[nodiscard]] auto triangles_of(const model::Solid& solid, const model::Face& face)
    -> base::Result<std::vector<Corners>>;

/// geometry::orientation(), quick to see that corners on a line are.
[[nodiscard]] auto turn(geometry::Point2 a, geometry::Point2 b, geometry::Point2 c) -> int;

/// +1 when d lies above the plane of a, b, c (counter-clockwise seen from there), −1 below, 0 on it. Exact.
[[nodiscard]] auto above(geometry::Point3 a, geometry::Point3 b, geometry::Point3 c, geometry::Point3 d) -> int;

}  // namespace mansard::solid::detail
