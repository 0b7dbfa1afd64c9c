// Whether two triangles of a surface meet where they should not.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mansard/geometry/points.hpp"
#include "mansard/solid/triangulator.hpp"

namespace mansard::solid::detail {

/// Whether two triangles have a point in common beyond the corners they share by index. Exact; touching counts.
[[nodiscard]] auto intersect(const std::vector<geometry::Point3>& vertices, const Corners& s, const Corners& t) -> bool;

/// A pair of triangles of different faces that intersect, as indices; {n, n} when none do (n their number). `triangles`
/// are those of the solid's faces, face by face, `face_of` their faces. Pairs come from a tree of boxes; large level
/// faces are compared as a whole with what stands on them. O(n log n) but for triangles that overlap in their boxes, as
/// long needles side by side do.
[[nodiscard]] auto first_intersection(const model::Solid& solid, const std::vector<Corners>& triangles,
                                      const std::vector<std::uint32_t>& face_of) -> std::array<std::size_t, 2>;

}  // namespace mansard::solid::detail
