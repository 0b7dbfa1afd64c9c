#include "mansard/solid/detail/measure.hpp"

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "mansard/geometry/predicates.hpp"

namespace mansard::solid::detail {

using geometry::Point2;
using geometry::Point3;

auto area_vector(const model::Solid& solid, const model::Face& face) -> Point3 {
  Point3 sum;
  if (face.loops.empty() || face.loops[0].empty()) return sum;
  const Point3 o = solid.vertices[face.loops[0][0]];
  for (const auto& loop : face.loops)
    for (std::size_t i = 0; i < loop.size(); ++i)
      sum = sum + cross(solid.vertices[loop[i]] - o, solid.vertices[loop[(i + 1) % loop.size()]] - o);
  return sum;
}

auto triangles_of(const model::Solid& solid, const model::Face& face) -> base::Result<std::vector<Corners>> {
  std::vector<Corners> triangles;
  if (!Triangulator(solid).append(face, area_vector(solid, face), triangles))
    return base::error("geometry-triangulate", "a face's boundary crosses itself");
  return triangles;
}

// Error bounds of the filters by J. R. Shewchuk, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
// Predicates, 1997: ccwerrboundA = (3 + 16 u) u and o3derrboundA = (7 + 56 u) u with u = 2⁻⁵³, rounded to doubles. They
// are tight to the last unit, and hold for vertices that are doubles.
constexpr double turn_error = 3.3306690738754716e-16, above_error = 7.771561172376103e-16;
/// Shewchuk's bounds leave out underflow. It takes 2⁻¹⁰⁷⁴ from a product at most, in above() times a difference below
/// 2⁸⁰ (coordinates below 1e24 m): 6e-300, which is less than the bounds times this, 3e-296.
constexpr double no_underflow = 1e-280;

auto turn(Point2 a, Point2 b, Point2 c) -> int {
  const double ux = a.x - c.x, uy = a.y - c.y, vx = b.x - c.x, vy = b.y - c.y;
  const double l = ux * vy, r = uy * vx, area = l - r;
  if (std::abs(area) > turn_error * (std::abs(l) + std::abs(r)) && std::abs(area) > no_underflow)
    return area > 0 ? 1 : -1;
  // Where the differences are exact, as they are on a grid, two equal products with equal errors are no area at all.
  const auto exact = [](double p, double q, double difference) {
    return p - difference == q && difference + q == p;  // then the rounding error of the difference is 0
  };
  if (exact(a.x, c.x, ux) && exact(a.y, c.y, uy) && exact(b.x, c.x, vx) && exact(b.y, c.y, vy)) {
    if ((ux == 0 || vy == 0) && (uy == 0 || vx == 0)) return 0;
    // The errors of both products are multiples of 2^-104 of them and more, so that no digit of them underflows.
    if (l == r && std::abs(l) > no_underflow) {
      const double el = std::fma(ux, vy, -l), er = std::fma(uy, vx, -r);
      return (el > er) - (el < er);
    }
  }
  return geometry::orientation(a, b, c);
}

namespace {

__extension__ typedef __int128 Int128;

auto sign(Int128 value) -> int { return (value > 0) - (value < 0); }

/// The difference as a whole multiple of 1 / `scale`; false when it is none, or not below 2^40 of them.
auto on_raster(double p, double q, double scale, std::int64_t& out) -> bool {
  constexpr double most = 0x1.0p40;
  const double difference = p - q, multiple = difference * scale;
  if (!(std::abs(multiple) < most) || p - difference != q || difference + q != p) return false;
  out = static_cast<std::int64_t>(multiple);
  return static_cast<double>(out) == multiple;
}

/// The coordinates as whole multiples of one power of two: exact for all finite doubles.
auto whole(std::array<double, 12> values) -> std::array<mpz_class, 12> {
  std::array<std::int64_t, 12> mantissas{};
  std::array<int, 12> exponents{};
  int least = std::numeric_limits<int>::max();
  for (std::size_t i = 0; i < values.size(); ++i) {
    constexpr int digits = std::numeric_limits<double>::digits;
    mantissas[i] = static_cast<std::int64_t>(std::ldexp(std::frexp(values[i], &exponents[i]), digits));
    exponents[i] -= digits;
    if (mantissas[i] != 0) least = std::min(least, exponents[i]);
  }
  std::array<mpz_class, 12> result;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (mantissas[i] == 0) continue;
    result[i] = static_cast<long>(mantissas[i]);
    result[i] <<= static_cast<unsigned long>(exponents[i] - least);
  }
  return result;
}

}  // namespace

auto above(Point3 a, Point3 b, Point3 c, Point3 d) -> int {
  const Point3 p = a - d, q = b - d, r = c - d;
  const double px_qy = p.x * q.y, py_qx = p.y * q.x, qx_ry = q.x * r.y, qy_rx = q.y * r.x, rx_py = r.x * p.y,
               ry_px = r.y * p.x;
  const double det = r.z * (px_qy - py_qx) + p.z * (qx_ry - qy_rx) + q.z * (rx_py - ry_px);
  const double magnitude = std::abs(r.z) * (std::abs(px_qy) + std::abs(py_qx)) +
                           std::abs(p.z) * (std::abs(qx_ry) + std::abs(qy_rx)) +
                           std::abs(q.z) * (std::abs(rx_py) + std::abs(ry_px));
  // Positive means d below, as the paper defines it.
  if (std::abs(det) > above_error * magnitude && std::abs(det) > no_underflow) return det > 0 ? -1 : 1;
  // Corners on a raster of 2^-20 m within 2^20 m, the kernel's own among them: differences are integers below
  // 2^40, minors below 2^81, their products with a third below 2^121, and the sum of three below 2^123.
  std::array<std::int64_t, 9> k{};
  constexpr double scale = 0x1.0p20;
  if (on_raster(a.x, d.x, scale, k[0]) && on_raster(a.y, d.y, scale, k[1]) && on_raster(a.z, d.z, scale, k[2]) &&
      on_raster(b.x, d.x, scale, k[3]) && on_raster(b.y, d.y, scale, k[4]) && on_raster(b.z, d.z, scale, k[5]) &&
      on_raster(c.x, d.x, scale, k[6]) && on_raster(c.y, d.y, scale, k[7]) && on_raster(c.z, d.z, scale, k[8])) {
    const auto minor = [&](std::size_t i, std::size_t j) {
      return static_cast<Int128>(k[i]) * k[j + 1] - static_cast<Int128>(k[i + 1]) * k[j];
    };
    return -sign(k[8] * minor(0, 3) + k[2] * minor(3, 6) + k[5] * minor(6, 0));
  }
  auto v = whole({a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, d.x, d.y, d.z});
  for (std::size_t i = 0; i < 9; ++i) v[i] -= v[9 + i % 3];
  const mpz_class exact =
      v[8] * (v[0] * v[4] - v[1] * v[3]) + v[2] * (v[3] * v[7] - v[4] * v[6]) + v[5] * (v[6] * v[1] - v[7] * v[0]);
  return -sgn(exact);
}

}  // namespace mansard::solid::detail
