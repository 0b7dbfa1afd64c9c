// Straight lines in one slice.
#pragma once

#include <vector>

#include "mansard/geometry/points.hpp"
#include "mansard/sweep/sweep.hpp"

namespace mansard::sweep::detail {

/// Lines of at least half a metre, outside on the left, longest first (ties by coordinates). Independent of the order
/// of segments.
[[nodiscard]] auto find_lines(const std::vector<geometry::Segment2>& segments, const Options& options)
    -> std::vector<geometry::Segment2>;

}  // namespace mansard::sweep::detail
