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
[[nodiscard]] auto candidates_of(const fracture::Arrangement& arrangement, const std::vector<FaceEvidence>& faces,
                                 const Options& options) -> std::vector<Candidate>;

/// The candidate an inside half-edge belongs to; none for half-edges without an inside face on either side.
[[nodiscard]] auto candidate_of_half_edge(const fracture::Arrangement& arrangement,
                                          const std::vector<Candidate>& candidates)
    -> std::vector<std::optional<std::uint32_t>>;

/// A bad pair of O7: two candidates; a candidate and the outline, or itself, where `second` is absent.
struct BadPair {
  std::uint32_t first = 0;
  std::optional<std::uint32_t> second;
  friend auto operator<=>(const BadPair&, const BadPair&) = default;
};

/// Every pair once, sorted.
[[nodiscard]] auto bad_pairs_of(const fracture::Arrangement& arrangement, const std::vector<FaceEvidence>& faces,
                                const std::vector<std::optional<std::uint32_t>>& candidate_of, const Options& options)
    -> std::vector<BadPair>;

/// φ: options.phi times the length of all edges of the inside faces, each once. In the objective's units.
[[nodiscard]] auto phi_of(const fracture::Arrangement& arrangement, const std::vector<FaceEvidence>& faces,
                          const Options& options) -> double;

/// The objective in thousandths: a node for every inside face (in order), an edge for every candidate (in order).
struct Program {
  Multicut multicut;
  std::int64_t constant = 0;  ///< what is paid with no edge cut, thousandths
  std::vector<std::optional<std::uint32_t>> node_of_face;
};
[[nodiscard]] auto program_of(const fracture::Arrangement& arrangement, const std::vector<FaceEvidence>& faces,
                              const std::vector<Candidate>& candidates,
                              const std::vector<std::optional<std::uint32_t>>& candidate_of,
                              const std::vector<BadPair>& pairs, const Options& options) -> Program;

/// O1, O2, O7 from the faces' labels alone, half-edge by half-edge: shares nothing with `program_of` but the pairs.
[[nodiscard]] auto terms_of(const fracture::Arrangement& arrangement, const std::vector<FaceEvidence>& faces,
                            const std::vector<std::optional<std::uint32_t>>& label_of_face,
                            const std::vector<Candidate>& candidates, const std::vector<BadPair>& pairs,
                            const Options& options) -> Terms;

}  // namespace mansard::segment::detail
