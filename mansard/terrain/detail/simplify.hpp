// Adds heights to a plan until the surface is within a tolerance of all of them.
#pragma once

#include "mansard/terrain/detail/plan.hpp"

namespace mansard::terrain::detail {

/// Greedy insertion: always the height that is farthest from the surface (M. Garland, P. S. Heckbert, Fast polygonal
/// approximation of terrains and height fields, 1995). Heights less than half a cell from an outline are not used, so
/// that no triangle there is thinner than that. Of heights as far from it, the one that is first in the grid.
void simplify(Plan& plan, const Heights& heights, double tolerance, const base::Run& run);

}  // namespace mansard::terrain::detail
