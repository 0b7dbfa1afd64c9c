// From the faces of a part to a simple polygon with holes.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mansard/fracture/fracture.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::segment::detail {

/// A corner of a ring, with the part on the left.
struct Corner {
  geometry::Point2 at;
  std::uint32_t vertex = 0;
};
using CornerRing = std::vector<Corner>;

/// The boundary of faces[0 …], which must hang together by edges: outer ring first, then the holes by lowest half-edge.
/// A vertex where the part touches itself comes up several times, once for every wedge of the part at it.
[[nodiscard]] auto trace(const fracture::Arrangement& arrangement, const std::vector<std::uint32_t>& faces,
                         const std::vector<std::optional<std::uint32_t>>& label_of_face) -> std::vector<CornerRing>;

/// Drops corners within the tolerance, metres, of the edge that replaces them; none that comes up several times.
[[nodiscard]] auto straightened(std::vector<CornerRing> rings, double tolerance) -> std::vector<CornerRing>;

/// Moves the second and further copies of a vertex into the part, by so many metres: opens what touched.
[[nodiscard]] auto opened(std::vector<CornerRing> rings, double by) -> std::vector<CornerRing>;

[[nodiscard]] auto polygon_of(const std::vector<CornerRing>& rings) -> geometry::Polygon;

}  // namespace mansard::segment::detail
