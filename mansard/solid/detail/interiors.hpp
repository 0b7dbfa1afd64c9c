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

/// Whether a corner of one lies on a face of the other that has no corner there. On the decimals of a file it may be on
/// it exactly; read as doubles it is on one side or the other, so that it is chance whether the insides meet. Not on
/// faces along two axes, nor above or below a corner of a wall: these are exact in doubles, too.
[[nodiscard]] auto touch_by_chance(const model::Solid& a, const model::Solid& b) -> bool;

/// One of both, for the cost of one.
[[nodiscard]] auto meet_or_touch_by_chance(const model::Solid& a, const model::Solid& b) -> bool;

}  // namespace mansard::solid::detail
