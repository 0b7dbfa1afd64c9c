// What is left of walls that face each other.
#pragma once

#include "mansard/solid/detail/shell_surface.hpp"

namespace mansard::solid::detail {

/// Pairs of faces that are upright, look at each other, belong to different solids and share some of a plane, within
/// `tolerance` metres: indices of faces, the lower first.
[[nodiscard]] auto facing_walls(const std::vector<SurfaceFace>& faces, const std::vector<geometry::Point3>& points,
                                double tolerance) -> std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// Takes walls that face each other away, and puts what of each stands beyond the others in their place. The surface
/// must be conforming. False where walls overlap that look the same way.
[[nodiscard]] auto without_facing_walls(Surface& surface, double tolerance) -> bool;

}  // namespace mansard::solid::detail
