// Planes in a cloud of measured points: the points that lie on each, and how well they say where it is.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "mansard/geometry/points.hpp"

namespace mansard::planes {

/// How accurate the points are (model::Accuracy), and what is of interest.
struct Options {
  double noise = 0.03;      ///< m; standard deviation of a point along the normal
  double point_area = 0.1;  ///< m²; of the ground that a point stands for
  double least_area = 1.0;  ///< m²; planes with fewer points than stand for this are none
};

/// z = middle.z + slope · (xy − middle), fitted to its points by least squares of vertical distances.
struct Plane {
  geometry::Point3 middle;            ///< m; of its points
  geometry::Point2 slope;             ///< rise per run
  double rms = 0;                     ///< m; of the points' vertical distances
  std::vector<std::uint32_t> points;  ///< ascending

  /// The covariance of its numbers: the variance of the height in the middle, m², and of the slopes, with which that is
  /// not correlated.
  double height_variance = 0, slope_xx = 0, slope_xy = 0, slope_yy = 0;

  [[nodiscard]] auto at(geometry::Point2 place) const -> double { return middle.z + dot(slope, place - xy(middle)); }
  /// m: standard error of the height there.
  [[nodiscard]] auto error_at(geometry::Point2 place) const -> double;
};

struct Found {
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::uint32_t wall = none - 1;  ///< on a plane that is steeper than any roof
  std::vector<Plane> planes;
  std::vector<std::uint32_t> plane_of;  ///< per point; none, or wall
};

/// Grows planes from the evenest places, as far as points lie within what noise explains. Guarantees: 1 the order of
/// `points` decides only between places that are as even to the last bit; sorted, the result is a function of the set
/// of points · 2 every point is in at most one plane, and the plane says so · 3 the same at any thread count.
/// Cost: O(n log n).
[[nodiscard]] auto find(std::span<const geometry::Point3> points, const Options& options) -> Found;

}  // namespace mansard::planes
