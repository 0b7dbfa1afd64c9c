// What a surface is when its file does not say: told by its direction.
#pragma once

#include "mansard/ingest/model.hpp"

namespace mansard::ingest::detail {

/// Twice the area, as a vector along the normal of the loop.
[[nodiscard]] auto area_vector(const std::vector<geometry::Point3>& loop) -> geometry::Point3;

/// Gives every face of the building with `by_normal` set its class: within 0.2 rad of vertical it is wall; level and at
/// the building's foot it is ground; all else is roof. Returns how many there were.
[[nodiscard]] auto classify_by_normal(ModelBuilding& building) -> std::size_t;

}  // namespace mansard::ingest::detail
