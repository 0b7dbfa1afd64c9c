#include "mansard/solid/detail/flatness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace mansard::solid::detail {
namespace {

using geometry::Point3;

using Matrix = std::array<std::array<double, 3>, 3>;

/// The eigenvector of the least eigenvalue of a symmetric matrix, by Jacobi's rotations.
auto least_eigenvector(Matrix m) -> Point3 {
  constexpr int sweeps = 12;  // they converge quadratically: six do for doubles
  Matrix vectors{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (const auto& [p, q] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
      if (m[p][q] == 0) continue;
      const double angle = 0.5 * std::atan2(2 * m[p][q], m[q][q] - m[p][p]), c = std::cos(angle), s = std::sin(angle);
      for (auto* rows : {&m, &vectors})
        for (auto& row : *rows) {
          const double at_p = row[p];
          row[p] = c * at_p - s * row[q];
          row[q] = s * at_p + c * row[q];
        }
      for (int k = 0; k < 3; ++k) {
        const double at_p = m[p][k];
        m[p][k] = c * at_p - s * m[q][k];
        m[q][k] = s * at_p + c * m[q][k];
      }
    }
  int least = 0;
  for (int k = 1; k < 3; ++k)
    if (m[k][k] < m[least][least]) least = k;
  return {vectors[0][least], vectors[1][least], vectors[2][least]};
}

/// The normal of the plane with the least sum of weighted squares, and the weighted mean, which is on it.
auto fitted(const std::vector<Point3>& points, const std::vector<double>& weights) -> std::pair<Point3, Point3> {
  Point3 mean;
  for (std::size_t i = 0; i < points.size(); ++i) mean = mean + weights[i] * points[i];
  Matrix covariance{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point3 d = points[i] - mean;
    const std::array<double, 3> c{d.x, d.y, d.z};
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) covariance[j][k] += weights[i] * c[j] * c[k];
  }
  return {least_eigenvector(covariance), mean};
}

}  // namespace

auto bend(const model::Solid& solid, const model::Face& face, Point3 direction) -> double {
  const Point3 n = normalised(direction), o = solid.vertices[face.loops[0][0]];
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const auto& loop : face.loops)
    for (const std::uint32_t v : loop) {
      const double d = dot(n, solid.vertices[v] - o);
      least = std::min(least, d);
      most = std::max(most, d);
    }
  return (most - least) / 2;
}

auto least_bend(const model::Solid& solid, const model::Face& face, Point3 direction, double enough) -> double {
  constexpr int rounds = 200;
  double best = bend(solid, face, direction);
  std::vector<Point3> points;
  const Point3 o = solid.vertices[face.loops[0][0]];
  for (const auto& loop : face.loops)
    for (const std::uint32_t v : loop) points.push_back(solid.vertices[v] - o);
  std::vector<double> weights(points.size(), 1 / static_cast<double>(points.size()));
  for (int round = 0; round < rounds && best > enough; ++round) {
    const auto [normal, mean] = fitted(points, weights);
    best = std::min(best, bend(solid, face, normal));
    double sum = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      weights[i] *= std::abs(dot(normal, points[i] - mean));
      sum += weights[i];
    }
    if (!(sum > 0)) break;
    for (double& weight : weights) weight /= sum;
  }
  return best;
}

}  // namespace mansard::solid::detail
