// A triangle mesh as it comes from a scan: no promise of being closed, manifold or consistently oriented.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mansard/geometry/points.hpp"

namespace mansard::geometry {

using Triangle = std::array<std::uint32_t, 3>;

struct Mesh {
  std::vector<Point3> vertices;     ///< metres
  std::vector<Triangle> triangles;  ///< indices into vertices, counter-clockwise seen from outside where known
  /// What was measured of the surface, where a scan consists of points: the triangles are drawn between these. Metres.
  std::vector<Point3> points{};
};

}  // namespace mansard::geometry
