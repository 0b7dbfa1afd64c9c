// Faces that are said together: all that one pitch of one profile makes along a curve.
#pragma once

#include <cstdint>
#include <vector>

#include "mansard/model/plan.hpp"
#include "mansard/model/solid.hpp"

namespace mansard::refine::detail {

/// Per face of a plan's solid the number of its strip, from 0. The chords of a curve (geometry::arcs_of) that have one
/// profile are one side, and what a pitch of that profile makes along them is one strip. Any other face is a
/// strip of its own.
struct FaceStrips {
  std::vector<std::uint32_t> of_face;
  std::uint32_t count = 0;
};
[[nodiscard]] auto strips_of(const model::Plan& plan, const model::Solid& solid) -> FaceStrips;

}  // namespace mansard::refine::detail
