// A block's first four stages, which `reconstruct` and `segment` share.
#include <algorithm>

#include "mansard/pipeline/detail/block_run.hpp"

namespace mansard::pipeline::detail {
namespace {

void keep(const std::vector<base::Diagnostic>& more, const std::string& block,
          std::vector<base::Diagnostic>& warnings) {
  for (auto warning : more) {
    warning.subject = warning.subject.empty() ? block : block + " " + warning.subject;
    warnings.push_back(std::move(warning));
  }
}

void enter(const segment::Segmentation& chosen, report::BlockReport& report) {
  report.inside_faces = static_cast<std::size_t>(
      std::ranges::count_if(chosen.part_of_face, [](const auto& part) { return part.has_value(); }));
  report.parts = chosen.parts.size();
  report.candidates = chosen.candidates.size();
  report.variables = chosen.variables;
  report.conflicts = chosen.conflicts.size();
  report.terms = chosen.terms;
  report.objective = chosen.objective;
  report.bound = chosen.bound;
  report.status = chosen.status;
  report.rounds = chosen.rounds;
  report.nodes = chosen.nodes;
}

auto region_of(const block::Block& block) -> geometry::Box2 {
  geometry::Box2 region;
  for (const auto& polygon : block.outline)
    for (const geometry::Point2 p : polygon.outer) region.add(p);
  return region;
}

}  // namespace

auto segment_block(const block::Block& block, const rays::Scene& mesh, const Options& options, const base::Run& run,
                   const Tell& tell, report::BlockReport& report, std::vector<base::Diagnostic>& warnings)
    -> report::SegmentedBlock {
  report.name = block.name;
  report.buildings = block.members.size();
  report.triangles = block.mesh.triangles.size();
  report::SegmentedBlock out;
  out.name = block.name;
  for (const auto& member : block.members) out.features.push_back(member.feature);
  keep(block.warnings, block.name, warnings);

  const auto stack = stage("slice", tell, report, [&] { return slice::cut(block, options.slice, run); });
  auto sweeps = stage("sweep", tell, report, [&] {
    auto edges = sweep::find_edges(stack, block, options.sweep, run);
    // What measures eaves has to have the walls below them.
    if (options.profile.overhangs == profile::Overhangs::off)
      edges = sweep::under_eaves(std::move(edges), block, mesh, options.sweep);
    return edges;
  });
  auto arrangement = stage("fracture", tell, report, [&] {
    return fracture::arrange(segment::cuts_of(sweeps, block, options.segment), region_of(block), options.fracture, run);
  });
  report.slices = stack.slices.size();
  for (const auto& slice : stack.slices) report.slice_segments += slice.segments.size();
  report.sweep_edges = sweeps.edges.size();

  if (arrangement) {
    report.faces = arrangement->faces.size();
    keep(arrangement->warnings, block.name, warnings);
    auto chosen = stage("segment", tell, report,
                        [&] { return segment::choose(*arrangement, sweeps, block, mesh, options.segment, run); });
    out.arrangement = std::move(*arrangement);
    if (chosen) {
      enter(*chosen, report);
      keep(chosen->warnings, block.name, warnings);
      out.segmentation = std::move(*chosen);
    } else {
      out.failure = chosen.error();
    }
  } else {
    out.failure = arrangement.error();
  }
  out.sweep_edges = std::move(sweeps.edges);
  if (out.failure) {
    report.status = "failed";
    out.failure =
        base::warning("pipeline-block", "the block could not be segmented: " + out.failure->message, block.name);
    warnings.push_back(*out.failure);
  }
  return out;
}

}  // namespace mansard::pipeline::detail
