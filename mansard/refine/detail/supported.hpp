// Roofs without the faces that nothing of the scan speaks for.
#pragma once

#include "mansard/refine/detail/judge.hpp"

namespace mansard::refine::detail {

/// The roof with its bare faces replaced, one after the other, by what makes it cheapest: a wall in place of a small
/// hip, the neighbour's roof, a profile without that part, a ridge instead of a strip under the cap. Those that are
/// worth their price stay.
[[nodiscard]] auto supported(Judged judged, const Judge& judge) -> Judged;

}  // namespace mansard::refine::detail
