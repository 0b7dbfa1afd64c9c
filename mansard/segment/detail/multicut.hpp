// The pure optimisation: a minimum cost multicut with pair penalties, in integers. Knows no geometry.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/segment/segment.hpp"

namespace mansard::segment::detail {

/// s = 1 when the labels of a and b differ; costs `cost` then. A forced edge is always cut.
struct MulticutEdge {
  std::uint32_t a = 0, b = 0;
  std::int64_t cost = 0;
  bool forced = false;
};

/// Costs `penalty` ≥ 0 when both edges are cut.
struct MulticutPair {
  std::uint32_t first = 0, second = 0;
  std::int64_t penalty = 0;
};

/// Nodes 0 … nodes − 1, no two edges between the same two nodes, no loops.
struct Multicut {
  std::uint32_t nodes = 0;
  std::vector<MulticutEdge> edges;
  std::vector<MulticutPair> pairs;
  std::vector<std::vector<std::uint32_t>> stars;  ///< edges of a closed walk around a vertex: rows from the start
};

/// Label of every node. Nodes that can be told apart only by being unconnected may share a label.
using Labels = std::vector<std::uint32_t>;

/// What a labelling costs; nothing where it leaves a forced edge uncut.
[[nodiscard]] auto cost_of(const Multicut& problem, const Labels& labels) -> std::optional<std::int64_t>;

/// No labelling costs less: the sum of what each term costs at least.
[[nodiscard]] auto trivial_bound(const Multicut& problem) -> std::int64_t;

/// Numbers connected nodes of one label from 0, by their lowest node.
[[nodiscard]] auto canonical(const Multicut& problem, const Labels& labels) -> Labels;

struct MulticutLimits {
  std::optional<double> seconds;  ///< 0: heuristics and the trivial bound only
  std::int64_t nodes = 100000;    ///< of branch and bound, per solve
  bool cliques = false;           ///< rows for cliques of pairs from the start
  SearchLimits search;
  /// Nodes times the square of the program's coefficients, at most. A node's work grows with that square (the factors
  /// of its bases fill up): 50 ms at 28,000, so that all of them take some 6 s. Ordinary blocks have 4,000 coefficients
  /// and 0 to 30 nodes (docs/decisions/0132-bounded-work.md).
  double node_work = 1e11;
};

/// s_edge ≤ Σ s_path, by edges of the problem.
[[nodiscard]] auto star_rows(const Multicut& problem) -> std::vector<CycleRow>;

struct MulticutAnswer {
  Labels labels;  ///< canonical
  std::int64_t objective = 0, bound = 0;
  bool optimal = false;  ///< bound = objective
  std::int64_t rounds = 0, nodes = 0;
  std::size_t variables = 0;
  std::vector<CycleRow> rows;              ///< those that the rounds added
  std::vector<base::Diagnostic> warnings;  ///< what the solver said where it gave up
};

/// The whole problem as an integer program: s_e by edge, then y by pair (which needs no integrality); pairs as rows,
/// the given rows, and with `cliques` a row Σ y ≥ Σ s − 1 for sets of edges that are all in pairs with each other.
[[nodiscard]] auto integer_program(const Multicut& problem, const std::vector<CycleRow>& rows, bool cliques)
    -> solver::Program;

/// Solves every connected part by rounds of integer programs: solve, find chosen edges with both ends in one piece,
/// add their cycle rows, solve again. Of equally good labellings prefers the one with fewer pieces where two can be
/// joined at no cost.
[[nodiscard]] auto solve(const Multicut& problem, const MulticutLimits& limits, const base::Run& run = {})
    -> MulticutAnswer;

}  // namespace mansard::segment::detail
