// How high a roof of unit slopes comes over an outline.
#pragma once

#include <optional>
#include <vector>

#include "mansard/base/run.hpp"
#include "mansard/roof/detail/sides.hpp"

namespace mansard::roof::detail {

/// What a side does above the eaves.
struct Sweep {
  bool moves = true;  ///< false: upright all the way
  double lag = 0;     ///< m; upright so far (at unit slope), and then it moves
};

/// The height above the eaves of the highest point, with slopes of 1, in metres: heights scale with the slope. Over a
/// convex outline the roof is the lower envelope of its planes, and this a linear program; others are extruded. Nothing
/// where that fails, or where no side moves.
[[nodiscard]] auto crest_of(const geometry::Polygon& polygon, const std::vector<Side>& sides,
                            const std::vector<Sweep>& sweeps, const base::Run& run) -> std::optional<double>;

/// The point from which all of the outline is seen and which is farthest from the lines of its sides, with that
/// distance in metres; negative where there is no such point.
struct Deepest {
  geometry::Point2 place;
  double distance = 0;
};
[[nodiscard]] auto deepest_of(const std::vector<Side>& sides) -> Deepest;

}  // namespace mansard::roof::detail
