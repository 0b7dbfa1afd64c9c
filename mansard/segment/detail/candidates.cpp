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
    double sweep = 0;
    for (const std::uint32_t h : half_edges) {
      const double length = length_of(arrangement, h);
      c.length += length;
      if (is_sweep(arrangement.half_edges[h], options)) sweep += length;
    }
    c.half_edges = std::move(half_edges);
    c.height_difference = std::abs(faces[c.left].height - faces[c.right].height);
    c.sweep = sweep > c.length / 2;
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
  return options.phi * sum;
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

}  // namespace

auto program_of(const fracture::Arrangement& arrangement, const std::vector<FaceEvidence>& faces,
                const std::vector<Candidate>& candidates,
                const std::vector<std::optional<std::uint32_t>>& candidate_of, const std::vector<BadPair>& pairs,
                const Options& options) -> Program {
  Program program;
  Multicut& multicut = program.multicut;
  program.node_of_face.resize(faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (faces[f].inside) program.node_of_face[f] = multicut.nodes++;
  for (const Candidate& c : candidates) {
    // A candidate may be a wall along one stretch and none along another: each stretch pays for itself.
    double sweep = 0, unsupported = 0;
    for (const std::uint32_t h : c.half_edges) {
      const double length = length_of(arrangement, h);
      if (is_sweep(arrangement.half_edges[h], options)) sweep += length;
      if (!is_supported(arrangement.half_edges[h], options)) unsupported += length;
    }
    const std::int64_t if_not_cut =
        thousandths(options.alpha * sweep + options.height_weight * c.length * c.height_difference);
    program.constant += if_not_cut;
    multicut.edges.push_back({*program.node_of_face[c.left], *program.node_of_face[c.right],
                              thousandths(options.beta * unsupported) - if_not_cut, c.forced});
  }
  const std::int64_t phi = thousandths(phi_of(arrangement, faces, options));
  for (const BadPair& pair : pairs) {
    if (pair.second) multicut.pairs.push_back({pair.first, *pair.second, phi});
    else multicut.edges[pair.first].cost += phi;
  }
  multicut.stars = stars_of(arrangement, candidate_of);
  return program;
}

auto terms_of(const fracture::Arrangement& arrangement, const std::vector<FaceEvidence>& faces,
              const std::vector<std::optional<std::uint32_t>>& label_of_face, const std::vector<Candidate>& candidates,
              const std::vector<BadPair>& pairs, const Options& options) -> Terms {
  Terms terms;
  for (std::uint32_t h = 0; h < arrangement.half_edges.size(); h += 2) {
    const fracture::HalfEdge& edge = arrangement.half_edges[h];
    const auto one = edge.face, other = arrangement.half_edges[edge.twin].face;
    if (!one || !other || !label_of_face[*one] || !label_of_face[*other]) continue;
    const double length = length_of(arrangement, h);
    if (*label_of_face[*one] == *label_of_face[*other]) {
      if (is_sweep(edge, options)) terms.sweep_unused += options.alpha * length;
      terms.height += options.height_weight * length * std::abs(faces[*one].height - faces[*other].height);
    } else if (!is_supported(edge, options)) {
      terms.unsupported += options.beta * length;
    }
  }
  const double phi = phi_of(arrangement, faces, options);
  const auto cut = [&](std::uint32_t c) {
    return label_of_face[candidates[c].left] != label_of_face[candidates[c].right];
  };
  for (const BadPair& pair : pairs)
    if (cut(pair.first) && (!pair.second || cut(*pair.second))) terms.thin += phi;
  return terms;
}

}  // namespace mansard::segment::detail
