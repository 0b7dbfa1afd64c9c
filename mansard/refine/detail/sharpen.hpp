// Roofs as they were before the scan melted them.
#pragma once

#include "mansard/refine/detail/judge.hpp"

namespace mansard::refine::detail {

/// A scan's corners are round, so that whatever fits all of it best is too flat where it is steep, and leans against
/// walls where it is level. Every plane is moved to where the looks in the middle of its faces put it, roofs
/// that end flat below their ridge go up to it, and what is nearly level is made level, if that makes the sum worse by
/// no more than a face costs.
[[nodiscard]] auto sharpened(Judged judged, const Judge& judge) -> Judged;

}  // namespace mansard::refine::detail
