// The plane through a face that is nearest to its corners.
#pragma once

#include "mansard/solid/solid.hpp"

namespace mansard::solid::detail {

struct FittedPlane {
  geometry::Point3 middle, normal;  ///< unit, on the side of Newell's
  double furthest = 0;              ///< m; the distance of the furthest corner
  double narrow = 0;                ///< the width of the face as a share of its length: 0 … 1
};

/// By least squares of the distances of the corners of all loops, as validators take it.
[[nodiscard]] auto fitted_plane(const model::Solid& solid, const model::Face& face) -> FittedPlane;

/// How far along its normal the plane of most corners of a face is from the origin, m: the median of their distances,
/// which a few corners that rounding moved do not change.
[[nodiscard]] auto offset_of_most(const model::Solid& solid, const model::Face& face) -> double;

}  // namespace mansard::solid::detail
