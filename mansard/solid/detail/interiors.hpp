// Whether two solids that lie beside each other intersect.
#pragma once

#include "mansard/model/solid.hpp"

namespace mansard::solid::detail {

/// Whether the surfaces of two solids show that their insides meet: a triangle of one passes through one of the other,
/// or beside an edge that both have, or that one has on a face of the other, both have the same space. Exact, over
/// whole units of files, with faces cut into triangles as validators cut them; surfaces that only touch do not count.
/// Complete unless one of the solids is inside of the other and touches it in corners at most. Yes where a face cannot
/// be cut. Cost: O(n log n) but for triangles that overlap in their boxes.
[[nodiscard]] auto insides_meet(const model::Solid& a, const model::Solid& b) -> bool;

}  // namespace mansard::solid::detail
