// A simulated scan as an airborne point cloud.
#pragma once

#include <cstdint>
#include <vector>

#include "lab/simulate/simulate.hpp"
#include "mansard/formats/points.hpp"

namespace mansard::simulate {

struct AirborneOptions {
  double density = 8;     ///< points a square metre
  double noise = 0;       ///< m; standard deviation of each point's height, independent of the others
  double noise_plan = 0;  ///< m; and of its x and its y
};
struct AirbornePoints {
  std::vector<formats::CloudPoint> points;
  /// Of the noise of the scan and that of the points. Its `noise` is along the normals of the roofs that points show,
  /// as it was drawn; its correlated area that of the scan or of a point, by their variances.
  Accuracy planted;
};

/// First returns of vertical rays: `density` a square metre over the box of the scan, each at a random place of its own
/// cell of 1/density, in rows from the south. Classes as ASPRS has them: 6 building, 2 ground, 1 for trees, cars and
/// chimneys, of which seven in ten are the first of two returns. Coordinates in the frame of the scan. The same scan,
/// options and seed give the same points at any thread count. Noise moves the points after they have been classified,
/// and changes neither their number nor their order.
[[nodiscard]] auto airborne_points(const Scan& scan, const AirborneOptions& options, std::uint64_t seed)
    -> AirbornePoints;

}  // namespace mansard::simulate
