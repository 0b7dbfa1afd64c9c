// From a plan with heights to a surface: where grounds of two heights meet, it has an upright triangle.
#pragma once

#include "mansard/terrain/detail/plan.hpp"

namespace mansard::terrain::detail {

/// May add vertices to the plan: a step needs an edge that leads away from the buildings.
[[nodiscard]] auto surface_of(Plan& plan) -> Terrain;

}  // namespace mansard::terrain::detail
