#include "mansard/sweep/sweep.hpp"

#include <algorithm>
#include <utility>

#include "mansard/sweep/detail/alignment.hpp"
#include "mansard/sweep/detail/bases.hpp"
#include "mansard/sweep/detail/clusters.hpp"
#include "mansard/sweep/detail/eaves.hpp"
#include "mansard/sweep/detail/lines.hpp"
#include "mansard/sweep/detail/registration.hpp"
#include "mansard/sweep/detail/selection.hpp"

namespace mansard::sweep {

auto find_edges(const slice::SliceStack& stack, const block::Block& block, const Options& options, const base::Run& run)
    -> SweepEdges {
  const detail::GisEdges gis(block, options);
  detail::LineStack lines(stack.slices.size());
  base::parallel_for(stack.slices.size(), [&](std::size_t i) {
    if (run.cancelled()) return;
    for (const auto& found : detail::find_lines(stack.slices[i].segments, options)) {
      const double length = geometry::length(found.end - found.start);
      lines[i].push_back({{gis.aligned(found), i}, length, length});
    }
    detail::weigh_thin(lines[i], options);
  });
  if (run.cancelled()) return {};
  run.report("sweep", block.name, 0.5);

  auto sides = detail::grow_clusters(lines, options, run);
  if (run.cancelled()) return {};
  run.report("sweep", block.name, 0.8);

  auto edges = detail::select_edges(std::move(sides), stack, block, options);
  edges.registration = detail::register_footprints(edges.edges, block, options);
  edges.edges = detail::put_on_footprints(edges.edges, block, edges.registration, options);
  detail::sort_longest_first(edges.edges);
  run.report("sweep", block.name, 1.0);
  return edges;
}

auto under_eaves(SweepEdges edges, const block::Block& block, const rays::Scene& mesh, const Options& options)
    -> SweepEdges {
  edges.edges = detail::moved_under_eaves(std::move(edges.edges), block, edges.registration, mesh, options);
  detail::sort_longest_first(edges.edges);
  return edges;
}

}  // namespace mansard::sweep
