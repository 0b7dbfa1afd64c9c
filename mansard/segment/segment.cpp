#include "mansard/segment/segment.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "mansard/base/watch.hpp"
#include "mansard/segment/detail/candidates.hpp"
#include "mansard/segment/detail/evidence.hpp"
#include "mansard/segment/detail/gis_cuts.hpp"
#include "mansard/segment/detail/height_steps.hpp"
#include "mansard/segment/detail/multicut.hpp"
#include "mansard/segment/detail/parts.hpp"
#include "mansard/segment/detail/registered.hpp"

namespace mansard::segment {
namespace {

/// Pieces of inside faces, by face.
auto labels_by_face(const detail::Problem& problem, const detail::Labels& labels)
    -> std::vector<std::optional<std::uint32_t>> {
  std::vector<std::optional<std::uint32_t>> label_of_face(problem.node_of_face.size());
  for (std::size_t f = 0; f < label_of_face.size(); ++f)
    if (const auto& node = problem.node_of_face[f]) label_of_face[f] = labels[*node];
  return label_of_face;
}

auto is_sound(const fracture::Arrangement& arrangement, const sweep::SweepEdges& edges) -> bool {
  const std::size_t n = arrangement.half_edges.size();
  const auto is_known = [&](const fracture::Origin& o) {
    return o.kind == fracture::Kind::border || o.source >= gis_source || o.source < edges.edges.size();
  };
  return n % 2 == 0 &&
         std::ranges::all_of(arrangement.half_edges,
                             [&](const fracture::HalfEdge& h) {
                               return h.twin < n && h.next < n && h.previous < n &&
                                      h.from < arrangement.vertices.size() &&
                                      (!h.face || *h.face < arrangement.faces.size()) &&
                                      std::ranges::all_of(h.origins, is_known);
                             }) &&
         std::ranges::all_of(arrangement.faces, [&](const fracture::Face& f) { return f.edge < n; });
}

}  // namespace

auto cuts_of(const sweep::SweepEdges& edges, const block::Block& block, const Options& options)
    -> std::vector<fracture::Cut> {
  std::vector<fracture::Cut> cuts;
  for (std::uint32_t i = 0; i < edges.edges.size(); ++i) cuts.push_back({edges.edges[i].segment, i});
  if (options.gis_edges == GisEdges::ignore) return cuts;
  const auto footprints = detail::registered(block, edges.registration);
  auto lines = detail::party_lines(footprints, options);
  const auto torn = detail::torn_lines(footprints, edges, options);
  lines.insert(lines.end(), torn.begin(), torn.end());
  for (std::uint32_t j = 0; j < lines.size(); ++j) cuts.push_back({lines[j], gis_source + j});
  return cuts;
}

auto choose(const fracture::Arrangement& arrangement, const sweep::SweepEdges& edges, const block::Block& block,
            const rays::Scene& mesh, const Options& options, const base::Run& run) -> base::Result<Segmentation> {
  if (!is_sound(arrangement, edges))
    return base::error("segment-failed", "the fractured ground is no plane subdivision by these sweep-edges",
                       block.name);
  run.report("segment", block.name, 0);
  detail::Evidence evidence =
      detail::measure(arrangement, detail::registered(block, edges.registration), mesh, options);
  detail::peel(arrangement, options, evidence.faces);

  Segmentation segmentation;
  segmentation.candidates = detail::candidates_of(arrangement, evidence.faces, options);
  if (options.height_measure == HeightMeasure::along)
    detail::measure_steps(arrangement, mesh, options, segmentation.candidates);
  const auto candidate_of = detail::candidate_of_half_edge(arrangement, segmentation.candidates);
  segmentation.conflicts = detail::conflicts_of(arrangement, evidence.faces, candidate_of, options);
  segmentation.phi = detail::phi_of(arrangement, evidence.faces, options);
  detail::price(segmentation.candidates, segmentation.conflicts, segmentation.phi, options);
  const detail::Problem problem = detail::problem_of(arrangement, evidence.faces, segmentation.candidates, candidate_of,
                                                     segmentation.conflicts, segmentation.phi);
  run.report("segment", block.name, 0.3);
  base::Watch solving;
  detail::MulticutAnswer answer = detail::solve(
      problem.multicut,
      {.seconds = options.seconds, .nodes = options.nodes, .cliques = options.cliques, .search = options.search}, run);
  segmentation.solve_cpu_seconds = solving.stop().cpu_seconds;
  run.report("segment", block.name, 0.9);

  const auto label_of_face = labels_by_face(problem, answer.labels);
  for (Candidate& c : segmentation.candidates) c.solved = label_of_face[c.left] != label_of_face[c.right];
  segmentation.rows = detail::star_rows(problem.multicut);
  for (CycleRow& row : answer.rows) segmentation.rows.push_back(std::move(row));
  segmentation.terms = detail::terms_of(arrangement, label_of_face, segmentation.candidates, candidate_of,
                                        segmentation.conflicts, segmentation.phi, options);
  segmentation.objective = segmentation.terms.sum();
  // The program counts in thousandths, rounded twice per candidate; the terms do not.
  const double rounding = 1e-3 * static_cast<double>(segmentation.candidates.size() + 1);
  const auto whole = static_cast<double>(answer.objective + problem.constant) / 1000;
  if (std::abs(whole - segmentation.objective) > rounding + 1e-9 * std::abs(whole))
    return base::error("segment-failed", "the program's objective is not that of its labels", block.name);
  segmentation.bound = segmentation.objective;
  if (!answer.optimal) segmentation.bound -= static_cast<double>(answer.objective - answer.bound) / 1000 + 2 * rounding;
  segmentation.status = problem.multicut.nodes == 0 ? "empty" : answer.optimal ? "optimal" : "stopped";
  segmentation.rounds = answer.rounds;
  segmentation.nodes = answer.nodes;
  segmentation.variables = answer.variables;
  segmentation.warnings = std::move(answer.warnings);

  detail::make_parts(arrangement, evidence, label_of_face, options, segmentation);
  segmentation.faces = std::move(evidence.faces);
  run.report("segment", block.name, 1);
  return segmentation;
}

auto codes() -> std::vector<base::Code> {
  return {
      {"segment-failed", "The faces of a block could not be grouped into footprints.",
       "The block's buildings fall back to flat-roofed prisms; report the input that led here.", 1},
      {"segment-solver", "The integer program solver gave up on a part of a block; the best grouping found is used.",
       "Report the input that led here.", 0},
      {"segment-part-small",
       "A footprint part under 1 m² or of less mean width than segment.narrow was joined to a neighbour of its "
       "feature, or left out where it has none.",
       "Nothing to do; if many, raise segment.phi or sweep.gamma. To keep narrow parts, lower segment.narrow.", 0},
      {"segment-part-repaired", "A footprint part's outline crossed itself and was redrawn, drawn back by 1 cm.",
       "Nothing to do unless the part looks wrong.", 0},
      {"segment-part-dropped", "No simple outline could be made of a footprint part; it was left out.",
       "Raise fracture.snap; report the input that led here.", 0},
  };
}

}  // namespace mansard::segment
