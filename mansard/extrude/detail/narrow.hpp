// What is too small in an outline, in words: places too narrow for two walls, edges too short for a roof of their own.
#pragma once

#include <string>

#include "mansard/extrude/detail/footprint.hpp"

namespace mansard::extrude::detail {

/// "corner 4 at (5.000, 5.000) is 0.0001 mm from edge 2; …": a sliver, a short edge or a neck, with what to do about
/// it; empty where the outline is nowhere narrower than 5 mm. O(n²) for n corners: for outlines that have failed.
[[nodiscard]] auto narrow_place(const Source& source) -> std::string;

/// Edges shorter than `size` metres whose profile is neither neighbour's: whether they decide a large plane or none at
/// all hangs on how they are drawn. The one with the most roof, in words; empty where there are none.
[[nodiscard]] auto small_edges(const Source& source, const model::Solid& solid, double size) -> std::string;

}  // namespace mansard::extrude::detail
