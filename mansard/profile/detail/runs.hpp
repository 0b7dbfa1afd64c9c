// Groups a ring's edges into straight runs and chooses where to slice along them.
#pragma once

#include <cstddef>
#include <vector>

#include "mansard/geometry/polygon.hpp"
#include "mansard/profile/options.hpp"

namespace mansard::profile::detail {

/// Consecutive edges that share a profile.
struct Run {
  std::size_t ring = 0;            ///< 0 the outer ring, 1 … the holes
  std::vector<std::size_t> edges;  ///< in order along the ring
};

/// Outer ring first, runs in the order of their first edge. `angle` in radians.
[[nodiscard]] auto runs_of(const geometry::Polygon& polygon, double angle) -> std::vector<Run>;

/// Where one perpendicular slice stands.
struct Sample {
  geometry::Point2 foot;
  geometry::Point2 inward;  ///< unit
  double along = 0;         ///< m from the start of the run
  double reach = 0;         ///< m inward to where the perpendicular leaves the polygon
};

/// Every `spacing` metres along each edge of the run, wider apart on edges that would get more than slices_per_edge.
[[nodiscard]] auto samples_of(const geometry::Polygon& polygon, const Run& run, const Options& options = {})
    -> std::vector<Sample>;

/// m; the whole run.
[[nodiscard]] auto length_of(const geometry::Polygon& polygon, const Run& run) -> double;

/// The runs before and after a run in its ring that it turns from by less than gentle_turn.
[[nodiscard]] auto gentle_neighbours(const geometry::Polygon& polygon, const std::vector<Run>& runs, std::size_t run,
                                     const Options& options = {}) -> std::vector<std::size_t>;

}  // namespace mansard::profile::detail
