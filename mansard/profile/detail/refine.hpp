// Which of a run's candidate profiles the scan agrees with once all runs of the part are extruded together.
// The greedy choice, edge by edge, does not see its neighbours; this does, at the price of an approximate extrusion.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mansard/geometry/polygon.hpp"
#include "mansard/model/plan.hpp"
#include "mansard/profile/detail/runs.hpp"
#include "mansard/profile/options.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::profile::detail {

/// One look from above.
struct RoofSample {
  geometry::Point2 at;
  double height = 0;  ///< m above the part's base
};

/// The mesh's top surface over the polygon: a few thousand samples on a grid aligned to whole multiples of its spacing.
[[nodiscard]] auto look_over(const rays::Scene& mesh, const geometry::Polygon& polygon, double base,
                             const Options& options = {}) -> std::vector<RoofSample>;

/// The candidates of one run, the greedy one first; `reach`: metres, the farthest its perpendiculars go in the part.
struct Choices {
  std::vector<model::Profile> profiles;
  double reach = 0;
};

struct Refined {
  std::vector<std::size_t> chosen;  ///< per run, into its candidates
  std::vector<double> errors;       ///< per cap, mean robust squared error, m²
};

/// Changes one run's profile at a time while that clearly reduces the error under the best of the caps. The raised roof
/// is taken for the lower envelope of the runs' surfaces, each within its own strip widened by 45° to both sides: exact
/// for convex parts with constant slopes, an estimate otherwise. Differences over choice_outlier (trees, steps) count
/// as that. Cost: O(samples · (edges + runs · candidates · caps)).
[[nodiscard]] auto refine(const geometry::Polygon& polygon, std::span<const Run> runs, std::span<const Choices> choices,
                          std::span<const RoofSample> samples, std::span<const double> caps,
                          const Options& options = {}) -> Refined;

}  // namespace mansard::profile::detail
