// How far eaves overhang, where a scan shows the wall below them.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mansard/base/run.hpp"
#include "mansard/geometry/mesh.hpp"
#include "mansard/model/plan.hpp"
#include "mansard/profile/options.hpp"

namespace mansard::profile {

/// What the slices across an edge of a plan show of its eaves.
struct Overhang {
  double distance = 0;   ///< m from the wall to the edge of the roof
  double outermost = 0;  ///< m from the wall to the outermost point of the roof that is seen: scans round edges off
  double wall = 0;       ///< m; of the wall, outward of the plan's edge
  double support = 0;    ///< share of the slices that show both
};

/// Of a plan: by ring (0 the outer one) and edge. Nothing where no eaves overhang, or not enough of them is seen.
using PlanOverhangs = std::vector<std::vector<std::optional<Overhang>>>;

/// Only edges whose roof rises from the top of a vertical wall have eaves. Guarantees: 1 overhangs are between
/// overhang_min and overhang_max · 2 a height field has none: seen from above there is no wall inside of the edge of a
/// roof · 3 eaves reach at most halfway to what is seen before them at their height. One entry per plan. Cost: as
/// fit().
[[nodiscard]] auto measure_overhangs(std::span<const model::Plan> plans, const geometry::Mesh& mesh,
                                     const Options& options, const base::Run& run = {}) -> std::vector<PlanOverhangs>;

}  // namespace mansard::profile
