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

/// Parts that overlap in plan, which a union over one plan cannot take as they are. A part whose base is between the
/// base and the top of another one is joined with it where they overlap: its piece there goes down to the other's base,
/// and what is beside it keeps its own base. What floats above another part is in another layer. Of pieces of one layer
/// the higher keeps what they share. Guarantees: 1 pieces of one layer share no ground · 2 together they have the space
/// of the parts, and what is between a part that is joined and the roof below it, but for strips narrower than 2 cm,
/// and 2.2 mm between pieces of a part in different layers · 3 empty where no two parts overlap in plan: they are one
/// layer as they are · 4 the same parts give the same pieces. Cost: O(n log n), and the square of the parts that
/// overlap.
[[nodiscard]] auto stack(std::span<const model::LabelledSolid* const> parts) -> std::vector<Stacked>;

}  // namespace mansard::solid
