// How accurate a scan is: what every decision about it is measured against.
#pragma once

#include <cmath>
#include <cstddef>

#include "mansard/geometry/points.hpp"

namespace mansard::model {

/// The accuracy of a scan over some ground. The initialisers are what is assumed where nothing could be measured: a
/// fair photogrammetric mesh (docs/accuracy.md).
struct Accuracy {
  double noise = 0.1;           ///< m; standard deviation of the surface along its normal
  double correlated_area = 10;  ///< m²; the area over which that noise is one error: ∫ of its autocorrelation
  double spacing = 0.5;         ///< m; nominal spacing of what was sampled
  double blur = 0.25;           ///< m; standard deviation of the smoothing of edges and steps; 0: sharp
  double edge_noise = 0.1;      ///< m; standard deviation of where a straight edge is seen along it
  double point_area = 0;        ///< m²; the ground that a measured point stands for; 0: the scan is a surface
  double walls = 1;             ///< share of the walls' height that the scan shows
  geometry::Point2 offset;      ///< m; what to add to the footprints to bring them to the scan
  double offset_error = 0;      ///< m; standard error of each coordinate of it
  double offset_spread = 0;     ///< m; standard deviation from wall to wall about it
  std::size_t windows = 0;      ///< what noise was measured in; 0: assumed
  std::size_t transects = 0;    ///< what blur was measured along; 0: assumed
  std::size_t edges = 0;        ///< what offset and spread were measured from; 0: not measured

  /// m²·m²: what a number that is fitted to noise takes off the sum of squared differences, on average: the sum is over
  /// samples times the area of each, so that the noise of one independent area counts σ² A.
  [[nodiscard]] auto chance() const -> double { return noise * noise * correlated_area; }
  /// m: standard error of a height that is the mean over so much ground, m².
  [[nodiscard]] auto height_error(double area) const -> double {
    return noise * std::sqrt(correlated_area / std::fmax(area, correlated_area));
  }
  /// m: root mean square distance of the noise from the plane that suits it best over a disc of this radius, m: within
  /// 8 % of the quadrature in docs/accuracy.md. A plane takes 3 A / π r² of the variance off a large disc.
  [[nodiscard]] auto off_plane(double radius) const -> double {
    constexpr double pi = 3.14159265358979323846;
    const double x = 2 * pi * radius * radius / correlated_area;  // (r / ℓ)², of A = 2 π ℓ²
    return noise / std::sqrt(1 + 6 / x + 6.7 / (x * x));
  }
  /// m: standard deviation of where an edge is seen, rounded as it is.
  [[nodiscard]] auto edge() const -> double { return std::sqrt(blur * blur + edge_noise * edge_noise); }
};

}  // namespace mansard::model
