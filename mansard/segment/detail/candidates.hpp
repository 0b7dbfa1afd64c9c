// The interior edges of the program and the bad pairs among them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "mansard/segment/detail/multicut.hpp"
#include "mansard/segment/segment.hpp"

namespace mansard::segment::detail {

/// One candidate for every two inside faces that share an edge: cutting one of their common runs and not another would
/// leave a wall that ends inside a footprint. Ordered by (left, right).
/// Without costs; with the faces' difference of medians.
[[nodiscard]] auto candidates_of(const fracture::Arrangement& arrangement, const std::vector<FaceEvidence>& faces,
                                 const Options& options) -> std::vector<Candidate>;

/// Sets every candidate's costs by its lengths, its height difference, and the conflicts with the outline.
void price(std::vector<Candidate>& candidates, const std::vector<Conflict>& conflicts, double phi,
           const Options& options);

/// The candidate an inside half-edge belongs to; none for half-edges without an inside face on either side.
[[nodiscard]] auto candidate_of_half_edge(const fracture::Arrangement& arrangement,
                                          const std::vector<Candidate>& candidates)
    -> std::vector<std::optional<std::uint32_t>>;

/// Every pair once, sorted.
[[nodiscard]] auto conflicts_of(const fracture::Arrangement& arrangement, const std::vector<FaceEvidence>& faces,
                                const std::vector<std::optional<std::uint32_t>>& candidate_of, const Options& options)
    -> std::vector<Conflict>;

/// φ: options.phi times the length of all edges of the inside faces, each once. In the objective's units.
[[nodiscard]] auto phi_of(const fracture::Arrangement& arrangement, const std::vector<FaceEvidence>& faces,
                          const Options& options) -> double;

/// The objective in thousandths: a node for every inside face (in order), an edge for every candidate (in order).
struct Problem {
  Multicut multicut;
  std::int64_t constant = 0;  ///< what is paid with no edge cut, thousandths
  std::vector<std::optional<std::uint32_t>> node_of_face;
};
[[nodiscard]] auto problem_of(const fracture::Arrangement& arrangement, const std::vector<FaceEvidence>& faces,
                              const std::vector<Candidate>& candidates,
                              const std::vector<std::optional<std::uint32_t>>& candidate_of,
                              const std::vector<Conflict>& conflicts, double phi) -> Problem;

/// The terms from the faces' labels alone, half-edge by half-edge: shares nothing with `problem_of` but the height
/// differences and the conflicts.
[[nodiscard]] auto terms_of(const fracture::Arrangement& arrangement,
                            const std::vector<std::optional<std::uint32_t>>& label_of_face,
                            const std::vector<Candidate>& candidates,
                            const std::vector<std::optional<std::uint32_t>>& candidate_of,
                            const std::vector<Conflict>& conflicts, double phi, const Options& options) -> Terms;

}  // namespace mansard::segment::detail
