// Random planar problems for the pure optimisation, and slow ways to solve them.
#pragma once

#include <cstdint>

#include "mansard/base/run.hpp"
#include "mansard/segment/detail/multicut.hpp"

namespace mansard::segment::testing {

struct Weights {
  std::int64_t cost = 1000;  ///< edge costs lie between −cost and cost
  std::int64_t penalty = 1500;
  double pairs = 0.5;  ///< per edge
  double forced = 0;   ///< share of edges
};

/// A grid of faces, some of its edges taken out by joining faces beforehand, with stars around its inner vertices.
[[nodiscard]] auto random_grid(std::uint32_t columns, std::uint32_t rows, const Weights& weights, base::Random& random)
    -> detail::Multicut;

/// The least cost over all partitions of the nodes; for up to nine nodes.
[[nodiscard]] auto least_by_trying_all(const detail::Multicut& problem) -> std::int64_t;

/// The least cost by an integer program with a colour of four for every node: enough in the plane.
[[nodiscard]] auto least_by_four_colours(const detail::Multicut& problem) -> std::int64_t;

}  // namespace mansard::segment::testing
