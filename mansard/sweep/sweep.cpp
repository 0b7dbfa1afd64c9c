#include "mansard/sweep/sweep.hpp"

#include <algorithm>
#include <utility>

#include "mansard/sweep/detail/alignment.hpp"
#include "mansard/sweep/detail/bases.hpp"
#include "mansard/sweep/detail/clusters.hpp"
#include "mansard/sweep/detail/lines.hpp"
#include "mansard/sweep/detail/selection.hpp"

namespace mansard::sweep {

auto option_list(Options& options) -> base::OptionList {
  base::OptionList list("sweep");
  list.number("gamma", options.gamma, "m²", {0, 1e6}, "Sides of buildings with less mesh area than this are dropped.")
      .alias("gamma");
  list.number("line_distance", options.line_distance, "m", {0.01, 5}, "Mesh this near a line belongs to it.");
  list.number("line_gap", options.line_gap, "m", {0, 20}, "Gaps along a line up to this are closed.");
  list.number("gis_angle", options.gis_angle, "rad", {0, 0.7},
              "Lines turn to a footprint's edge within this angle; 0 leaves them alone.");
  list.number("gis_distance", options.gis_distance, "m", {0, 50}, "How near that footprint's edge must be.");
  list.number("cluster_step", options.cluster_step, "m", {0.05, 10},
              "Greatest lateral step of a side between neighbouring slices.");
  list.number("low_height", options.low_height, "m", {0, 100},
              "Lines less than this above ground weigh a tenth: cars, hedges.");
  list.number("thin_distance", options.thin_distance, "m", {0, 20},
              "Lines backed by another one this near lose weight: buses, fences.");
  list.number("setback", options.setback, "m", {0.3, 20},
              "Wall feet this far off their side's median become sweep-edges of their own.");
  return list;
}

auto find_edges(const slice::SliceStack& stack, const block::Block& block, const Options& options,
                const base::Run& run) -> SweepEdges {
  const detail::GisEdges gis(block, options);
  detail::LineStack lines(stack.slices.size());
  base::parallel_for(stack.slices.size(), [&](std::size_t i) {
    if (run.cancelled()) return;
    const bool low = stack.slices[i].height < block.ground + options.low_height;
    for (const auto& found : detail::find_lines(stack.slices[i].segments, options)) {
      const double length = geometry::length(found.end - found.start);
      lines[i].push_back({{gis.aligned(found), i}, length, length, low});
    }
    detail::weigh_thin(lines[i], options.thin_distance);
  });
  if (run.cancelled()) return {};
  run.report("sweep", block.name, 0.5);

  auto sides = detail::grow_clusters(lines, options, run);
  if (run.cancelled()) return {};
  run.report("sweep", block.name, 0.8);

  auto edges = detail::select_edges(std::move(sides), lines, stack, block, options);
  run.report("sweep", block.name, 1.0);
  return edges;
}

}  // namespace mansard::sweep
