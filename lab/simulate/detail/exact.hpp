// The scan that has the faces of the truth themselves.
#pragma once

#include "lab/simulate/detail/surroundings.hpp"

namespace mansard::simulate::detail {

/// The triangles of the surface without what is covered by a face that is directed the other way within 1 cm, as
/// between houses that stand wall to wall; and the ground of `area` without the bases of the buildings, in squares of 2
/// m, at the height of each base along its outline. Fails with "geometry-boolean", "geometry-triangulate", "cancelled".
[[nodiscard]] auto exact_scan(const Surface& surface, const Terrain& terrain, const geometry::Box2& area,
                              const base::Run& run) -> base::Result<Scan>;

}  // namespace mansard::simulate::detail
