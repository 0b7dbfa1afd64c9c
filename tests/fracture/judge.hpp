// What an arrangement must be, looked at the slow way, apart from the module's own check.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mansard/fracture/fracture.hpp"

namespace mansard::fracture {

/// What breaks guarantee 1 (links, simple disjoint faces that cover the rectangle), 2 (distances, of which the drift of
/// cuts that were not left out) or 3 (origins); nothing when all hold. O(n²).
[[nodiscard]] auto complaint(const Arrangement& arrangement, const std::vector<Cut>& cuts, double snap)
    -> std::optional<std::string>;

/// The largest distance, metres, from a point of the cut to the edges that come of it.
[[nodiscard]] auto drift(const Arrangement& arrangement, const Cut& cut) -> double;

[[nodiscard]] auto is_left_out(const Arrangement& arrangement, const Cut& cut) -> bool;

/// m, over undirected edges of that kind that come of the cut with that number.
[[nodiscard]] auto length_of(const Arrangement& arrangement, Kind kind, std::uint32_t source) -> double;

/// Every vertex, sorted; every edge as its ends, sorted; every area, sorted: equal for equal subdivisions.
struct Shape {
  std::vector<geometry::Point2> vertices;
  std::vector<geometry::Segment2> edges;
  std::vector<double> areas;
  friend auto operator==(const Shape&, const Shape&) -> bool = default;
};
[[nodiscard]] auto shape_of(const Arrangement& arrangement) -> Shape;

}  // namespace mansard::fracture
