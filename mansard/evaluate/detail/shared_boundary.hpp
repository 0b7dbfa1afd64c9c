// How far two outlines run along each other.
#pragma once

#include "mansard/evaluate/truth.hpp"

namespace mansard::evaluate::detail {

[[nodiscard]] auto edges_of(const Outline& outline) -> std::vector<geometry::Segment2>;

/// m of the first outline, in pieces of at most 10 cm, within `party_touch` of the second.
[[nodiscard]] auto shared_boundary(const Outline& first, const Outline& second) -> double;

/// Calls see(middle, length) for pieces of the edge of at most 10 cm.
template <class See>
void each_piece(const geometry::Segment2& edge, See see) {
  constexpr double piece = 0.1;  // m
  const auto along = edge.end - edge.start;
  const auto n = static_cast<std::size_t>(std::ceil(length(along) / piece));
  for (std::size_t k = 0; k < n; ++k)
    see(edge.start + ((static_cast<double>(k) + 0.5) / static_cast<double>(n)) * along,
        length(along) / static_cast<double>(n));
}

}  // namespace mansard::evaluate::detail
