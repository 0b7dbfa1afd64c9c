// A model's face seen from above.
#pragma once

#include "mansard/geometry/change.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/model/surfaces.hpp"

namespace mansard::evaluate::detail {

/// Twice the area, as a vector; holes turn the other way and so are taken off.
[[nodiscard]] inline auto area_vector(const model::ModelFace& face) -> geometry::Point3 {
  geometry::Point3 sum;
  for (const auto& loop : face.loops) sum = sum + model::area_vector(loop);
  return sum;
}

/// The valid polygons that it covers in plan; none for a vertical face.
[[nodiscard]] inline auto plan_of_face(const model::ModelFace& face) -> base::Result<std::vector<geometry::Polygon>> {
  return geometry::make_valid(
      geometry::oriented(geometry::polygon_of(face.loops, [](geometry::Point3 p) { return xy(p); })));
}

}  // namespace mansard::evaluate::detail
