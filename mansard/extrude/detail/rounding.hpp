// From exact points to doubles: the last step.
#pragma once

#include "mansard/extrude/detail/surface.hpp"

namespace mansard::extrude::detail {

struct Placement {
  geometry::Point2 origin;  ///< added to x and y
  double base = 0;          ///< added to z
};

/// The surface in doubles. With `collapse`, arcs under a millimetre are drawn together first, where that changes
/// neither the topology nor a face's side and moves no face by more than half the planarity allowed.
[[nodiscard]] auto rounded(const ExactSurface& surface, const Placement& placement, bool collapse) -> Solid;

}  // namespace mansard::extrude::detail
