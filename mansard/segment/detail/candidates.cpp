#include "mansard/segment/detail/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "mansard/segment/detail/origins.hpp"

namespace mansard::segment::detail {

auto candidates_of(const fracture::Arrangement& arrangement, const std::vector<FaceEvidence>& faces,
                   const Options& options) -> std::vector<Candidate> {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> shared;
  for (std::uint32_t h = 0; h < arrangement.half_edges.size(); ++h) {
    const auto left = arrangement.half_edges[h].face;
    const auto right = arrangement.half_edges[arrangement.half_edges[h].twin].face;
    if (left && right && *left < *right && faces[*left].inside && faces[*right].inside)
      shared[{*left, *right}].push_back(h);
  }
  std::vector<Candidate> candidates;
  for (auto& [pair, half_edges] : shared) {
    Candidate c;
    c.left = pair.first, c.right = pair.second;
    double on_sweep = 0;
    for (const std::uint32_t h : half_edges) {
      const fracture::HalfEdge& edge = arrangement.half_edges[h];
      const double length = length_of(arrangement, h);
      c.length += length;
      // A candidate may be a wall along one stretch and none along another: each stretch pays for itself.
      for (const TermInfo& info : terms())
        if (info.share != nullptr) c.amounts[info.term] += info.share(edge, options) * length;
      if (is_sweep(edge, options)) on_sweep += length;
    }
    c.half_edges = std::move(half_edges);
    c.amounts[Term::height] = std::abs(faces[c.left].height - faces[c.right].height);
    c.sweep = on_sweep > c.length / 2;
    c.forced = options.gis_edges == GisEdges::hard && faces[c.left].feature != faces[c.right].feature;
    candidates.push_back(std::move(c));
  }
  return candidates;
}

auto candidate_of_half_edge(const fracture::Arrangement& arrangement, const std::vector<Candidate>& candidates)
    -> std::vector<std::optional<std::uint32_t>> {
  std::vector<std::optional<std::uint32_t>> candidate_of(arrangement.half_edges.size());
  for (std::uint32_t c = 0; c < candidates.size(); ++c)
    for (const std::uint32_t h : candidates[c].half_edges)
      candidate_of[h] = candidate_of[arrangement.half_edges[h].twin] = c;
  return candidate_of;
}

auto phi_of(const fracture::Arrangement& arrangement, const std::vector<FaceEvidence>& faces, const Options& options)
    -> double {
  double sum = 0;
  for (std::uint32_t h = 0; h < arrangement.half_edges.size(); h += 2) {
    const auto left = arrangement.half_edges[h].face, right = arrangement.half_edges[h + 1].face;
    if ((left && faces[*left].inside) || (right && faces[*right].inside)) sum += length_of(arrangement, h);
  }
  return std::round(1000 * options.phi * sum) / 1000;
}

void price(std::vector<Candidate>& candidates, const std::vector<Conflict>& conflicts, double phi,
           const Options& options) {
  for (Candidate& c : candidates)
    for (const TermInfo& info : terms())
      if (info.weight != nullptr)
        c.costs[info.term] = options.*info.weight * (info.share != nullptr ? 1 : c.length) * c.amounts[info.term];
  for (const Conflict& conflict : conflicts)
    if (!conflict.second) candidates[conflict.first].costs[Term::thin] += phi;
}

namespace {

auto thousandths(double value) -> std::int64_t { return std::llround(1000 * value); }

/// Rows "no wall ends here" for every vertex with inside faces all around it.
auto stars_of(const fracture::Arrangement& arrangement, const std::vector<std::optional<std::uint32_t>>& candidate_of)
    -> std::vector<std::vector<std::uint32_t>> {
  std::vector<std::vector<std::uint32_t>> at(arrangement.vertices.size());
  std::vector<bool> inner(arrangement.vertices.size(), true);
  for (std::uint32_t h = 0; h < arrangement.half_edges.size(); ++h) {
    const std::uint32_t v = arrangement.half_edges[h].from;
    if (candidate_of[h]) at[v].push_back(*candidate_of[h]);
    else inner[v] = false;
  }
  std::vector<std::vector<std::uint32_t>> stars;
  for (std::size_t v = 0; v < at.size(); ++v)
    if (inner[v] && at[v].size() > 2) stars.push_back(std::move(at[v]));
  return stars;
}

/// Edges, between faces, and pairs.
void add_edges(const std::vector<Candidate>& candidates, const std::vector<Conflict>& conflicts, double phi,
               Problem& problem) {
  for (const Candidate& c : candidates) {
    const std::int64_t uncut = thousandths(c.costs.sum(Paid::uncut));
    problem.constant += uncut;
    problem.multicut.edges.push_back({c.left, c.right, thousandths(c.costs.sum(Paid::cut)) - uncut, c.forced});
  }
  for (const Conflict& conflict : conflicts)
    if (conflict.second) problem.multicut.pairs.push_back({conflict.first, *conflict.second, thousandths(phi)});
}

}  // namespace

auto problem_of(const fracture::Arrangement& arrangement, const std::vector<FaceEvidence>& faces,
                const std::vector<Candidate>& candidates, const std::vector<std::optional<std::uint32_t>>& candidate_of,
                const std::vector<Conflict>& conflicts, double phi) -> Problem {
  Problem problem;
  problem.node_of_face.resize(faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (faces[f].inside) problem.node_of_face[f] = problem.multicut.nodes++;
  add_edges(candidates, conflicts, phi, problem);
  for (MulticutEdge& edge : problem.multicut.edges) {
    edge.a = *problem.node_of_face[edge.a];
    edge.b = *problem.node_of_face[edge.b];
  }
  problem.multicut.stars = stars_of(arrangement, candidate_of);
  return problem;
}

auto terms_of(const fracture::Arrangement& arrangement, const std::vector<std::optional<std::uint32_t>>& label_of_face,
              const std::vector<Candidate>& candidates, const std::vector<std::optional<std::uint32_t>>& candidate_of,
              const std::vector<Conflict>& conflicts, double phi, const Options& options) -> Terms {
  Terms sums;
  for (std::uint32_t h = 0; h < arrangement.half_edges.size(); h += 2) {
    const fracture::HalfEdge& edge = arrangement.half_edges[h];
    const auto one = edge.face, other = arrangement.half_edges[edge.twin].face;
    if (!one || !other || !label_of_face[*one] || !label_of_face[*other]) continue;
    const double length = length_of(arrangement, h);
    const Paid paid = *label_of_face[*one] == *label_of_face[*other] ? Paid::uncut : Paid::cut;
    for (const TermInfo& info : terms()) {
      if (info.paid != paid || info.weight == nullptr) continue;
      sums[info.term] += info.share != nullptr
                             ? options.*info.weight * info.share(edge, options) * length
                             : options.*info.weight * length * candidates[*candidate_of[h]].amounts[info.term];
    }
  }
  const auto cut = [&](std::uint32_t c) {
    return label_of_face[candidates[c].left] != label_of_face[candidates[c].right];
  };
  for (const Conflict& conflict : conflicts)
    if (cut(conflict.first) && (!conflict.second || cut(*conflict.second))) sums[Term::thin] += phi;
  return sums;
}

}  // namespace mansard::segment::detail

namespace mansard::segment {

auto program_of(const Segmentation& segmentation) -> solver::Program {
  detail::Problem problem;
  detail::add_edges(segmentation.candidates, segmentation.conflicts, segmentation.phi, problem);
  solver::Program program = detail::integer_program(problem.multicut, segmentation.rows, false);
  program.constant = static_cast<double>(problem.constant);
  return program;
}

}  // namespace mansard::segment
