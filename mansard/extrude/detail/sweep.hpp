// The sweep: the footprint rises to the cap, and the trace it leaves becomes the surface.
#pragma once

#include "mansard/base/run.hpp"
#include "mansard/extrude/detail/eaves.hpp"
#include "mansard/extrude/detail/footprint.hpp"
#include "mansard/extrude/detail/surface.hpp"

namespace mansard::extrude::detail {

/// Raises the footprint to `cap` (metres above its base). Throws Broken when an invariant does not hold, and when the
/// run was cancelled. With eaves, roofs begin at their soffit.
[[nodiscard]] auto sweep(const Footprint& footprint, const Rational& cap, const base::Run& run,
                         const Eaves* eaves = nullptr) -> ExactSurface;

}  // namespace mansard::extrude::detail
