// Whether two triangles of a surface meet where they should not.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mansard/geometry/points.hpp"

namespace mansard::extrude::detail {

using Corners = std::array<std::uint32_t, 3>;

/// Whether two triangles have a point in common beyond the corners they share by index. Exact; touching counts.
[[nodiscard]] auto intersect(const std::vector<geometry::Point3>& vertices, const Corners& s, const Corners& t) -> bool;

/// The first pair of triangles of different faces that intersect, as indices; {n, n} when none do (n their number).
/// Sweeps along x: O(n log n) for surfaces whose triangles are small against the whole.
[[nodiscard]] auto first_intersection(const std::vector<geometry::Point3>& vertices,
                                      const std::vector<Corners>& triangles, const std::vector<std::uint32_t>& face_of)
    -> std::array<std::size_t, 2>;

}  // namespace mansard::extrude::detail
