// Stretches of an outline that become one line each, and the directions they share.
#pragma once

#include <vector>

#include "mansard/extrude/detail/direction.hpp"
#include "mansard/extrude/detail/grid.hpp"

namespace mansard::extrude::detail {

/// A stretch of a ring: from corner `first` to corner `last`, which may be counted on past the end of the ring.
struct Run {
  std::size_t first = 0, last = 0;
  bool own_direction = false;  ///< not to share its direction with others
  Direction direction;
  std::int64_t offset = 0;  ///< of its line, quanta
};

[[nodiscard]] inline auto at(const GridRing& ring, std::size_t i) -> GridPoint {
  while (i >= ring.size()) i -= ring.size();
  return ring[i];
}
[[nodiscard]] inline auto chord_of(const GridRing& ring, const Run& run) -> GridPoint {
  return at(ring, run.last) - at(ring, run.first);
}

/// How far the corners between two stray from the chord between them, metres: the greater of the distance from its line
/// and the reach past its ends.
[[nodiscard]] auto deviation(const GridRing& ring, std::size_t first, std::size_t last) -> double;

/// Runs end at turns of more than `merge_angle` (radians), and where a stretch of lesser turns would bend away from its
/// chord by more than `allowed` metres. The same for a mirrored, turned or renumbered ring.
[[nodiscard]] auto straightened(const GridRing& ring, double merge_angle, double allowed) -> std::vector<Run>;

/// Longest first, each run takes the direction of a longer one (or its perpendicular or opposite) where that moves its
/// ends by no more than `end_may_move` metres and turns it by no more than `may_turn`; otherwise its own becomes
/// available. The same for mirrored, turned or renumbered rings, but see bearing_of.
void share_directions(const std::vector<GridRing>& rings, std::vector<std::vector<Run>>& runs, double end_may_move,
                      double may_turn);

}  // namespace mansard::extrude::detail
