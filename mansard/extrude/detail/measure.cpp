#include "mansard/extrude/detail/measure.hpp"

#include <gmpxx.h>

#include <algorithm>

#include "mansard/geometry/predicates.hpp"

namespace mansard::extrude::detail {

using geometry::Point2;
using geometry::Point3;

auto area_vector(const Solid& solid, const Face& face) -> Point3 {
  Point3 sum;
  if (face.loops.empty() || face.loops[0].empty()) return sum;
  const Point3 o = solid.vertices[face.loops[0][0]];
  for (const auto& loop : face.loops)
    for (std::size_t i = 0; i < loop.size(); ++i)
      sum = sum + cross(solid.vertices[loop[i]] - o, solid.vertices[loop[(i + 1) % loop.size()]] - o);
  return sum;
}

auto projected(const Solid& solid, const Face& face) -> geometry::Polygon {
  const Point3 n = area_vector(solid, face);
  const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  const auto seen = [&](Point3 p) -> Point2 {
    if (z >= x && z >= y) return n.z > 0 ? Point2{p.x, p.y} : Point2{p.y, p.x};
    if (x >= y) return n.x > 0 ? Point2{p.y, p.z} : Point2{p.z, p.y};
    return n.y > 0 ? Point2{p.z, p.x} : Point2{p.x, p.z};
  };
  geometry::Polygon polygon;
  for (std::size_t l = 0; l < face.loops.size(); ++l) {
    geometry::Ring ring;
    for (const std::uint32_t v : face.loops[l]) ring.push_back(seen(solid.vertices[v]));
    if (l == 0) polygon.outer = std::move(ring);
    else polygon.holes.push_back(std::move(ring));
  }
  return polygon;
}

auto triangles_of(const Solid& solid, const Face& face) -> base::Result<std::vector<std::array<std::uint32_t, 3>>> {
  std::vector<std::uint32_t> corners;
  for (const auto& loop : face.loops) corners.insert(corners.end(), loop.begin(), loop.end());
  std::vector<std::array<std::uint32_t, 3>> triangles;
  const geometry::Polygon polygon = projected(solid, face);
  if (corners.size() == 3) {
    triangles.push_back({0, 1, 2});
  } else if (corners.size() == 4) {
    // Of the two diagonals the one whose lesser triangle is larger: corners on a straight side make no slivers.
    const auto& p = polygon.outer;
    const auto lesser = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
      if (geometry::orientation(p[a], p[b], p[c]) <= 0 || geometry::orientation(p[a], p[c], p[d]) <= 0) return 0.0;
      return std::min(cross(p[b] - p[a], p[c] - p[a]), cross(p[c] - p[a], p[d] - p[a]));
    };
    const double first = lesser(0, 1, 2, 3), second = lesser(1, 2, 3, 0);
    if (first > 0 && first >= second) triangles = {{0, 1, 2}, {0, 2, 3}};
    else if (second > 0) triangles = {{1, 2, 3}, {1, 3, 0}};
  }
  if (triangles.empty()) {
    if (!geometry::is_simple(polygon) && face.loops.size() == 1)
      return base::error("geometry-triangulate", "a face's boundary crosses itself");
    auto found = geometry::triangulate(polygon);
    if (!found) return found.error();
    triangles = std::move(*found);
  }
  for (auto& triangle : triangles)
    for (auto& v : triangle) v = corners[v];
  return triangles;
}

auto above(Point3 a, Point3 b, Point3 c, Point3 d) -> int {
  const Point3 p = a - d, q = b - d, r = c - d;
  const double px_qy = p.x * q.y, py_qx = p.y * q.x, qx_ry = q.x * r.y, qy_rx = q.y * r.x, rx_py = r.x * p.y,
               ry_px = r.y * p.x;
  const double det = r.z * (px_qy - py_qx) + p.z * (qx_ry - qy_rx) + q.z * (rx_py - ry_px);
  const double magnitude = std::abs(r.z) * (std::abs(px_qy) + std::abs(py_qx)) +
                           std::abs(p.z) * (std::abs(qx_ry) + std::abs(qy_rx)) +
                           std::abs(q.z) * (std::abs(rx_py) + std::abs(ry_px));
  // Shewchuk's bound for this expression: (7 + 56u)u with u = 2^-53. Positive means d below, as the paper defines it.
  constexpr double bound = 7.771561172376103e-16;
  if (std::abs(det) > bound * magnitude && std::abs(det) > 1e-280) return det > 0 ? -1 : 1;
  const mpq_class ax(a.x), ay(a.y), az(a.z), bx(b.x), by(b.y), bz(b.z), cx(c.x), cy(c.y), cz(c.z), dx(d.x), dy(d.y),
      dz(d.z);
  const mpq_class px = ax - dx, py = ay - dy, pz = az - dz, qx = bx - dx, qy = by - dy, qz = bz - dz, rx = cx - dx,
                  ry = cy - dy, rz = cz - dz;
  const mpq_class exact = rz * (px * qy - py * qx) + pz * (qx * ry - qy * rx) + qz * (rx * py - ry * px);
  return -sgn(exact);
}

}  // namespace mansard::extrude::detail
