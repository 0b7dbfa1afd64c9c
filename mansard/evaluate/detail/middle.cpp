#include "mansard/evaluate/detail/middle.hpp"

namespace mansard::evaluate::detail {

using geometry::Point2;

void Middle::add(std::span<const geometry::Polygon> polygons) {
  const auto add_ring = [&](const geometry::Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 a = ring[i] - ring[0], b = ring[(i + 1) % ring.size()] - ring[0];
      const double twice = cross(a, b);
      area += twice / 2;
      sum = sum + (twice / 6) * (a + b) + (twice / 2) * ring[0];
    }
  };
  for (const auto& polygon : polygons) {
    add_ring(polygon.outer);
    for (const auto& hole : polygon.holes) add_ring(hole);
  }
}

auto height_at(const RoofPlane& plane, Point2 p) -> double {
  const Point2 d = p - xy(plane.point);
  return plane.point.z - dot(xy(plane.normal), d) / plane.normal.z;
}

}  // namespace mansard::evaluate::detail
