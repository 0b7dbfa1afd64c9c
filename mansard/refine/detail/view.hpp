// A solid seen from above on the grid of its site.
#pragma once

#include <cstdint>
#include <vector>

#include "mansard/extrude/extrude.hpp"
#include "mansard/refine/detail/heights.hpp"

namespace mansard::refine::detail {

/// Error bound, of the z of a wall's normal: a sketch's normals are made from directions and slopes; a wall's z is 0,
/// and that of the steepest roof a kernel takes, one quantum of run over a rise of 15 m, is 1e-6.
constexpr double wall_normal = 1e-6;

struct View {
  std::vector<double> z;            ///< m above the base, per cell of the grid; NaN where the solid is not
  std::vector<std::uint32_t> face;  ///< the face seen; undefined where z is NaN
};

/// `grid` gives the cells alone, `base` is the solid's. Cost: O(faces · rows they span + cells).
[[nodiscard]] auto view_of(const model::Solid& solid, const Heights& grid, double base) -> View;

}  // namespace mansard::refine::detail
