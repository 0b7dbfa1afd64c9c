// Fits one clean profile to every edge of every footprint, greedily.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mansard/base/options.hpp"
#include "mansard/base/run.hpp"
#include "mansard/block/block.hpp"
#include "mansard/model/plan.hpp"
#include "mansard/rays/rays.hpp"
#include "mansard/segment/segment.hpp"

namespace mansard::profile {

/// One vertical line; at most one pitch; all that is supported.
enum class Quality : std::uint8_t { simple, moderate, high };

struct Options {
  Quality quality = Quality::high;
  double spacing = 0.2;         ///< m between perpendicular slices along an edge
  double step = 1.0;            ///< m; the climb goes on to a piece this near
  double jump = 3.0;            ///< m; failing that, over a hole or parapet this wide
  double support = 0.2;         ///< share of an edge's slices that must support a line
  double vertical_angle = 0.1;  ///< rad; lines this near to vertical become vertical
  double run_angle = 0.1;       ///< rad; edges turning less than this share a profile
  double low_height = 2.0;      ///< m above ground; below, tolerances are five times wider (cars, hedges, shops)
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

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
/// a vertical profile · 3 caps lie between the footprint's lowest mesh height and half a
/// metre above its highest · 4 `simple` profiles are one
/// vertical line. One entry per part of the segmentation, same order. `raw` slices come from `climb` in detail/.
[[nodiscard]] auto fit(const segment::Segmentation& segmentation, const block::Block& block, const rays::Scene& mesh,
                       const Options& options, const base::Run& run = {}) -> std::vector<ProfiledFootprint>;

/// The prior alone: one vertical profile for every edge; for footprints without usable evidence.
[[nodiscard]] auto vertical_plan(const geometry::Polygon& polygon, double base, double cap) -> model::Plan;

}  // namespace mansard::profile
