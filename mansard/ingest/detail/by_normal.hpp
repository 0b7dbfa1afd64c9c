// What a surface is when its file does not say: told by its direction.
#pragma once

#include "mansard/ingest/model.hpp"

namespace mansard::ingest::detail {

/// Gives every face of the building with `by_normal` set its class: within 0.2 rad of vertical it is wall; level and at
/// the building's foot it is ground; all else is roof. Returns how many there were.
[[nodiscard]] auto classify_by_normal(model::ModelBuilding& building) -> std::size_t;

}  // namespace mansard::ingest::detail
