// The scene as a laser from above sees it: one height per place.
#pragma once

#include "lab/simulate/detail/world.hpp"
#include "mansard/geometry/mesh.hpp"

namespace mansard::simulate::detail {

/// A point about every `resolution` metres, off its place by up to a quarter of that; each cell of four points becomes
/// two triangles. Walls are steep triangles between roof and ground. Fails with "cancelled".
[[nodiscard]] auto height_field(const World& world, double resolution, std::uint64_t seed, const base::Run& run)
    -> base::Result<geometry::Mesh>;

}  // namespace mansard::simulate::detail
