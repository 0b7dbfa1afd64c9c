// Fits one clean profile to every edge of every footprint, greedily.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mansard/base/run.hpp"
#include "mansard/block/block.hpp"
#include "mansard/model/plan.hpp"
#include "mansard/profile/options.hpp"
#include "mansard/rays/rays.hpp"
#include "mansard/segment/segment.hpp"

namespace mansard::profile {

/// What the profile of a run of edges rests on.
struct Evidence {
  std::size_t slices = 0;     ///< perpendicular slices that gave a climb
  std::size_t attempted = 0;  ///< … that were made
  double offset = 0;          ///< m; median distance of the wall foot outward of the edge
};

struct ProfiledFootprint {
  model::Plan plan;                ///< base = ground; cap = caps.front()
  std::vector<Evidence> evidence;  ///< per profile of the plan
  /// Per profile of the plan: the others that its slices suggest, each as a profile is; may be empty.
  std::vector<std::vector<model::Profile>> alternatives;
  std::vector<double> caps;  ///< candidate heights above base at which to end the roof, m, the likeliest first; all > 0
};

/// Guarantees: 1 every profile starts at (0, 0) and never decreases, inward or upward · 2 an edge without evidence has
/// a vertical profile · 3 caps lie between the footprint's lowest mesh height and `cap_clear`
/// above its highest · 4 `simple` profiles are one
/// vertical line. `above`: the mesh with the crowns of trees, where `mesh` is without (null: there are none); a part
/// that they hide ends where they rise. One entry per part of the segmentation, same order. `raw` slices come from
/// `climb` in detail/.
[[nodiscard]] auto fit(const segment::Segmentation& segmentation, const block::Block& block, const rays::Scene& mesh,
                       const Options& options, const base::Run& run = {}, const rays::Scene* above = nullptr)
    -> std::vector<ProfiledFootprint>;

/// The prior alone: one vertical profile for every edge; for footprints without usable evidence.
[[nodiscard]] auto vertical_plan(const geometry::Polygon& polygon, double base, double cap) -> model::Plan;

}  // namespace mansard::profile
