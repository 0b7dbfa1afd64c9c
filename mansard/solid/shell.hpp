// Joins models that stand wall to wall into closed shells without the walls between them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mansard/solid/solid.hpp"

namespace mansard::solid {

/// Solids that stand wall to wall, and the shells that they make.
struct Joined {
  struct One {
    std::vector<std::size_t> of;       ///< the solids in it, rising
    std::vector<model::Solid> shells;  ///< one where they could be joined, else as few as could be
    std::string why;                   ///< empty, or why they are not one
  };
  std::vector<One> groups;  ///< by their first solid
};

/// Solids that share a piece of vertical wall belong together; each such group becomes one shell, the boundary of its
/// union: where two walls face each other only what stands higher than the other stays, and every corner lies on the
/// corners of its neighbours. Solids must be closed, outward, and not overlap. Walls are one where they lie within 1 mm
/// of each other, or where that fails within 1 and 6 cm, which is how far straightened outlines part.
/// Guarantees: 1 every shell passes check() with faces that bend by 12 cm at most · 2 its volume is
/// that of its solids within that distance times their surface · 3 solids that cannot be one shell are joined neighbour
/// by neighbour as far as they can be, and `why` says what is wrong · 4 the same solids give the same shells.
/// Cost: O(n log n) for n edges spread in plan; a group that cannot be one shell costs that for every two neighbours.
[[nodiscard]] auto join(std::span<const model::Solid* const> solids) -> Joined;

}  // namespace mansard::solid
