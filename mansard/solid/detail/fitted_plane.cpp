#include "mansard/solid/detail/fitted_plane.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/base/statistics.hpp"
#include "mansard/solid/detail/measure.hpp"

namespace mansard::solid::detail {
namespace {

using geometry::Point3;
using Matrix = std::array<std::array<double, 3>, 3>;

struct Axes {
  Point3 least;                 ///< the eigenvector of the least eigenvalue
  std::array<double, 3> sizes;  ///< the eigenvalues, rising
};

/// Those of a symmetric matrix, by Jacobi's rotations (G. H. Golub, C. F. Van Loan,
/// Matrix Computations, section 8.5).
auto axes_of(Matrix m) -> Axes {
  Matrix v{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  constexpr int most_sweeps = 30;
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    const double off = std::abs(m[0][1]) + std::abs(m[0][2]) + std::abs(m[1][2]);
    if (off == 0) break;
    for (const auto& [p, q] : {std::pair{0U, 1U}, {0U, 2U}, {1U, 2U}}) {
      if (m[p][q] == 0) continue;
      const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
      const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
      const double c = 1 / std::sqrt(t * t + 1), s = t * c;
      for (std::size_t k = 0; k < 3; ++k) {
        const double kp = m[k][p], kq = m[k][q];
        m[k][p] = c * kp - s * kq, m[k][q] = s * kp + c * kq;
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const double pk = m[p][k], qk = m[q][k];
        m[p][k] = c * pk - s * qk, m[q][k] = s * pk + c * qk;
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const double kp = v[k][p], kq = v[k][q];
        v[k][p] = c * kp - s * kq, v[k][q] = s * kp + c * kq;
      }
    }
  }
  std::size_t least = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (m[i][i] < m[least][least]) least = i;
  std::array sizes{m[0][0], m[1][1], m[2][2]};
  std::ranges::sort(sizes);
  return {geometry::normalised(Point3{v[0][least], v[1][least], v[2][least]}), sizes};
}

}  // namespace

auto fitted_plane(const model::Solid& solid, const model::Face& face) -> FittedPlane {
  FittedPlane plane;
  double count = 0;
  const Point3 o = solid.vertices[face.loops[0][0]];
  for (const auto& loop : face.loops)
    for (const auto v : loop) plane.middle = plane.middle + (solid.vertices[v] - o), ++count;
  plane.middle = o + (1 / count) * plane.middle;
  Matrix m{};
  for (const auto& loop : face.loops)
    for (const auto v : loop) {
      const Point3 p = solid.vertices[v] - plane.middle;
      const std::array d{p.x, p.y, p.z};
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) m[i][k] += d[i] * d[k];
    }
  const Axes axes = axes_of(m);
  plane.normal = axes.least;
  plane.narrow = axes.sizes[2] > 0 ? std::sqrt(std::max(0.0, axes.sizes[1]) / axes.sizes[2]) : 0;
  if (dot(plane.normal, area_vector(solid, face)) < 0) plane.normal = -1 * plane.normal;
  for (const auto& loop : face.loops)
    for (const auto v : loop)
      plane.furthest = std::max(plane.furthest, std::abs(dot(plane.normal, solid.vertices[v] - plane.middle)));
  return plane;
}

auto offset_of_most(const model::Solid& solid, const model::Face& face) -> double {
  std::vector<double> offsets;
  for (const auto& loop : face.loops)
    for (const auto v : loop) offsets.push_back(dot(face.normal, solid.vertices[v]));
  return base::median(std::move(offsets));
}

}  // namespace mansard::solid::detail
