// The outline that is extruded in place of a plan's: few exact lines instead of many rounded points.
#pragma once

#include <cstddef>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/extrude/extrude.hpp"
#include "mansard/model/plan.hpp"

namespace mansard::extrude {

/// The canonical form of a plan, and how it came about.
struct Canonical {
  /// Corners are the doubles nearest to where the exact lines meet; profiles are multiples of 2^-16 m. Rings and
  /// profiles are the input's, in its order; rings are oriented.
  model::Plan plan;
  /// m; no point of either outline is farther than this from the other, but for corner edges, which are all of one
  /// length; at most Options::tolerance
  double moved = 0;
  std::size_t repeated_points = 0;        ///< dropped
  std::size_t straightened = 0;           ///< corners at turns under Options::merge_angle, dropped
  std::size_t collinear = 0;              ///< corners exactly between their neighbours, dropped
  std::size_t joints = 0;                 ///< corners kept on a straight line, because the profile changes there
  std::size_t slivers = 0;                ///< edges and stretches of a profile too short to keep, dropped
  std::size_t empty_parts = 0;            ///< of profiles: no run and no rise on the grid
  std::size_t straight_knots = 0;         ///< of profiles: within four quanta (0.06 mm) of a straight run
  std::size_t directions = 0;             ///< different ones, those a quarter turn apart counted once
  std::vector<base::Diagnostic> reasons;  ///< what was changed, one warning each; empty if nothing was
};

/// What raise() starts from. Guarantees, each a test in tests/extrude/canonical.cpp:
///   1  moved bounds the Hausdorff distance of the outlines both ways, and is within Options::tolerance;
///   2  the outline is simple; no turn is shallower than Options::merge_angle where straightening it is within
///   tolerance; 3  canonical of a canonical plan is that plan, bit for bit (edges over 0.1 mm, coordinates under 10^6
///   m); 4  mirrored in an axis, turned by quarters, shifted by whole metres, started at another corner: the same but
///   for
///      that, bit for bit; mirrored only where no edge lies at exactly 45° to the axes (see detail/direction.hpp).
/// Fails with "extrude-not-simple", "extrude-no-area", "extrude-profile", "extrude-cap" as raise() does, and with
/// "extrude-canonical" where raise() would simplify; the message says what, where and what to do.
/// Cost: O(n log n) but for edges that share a strip of the outline's longer axis.
[[nodiscard]] auto canonical(const model::Plan& plan, const Options& options = {}) -> base::Result<Canonical>;

}  // namespace mansard::extrude
