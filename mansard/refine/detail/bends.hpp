// Planes that bend along their side.
#pragma once

#include "mansard/refine/detail/judge.hpp"

namespace mansard::refine::detail {

/// The roof with two pitches where one was, wherever two lines that meet explain nearly all that the one leaves and the
/// roof is then cheaper: a ledge along the eaves, an eave of a flatter pitch, a steep foot, a gentler top.
/// Cost: O(cells), two sketches for every bend that is tried, and O(cells) for every one that is taken.
[[nodiscard]] auto bent(Judged judged, const Judge& judge) -> Judged;

}  // namespace mansard::refine::detail
