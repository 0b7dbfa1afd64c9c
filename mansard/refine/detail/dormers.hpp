// Dormers: small boxes and gables that stand on a slope, each a part with a plan of its own.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mansard/refine/detail/judge.hpp"

namespace mansard::refine::detail {

/// A rectangle on a slope, its front parallel to the eaves; its roof is level, or a gable with the ridge up the slope,
/// and ends at the back where the slope reaches its eaves.
struct Dormer {
  model::Plan plan;
  std::uint32_t ring = 0, edge = 0;  ///< of the host's plan: the slope rises from it
  model::Profile back;               ///< what the slope does behind it, from the back edge of its hole
  double rest = 0;                   ///< m²·m²; of the squared differences around it, what it leaves
  double gain = 0;                   ///< m²·m²; what it takes off the sum of squared differences
  double eaves = 0, pitch = 0;       ///< m above the base; rise per run of its own roof, towards the middle
};

enum class Where : std::uint8_t {
  whole,     ///< on the slope with all of the plan, so that it can be built
  anywhere,  ///< the roof may still be another one
};

/// Dormers on the slopes of a roof, those that explain most first; none near to another. Cost: O(cells) and some
/// hundred passes over the samples around each.
[[nodiscard]] auto dormers_on(const Judged& judged, const Site& site, const Options& options,
                              Where where = Where::whole) -> std::vector<Dormer>;

/// Adds the dormer to a roof as it is seen from above.
void paint(const Dormer& dormer, const Site& site, View& view);

/// The host's plan with a hole for the dormer.
[[nodiscard]] auto with_hole(const model::Plan& host, const Dormer& dormer) -> model::Plan;

/// The site without the samples within `aside` metres of a dormer.
[[nodiscard]] auto without_dormers(const Site& site, const std::vector<Dormer>& dormers, double aside,
                                   const Options& options) -> Site;

}  // namespace mansard::refine::detail
