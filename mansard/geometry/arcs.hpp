// Runs of edges that represent a curve: chords of a circle, an ellipse, or another line that bends steadily.
#pragma once

#include <cstddef>
#include <vector>

#include "mansard/geometry/polygon.hpp"

namespace mansard::geometry {

/// Consecutive edges of a ring, chords of one curve.
struct Arc {
  std::size_t first = 0;  ///< the edge that it begins with
  std::size_t count = 0;  ///< edges; of a whole ring all of them, beginning with edge 0
};

/// The curves of a ring, in the order of their first edges. Chords of a curve are at least four; each turns from the
/// one before to the same side, by at most 50° (an octagon's turn by 45°), is at most three times as long, and all
/// together turn by at least 30°. Corners of any four chords in a row are nearer to a circle than the height of the
/// curve over its chords, or 2 cm, which is how exactly most surveys give corners. Corners at which nothing turns
/// are part of their chord. Cost: O(n).
[[nodiscard]] auto arcs_of(const Ring& ring) -> std::vector<Arc>;

}  // namespace mansard::geometry
