// What meets what on a solid, whether or not it is sound.
#pragma once

#include <optional>

#include "mansard/solid/half_edges.hpp"

namespace mansard::solid::detail {

struct Connectivity {
  HalfEdges half_edges;  ///< twin is none where it is missing, or where more than one half-edge walks the same way
  std::vector<std::uint32_t> open;     ///< half-edges that no face walks back, by their ends
  std::vector<std::uint32_t> crowded;  ///< half-edges walked back whose way another face walks too, by their ends
};

/// Every loop must have three corners or more and name vertices that are there. O(n log n) at worst.
[[nodiscard]] auto connectivity(const model::Solid& solid) -> Connectivity;

/// A vertex whose corners form more than one fan, if there is one.
[[nodiscard]] auto split_vertex(const model::Solid& solid, const HalfEdges& half_edges) -> std::optional<std::uint32_t>;

}  // namespace mansard::solid::detail
