// The faces of several solids over common points, every point that lies on an edge a corner of its faces.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mansard/solid/solid.hpp"

namespace mansard::solid::detail {

using Loop = std::vector<std::uint32_t>;

struct SurfaceFace {
  std::vector<Loop> loops;  ///< as those of extrude::Face
  geometry::Point3 normal;  ///< unit, outward
  std::uint32_t solid = 0;  ///< the number of the one it comes from
};

struct Surface {
  std::vector<geometry::Point3> points;
  std::vector<SurfaceFace> faces;
};

/// All faces, as they are.
[[nodiscard]] auto surface_of(std::span<const model::Solid* const> solids) -> Surface;

/// Points within `tolerance` metres of each other become one, edges are broken where another point or edge comes as
/// near, and what that leaves of a face without area goes. False where this does not come to an end.
[[nodiscard]] auto conform(Surface& surface, double tolerance) -> bool;

}  // namespace mansard::solid::detail
