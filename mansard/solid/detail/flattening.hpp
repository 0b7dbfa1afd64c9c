// A triangle in plan on a coordinate plane, for tests that are exact in two dimensions.
#pragma once

#include <cmath>

#include "mansard/geometry/points.hpp"

namespace mansard::solid::detail {

/// A coordinate plane on which the triangle keeps its area (exactly: its corners do not become collinear).
class Flattening {
 public:
  Flattening(geometry::Point3 a, geometry::Point3 b, geometry::Point3 c) {
    const geometry::Point3 n = cross(b - a, c - a);
    const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
    axis_ = z >= x && z >= y ? 2 : (x >= y ? 0 : 1);
  }
  [[nodiscard]] auto operator()(geometry::Point3 p) const -> geometry::Point2 {
    return axis_ == 2 ? geometry::Point2{p.x, p.y}
                      : (axis_ == 0 ? geometry::Point2{p.y, p.z} : geometry::Point2{p.z, p.x});
  }

 private:
  int axis_;
};

}  // namespace mansard::solid::detail
