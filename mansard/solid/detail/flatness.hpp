// How far the corners of a face are from a plane.
#pragma once

#include "mansard/model/solid.hpp"

namespace mansard::solid::detail {

/// Half of the extent of the face's corners along a direction of any length but 0, m: how far the farthest of them is
/// from the plane in their middle.
[[nodiscard]] auto bend(const model::Solid& solid, const model::Face& face, geometry::Point3 direction) -> double;

/// The least bend over all planes, and so a property of the corners alone: files that keep a face's normal with few
/// digits, or none, give the same answer. Stops as soon as a plane bends by no more than `enough`. `direction` is one
/// to begin with. By C. L. Lawson's algorithm: planes of least squares whose weights are multiplied by the distances,
/// again and again, approach the plane of the minimum of the maximum distance (J. R. Rice, K. H. Usow, The Lawson
/// Algorithm and Extensions, Mathematics of Computation 22, 1968).
[[nodiscard]] auto least_bend(const model::Solid& solid, const model::Face& face, geometry::Point3 direction,
                              double enough) -> double;

}  // namespace mansard::solid::detail
