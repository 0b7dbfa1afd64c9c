// Parts of a building above each other: what stands on what, and what floats.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mansard/model/solid.hpp"

namespace mansard::solid {

/// A part, or a piece of one, as the union of its layer takes it.
struct Stacked {
  std::size_t part = 0;
  std::size_t layer = 0;
  model::LabelledSolid model;
};

/// Parts whose bases are at several heights, which a union over one plan cannot take as they are. A part whose base is
/// between the base and the top of another one stands on it where they overlap in plan: its piece there goes down to
/// the other's base, and what is beside it keeps its own base. What floats above another part is in another layer.
/// Guarantees: 1 pieces of one layer that overlap in plan overlap or touch in height · 2 the pieces of a part together
/// have its plan, but for strips narrower than 2 cm and 2.2 mm between those of
/// different layers · 3 empty where all parts are in one layer as they are: no two of
/// different bases overlap in plan · 4 the same parts give the same pieces. Cost: O(n log n + pairs that overlap).
[[nodiscard]] auto stack(std::span<const model::LabelledSolid* const> parts) -> std::vector<Stacked>;

}  // namespace mansard::solid
