// The surface of the smoothed solid, as a mesh.
#pragma once

#include "lab/simulate/detail/world.hpp"
#include "mansard/geometry/mesh.hpp"

namespace mansard::simulate::detail {

/// One vertex per cell that the surface passes, at the mean of the places where it crosses the cell's edges; two
/// triangles per edge crossed. The same whatever the number of threads. Fails with "cancelled".
[[nodiscard]] auto surface_net(const World& world, double resolution, double melt, const base::Run& run)
    -> base::Result<geometry::Mesh>;

}  // namespace mansard::simulate::detail
