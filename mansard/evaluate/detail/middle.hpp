// The middle of polygons, and the height of a roof plane there.
#pragma once

#include <span>

#include "mansard/evaluate/form.hpp"

namespace mansard::evaluate::detail {

/// The area of polygons, and their centre.
struct Middle {
  double area = 0;  ///< m²
  geometry::Point2 sum;

  void add(std::span<const geometry::Polygon> polygons);
  /// The area must be positive.
  [[nodiscard]] auto centre() const -> geometry::Point2 { return (1 / area) * sum; }
};

/// m; the plane must not be vertical.
[[nodiscard]] auto height_at(const RoofPlane& plane, geometry::Point2 p) -> double;

}  // namespace mansard::evaluate::detail
