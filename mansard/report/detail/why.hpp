// Why the program cut an edge or did not, in a sentence.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mansard/report/detail/later.hpp"
#include "mansard/segment/segment.hpp"

namespace mansard::report::detail {

/// With how many other candidates that are cut each candidate is in conflict: what cutting it would cost beside its
/// own.
[[nodiscard]] auto walls_in_conflict(const segment::Segmentation& segmentation) -> std::vector<std::size_t>;

/// What is told of an edge beside its costs.
struct Beside {
  std::size_t walls = 0;               ///< of walls_in_conflict
  double phi = 0;                      ///< what each of these conflicts costs
  std::optional<double> sweep_edge{};  ///< m to a parallel sweep-edge, where the edge is on none
  std::optional<Later> later{};        ///< what refinement made of it, where it is a wall and there are models
};

/// m from the edge, which is on no sweep-edge, to the nearest one that runs parallel to most of it within 0.5 m.
[[nodiscard]] auto parallel_sweep_edge(std::span<const geometry::Segment2> edge,
                                       std::span<const sweep::SweepEdge> sweep_edges) -> std::optional<double>;

/// Costs in the objective's units, each with its total: "cut: joining costs 480 for leaving 12.0 m of sweep-edge
/// unused; cutting costs nothing".
[[nodiscard]] auto why(const segment::Candidate& candidate, const Beside& beside) -> std::string;

}  // namespace mansard::report::detail
