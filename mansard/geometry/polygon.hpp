// Polygons with holes: outer ring counter-clockwise, holes clockwise, interior on the left, first point not repeated.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::geometry {

using Ring = std::vector<Point2>;

struct Polygon {
  Ring outer;
  std::vector<Ring> holes;
  friend auto operator==(const Polygon&, const Polygon&) -> bool = default;
};

/// m², positive for a counter-clockwise ring.
[[nodiscard]] auto signed_area(std::span<const Point2> ring) -> double;
/// m², holes taken off; for a polygon in the convention above.
[[nodiscard]] auto area(const Polygon& polygon) -> double;
[[nodiscard]] auto perimeter(std::span<const Point2> ring) -> double;
[[nodiscard]] auto bounds(std::span<const Point2> ring) -> Box2;
[[nodiscard]] auto bounds(std::span<const Polygon> polygons) -> Box2;

/// Whether the point is in the closed ring or polygon, whatever the orientation. Exact.
[[nodiscard]] auto contains(std::span<const Point2> ring, Point2 p) -> bool;
[[nodiscard]] auto contains(const Polygon& polygon, Point2 p) -> bool;
/// Whether one of them does.
[[nodiscard]] auto contains(std::span<const Polygon> polygons, Point2 p) -> bool;

/// m; 0 on the segment.
[[nodiscard]] auto distance(const Segment2& segment, Point2 p) -> double;
/// m to the boundary; 0 on it.
[[nodiscard]] auto boundary_distance(const Polygon& polygon, Point2 p) -> double;

/// Where along the segment the point's foot lies: 0 at start, 1 at end; not clamped.
[[nodiscard]] auto parameter(const Segment2& segment, Point2 p) -> double;

/// Whether no two edges of all rings meet but at the point consecutive ones share. Exact; O(n log n) in practice.
[[nodiscard]] auto is_simple(const Polygon& polygon) -> bool;

/// Reorders every ring to the convention above (outer counter-clockwise, holes clockwise).
[[nodiscard]] auto oriented(Polygon polygon) -> Polygon;

/// Triangles over the points of all rings in order (outer, then each hole), counter-clockwise; no points are added.
/// Fails with "geometry-triangulate" for a polygon that is not valid.
[[nodiscard]] auto triangulate(const Polygon& polygon) -> base::Result<std::vector<std::array<std::uint32_t, 3>>>;

/// Boolean operations; results are valid polygons in the convention above, slivers of zero area dropped, in an order
/// that depends on the input only. A polygon with fewer than three corners is empty. They fail with "geometry-boolean"
/// (the library's words), above all for polygons that are not valid, and for coordinates that are not finite or beyond
/// 1e150 m. A failure is not an empty result: callers must not take it for "nothing in common" or "nothing left".
[[nodiscard]] auto unite(std::span<const Polygon> polygons) -> base::Result<std::vector<Polygon>>;
[[nodiscard]] auto intersect(const Polygon& a, const Polygon& b) -> base::Result<std::vector<Polygon>>;
[[nodiscard]] auto subtract(const Polygon& a, const Polygon& b) -> base::Result<std::vector<Polygon>>;
/// Grown by `by` metres (negative shrinks), corners mitred.
[[nodiscard]] auto buffer(const Polygon& polygon, double by) -> base::Result<std::vector<Polygon>>;
/// Repairs self-intersections, spikes and repeated points as the even-odd rule reads them.
[[nodiscard]] auto make_valid(const Polygon& polygon) -> base::Result<std::vector<Polygon>>;
/// The simple polygons of a valid one, whose rings may touch each other in points: itself where it is simple, otherwise
/// shrunk by `apart` metres, which separates its rings. Empty where nothing is as wide as that.
[[nodiscard]] auto simple_pieces(const Polygon& polygon, double apart) -> base::Result<std::vector<Polygon>>;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::geometry
