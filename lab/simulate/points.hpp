// A simulated scan as an airborne point cloud.
#pragma once

#include <cstdint>
#include <vector>

#include "lab/simulate/simulate.hpp"
#include "mansard/formats/points.hpp"

namespace mansard::simulate {

/// First returns of vertical rays: `density` a square metre over the box of the scan, each at a random place of its own
/// cell of 1/density, in rows from the south. Classes as ASPRS has them: 6 building, 2 ground, 1 for trees, cars and
/// chimneys, of which seven in ten are the first of two returns. Coordinates in the frame of the scan. The same scan,
/// density and seed give the same points at any thread count.
[[nodiscard]] auto airborne_points(const Scan& scan, double density, std::uint64_t seed)
    -> std::vector<formats::CloudPoint>;

}  // namespace mansard::simulate
