// From the finished graph to half-edges and faces, and back to doubt: is the product what was promised?
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mansard/fracture/detail/graph.hpp"

namespace mansard::fracture::detail {

[[nodiscard]] auto faces_of(const Graph& graph, const std::vector<Cut>& cuts) -> Arrangement;

/// What is wrong with an arrangement, or nothing: links, simple faces that cover the whole, edges that do not cross,
/// distances of at least `snap` metres, origins. O(n log n) in practice.
[[nodiscard]] auto fault_of(const Arrangement& arrangement, double snap) -> std::optional<std::string>;

}  // namespace mansard::fracture::detail
