// From exact points to doubles: the last step.
#pragma once

#include <cstddef>

#include "mansard/extrude/detail/surface.hpp"

namespace mansard::extrude::detail {

struct Placement {
  geometry::Point2 origin;  ///< added to x and y
  double base = 0;          ///< added to z
  double grid = 0;          ///< m; vertices go to multiples of this; 0: the nearest doubles
};

struct Rounded {
  model::Solid solid;
  double residual = 0;        ///< m; the furthest that a vertex lies from the plane of one of its faces
  std::size_t collapsed = 0;  ///< arcs drawn together
};

/// The nearest point whose coordinates are multiples of `grid`; the point itself when that is 0.
[[nodiscard]] auto on_grid(geometry::Point3 p, double grid) -> geometry::Point3;

/// The surface in doubles. Arcs under `short_arc` metres are drawn together first, shortest first, each only
/// where the surface stays a manifold (the link condition), every face keeps its side and its loops apart (exactly,
/// seen along the axis nearest to its normal), and no plane is missed by more than 0.04 mm; else it is kept.
[[nodiscard]] auto rounded(const ExactSurface& surface, const Placement& placement, double short_arc) -> Rounded;

}  // namespace mansard::extrude::detail
