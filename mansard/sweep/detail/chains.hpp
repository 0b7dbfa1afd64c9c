// Joins the segments of a slice end to end.
#pragma once

#include <vector>

#include "mansard/geometry/points.hpp"

namespace mansard::sweep::detail {

/// Points in order; a closed chain repeats its first point at the end.
using Chain = std::vector<geometry::Point2>;

/// Every segment lands in one chain (repeated ones once). Where several go on from a point, the straightest is
/// taken. The result does not depend on the order of the segments.
[[nodiscard]] auto join(std::vector<geometry::Segment2> segments) -> std::vector<Chain>;

}  // namespace mansard::sweep::detail
