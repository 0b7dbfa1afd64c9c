// Other programs for the same choice, built from what a Segmentation makes public. Costs are whole, in thousandths of
// the objective, and the same in all of them: where two are solved to the end, their optima are the same number.
#pragma once

#include <optional>

#include "mansard/segment/segment.hpp"
#include "mansard/solver/solver.hpp"

namespace mansard::bench {

/// Four colours for every face, which is enough in the plane; a variable for every two faces that share an edge. Its
/// edges are whole although whole colours make them so: that mostly took a quarter of the time, or less.
[[nodiscard]] auto lean_colours(const segment::Segmentation& segmentation) -> solver::Program;

/// As the reference implementation has it: six colours for every face, and for every half-edge between two faces
/// isEdge, edgeNoProfile, profileNoEdge and an exclusive or for every colour; all whole. What it has for the outline,
/// where nothing is to be chosen, is left out.
[[nodiscard]] auto half_edges(const segment::Segmentation& segmentation) -> solver::Program;

/// The optimum in thousandths, by trying every set of edges; none with more than 18 candidates.
[[nodiscard]] auto by_trying_all(const segment::Segmentation& segmentation) -> std::optional<double>;

}  // namespace mansard::bench
