// Vertical distances of measured points to a model, as point-based tools report them.
#pragma once

#include <cstddef>
#include <span>

#include "mansard/geometry/mesh.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::evaluate {

struct PointScores {
  std::size_t points = 0;  ///< given
  std::size_t without_model =
      0;                       ///< of these, with no surface of the model above or below; they are in no other number
  double median = 0;           ///< m, signed: point − model
  double median_absolute = 0;  ///< m
  double rmse = 0;             ///< m
  double within_10cm = 0, within_25cm = 0, within_50cm = 0;  ///< shares of the points with a model
};

/// Of every point to the topmost surface of the model above or below it. The same input gives the same numbers at any
/// thread count. Cost: O((n + m) log n) for n triangles, m points.
[[nodiscard]] auto point_scores(const geometry::Mesh& model, std::span<const geometry::Point3> points) -> PointScores;

}  // namespace mansard::evaluate
