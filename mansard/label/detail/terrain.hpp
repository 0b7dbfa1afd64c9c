// The ground of a scan, as heights on a grid.
#pragma once

#include <functional>
#include <vector>

#include "mansard/geometry/mesh.hpp"

namespace mansard::label::detail {

[[nodiscard]] inline auto centre_of(const geometry::Mesh& mesh, const geometry::Triangle& t) -> geometry::Point3 {
  return (1.0 / 3) * (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]);
}
/// Twice the area, along the normal.
[[nodiscard]] inline auto area_vector(const geometry::Mesh& mesh, const geometry::Triangle& t) -> geometry::Point3 {
  return cross(mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]]);
}

class Terrain {
 public:
  /// Of the centres of the triangles that `use` says, the low end (the 10th percentile) in every cell. A cell that is
  /// empty, or higher than a slope of `steepest` up from another one, as under trees and roofs, takes that one's
  /// height.
  Terrain(const geometry::Mesh& mesh, const std::function<bool(std::size_t)>& use, double size, double steepest);

  /// z in metres, between the cells' centres; infinite where no triangle was of use.
  [[nodiscard]] auto at(geometry::Point2 p) const -> double;

 private:
  /// `reach` is how low the ground must be for all that is known: the height of some cell, and the slope up from there.
  struct Cell {
    double reach = 0, height = 0;
  };
  [[nodiscard]] auto cell(std::int64_t column, std::int64_t row) const -> Cell;
  void level(double steepest);

  geometry::Point2 origin_;
  double size_;
  std::int64_t columns_ = 0, rows_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace mansard::label::detail
