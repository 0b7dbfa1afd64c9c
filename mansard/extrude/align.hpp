// Neighbours raised one by one straighten their outlines one by one: what they share is put on one line beforehand.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mansard/extrude/extrude.hpp"
#include "mansard/model/plan.hpp"

namespace mansard::extrude {

/// For each of the plans, what to raise in its place so that walls shared with others lie on one exact line: that of
/// the longest of them, in whichever plan it is. None where a plan shares no wall, is so already, or has no canonical
/// form.
/// Guarantees: 1 an outline that comes back is simple and lies on exact lines, so that raise() keeps it; the profiles
/// are those of the plan · 2 none of its corners is farther than half of Options::tolerance from that of the plan's
/// canonical form (canonical.hpp) · 3 walls that stood back to back, in canonical form within half the tolerance of
/// each other, are within 2^-15 m of one line; but a wall whose corners would move too far, that parts from the
/// others', or whose outline would cross itself, keeps its own · 4 what comes back does not depend on the order of the
/// plans. Cost: O(n log n) for n plans, and the square of the walls of those whose boxes meet.
[[nodiscard]] auto align(std::span<const model::Plan> plans, const Options& options = {})
    -> std::vector<std::optional<model::Plan>>;

}  // namespace mansard::extrude
