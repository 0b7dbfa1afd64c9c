// Why the program cut an edge or did not, in a sentence.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "mansard/segment/segment.hpp"

namespace mansard::report::detail {

/// With how many other candidates that are cut each candidate is in conflict: what cutting it would cost beside its
/// own.
[[nodiscard]] auto walls_in_conflict(const segment::Segmentation& segmentation) -> std::vector<std::size_t>;

/// Costs in the objective's units, what was done before what was not: "cut: 480 for leaving 12.0 m of sweep-edge unused
/// against 0". `walls` is of walls_in_conflict, at `phi` each.
[[nodiscard]] auto why(const segment::Candidate& candidate, std::size_t walls, double phi) -> std::string;

}  // namespace mansard::report::detail
