#include "mansard/sweep/sweep.hpp"

#include <algorithm>
#include <utility>

#include "mansard/sweep/detail/alignment.hpp"
#include "mansard/sweep/detail/bases.hpp"
#include "mansard/sweep/detail/clusters.hpp"
#include "mansard/sweep/detail/lines.hpp"
#include "mansard/sweep/detail/registration.hpp"
#include "mansard/sweep/detail/selection.hpp"
#include "mansard/sweep/detail/steps.hpp"

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
  list.number("gis_offset", options.gis_offset, "m", {0, 5},
              "Walls measured up to this far outside a footprint edge are moved onto it; 0 leaves them where they were "
              "measured.");
  list.number("gis_inward", options.gis_inward, "m", {0, 5},
              "Walls measured up to this far inside a footprint edge are moved onto it.");
  list.number("cluster_step", options.cluster_step, "m", {0.05, 10},
              "Maximum lateral step of a side between neighbouring slices.");
  list.number("low_height", options.low_height, "m", {0, 100},
              "Lines less than this above ground weigh a tenth: cars, hedges.");
  list.number("thin_distance", options.thin_distance, "m", {0, 20},
              "Lines backed by another one this near lose weight: buses, fences.");
  list.number("setback", options.setback, "m", {0.3, 20},
              "Wall feet this far off their side's median become sweep-edges of their own.");
  list.number("step_height", options.step_height, "m", {0, 20},
              "Roofs that jump by this along a straight line make sweep-edges; 0: none do.");
  list.number("step_length", options.step_length, "m", {0.5, 100}, "How long such a line must be.");
  return list;
}

auto find_edges(const slice::SliceStack& stack, const block::Block& block, const Options& options, const base::Run& run)
    -> SweepEdges {
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
  edges.registration = detail::register_footprints(edges.edges, block, options);
  edges.edges = detail::put_on_footprints(edges.edges, block, edges.registration, options);
  detail::sort_longest_first(edges.edges);
  run.report("sweep", block.name, 1.0);
  return edges;
}

auto with_roof_steps(SweepEdges edges, const block::Block& block, const rays::Scene& mesh, const Options& options,
                     const base::Run& run) -> SweepEdges {
  if (options.step_height <= 0) return edges;
  for (SweepEdge& step : detail::roof_steps(block, mesh, edges, options, run)) {
    step.cluster = edges.clusters.size();
    edges.clusters.push_back({{}, step.area});
    edges.edges.push_back(step);
  }
  std::ranges::stable_sort(edges.edges, [](const SweepEdge& a, const SweepEdge& b) {
    return geometry::length(a.segment.end - a.segment.start) > geometry::length(b.segment.end - b.segment.start);
  });
  return edges;
}

}  // namespace mansard::sweep
