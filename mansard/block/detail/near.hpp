// Which triangles lie near an outline.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mansard/geometry/box_index.hpp"
#include "mansard/geometry/mesh.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::block::detail {

using PlanTriangle = std::array<geometry::Point2, 3>;

[[nodiscard]] inline auto plan_of(const geometry::Mesh& mesh, const geometry::Triangle& t) -> PlanTriangle {
  return {xy(mesh.vertices[t[0]]), xy(mesh.vertices[t[1]]), xy(mesh.vertices[t[2]])};
}

/// Answers whether a triangle, seen from above, has a point within `reach` metres of an area (or in it). Most triangles
/// are decided by the cells of a raster that are wholly near or wholly far; the rest by exact distances to the edges.
class Nearness {
 public:
  Nearness(const std::vector<geometry::Polygon>& area, double reach);

  [[nodiscard]] auto operator()(const PlanTriangle& triangle) const -> bool;
  /// Whether the point is within reach.
  [[nodiscard]] auto operator()(geometry::Point2 p) const -> bool;
  /// Everything near is within this box.
  [[nodiscard]] auto box() const -> const geometry::Box2& { return box_; }

 private:
  enum class Cell : std::uint8_t { far, near, mixed };

  [[nodiscard]] auto place(double along, double least, std::size_t count) const -> std::size_t;
  [[nodiscard]] auto exactly(const PlanTriangle& triangle) const -> bool;
  [[nodiscard]] auto holds(geometry::Point2 p) const -> bool;
  /// m to the area, 0 inside.
  [[nodiscard]] auto distance(geometry::Point2 p) const -> double;

  std::vector<geometry::Polygon> area_;
  std::vector<geometry::Box2> boxes_;  ///< of the polygons
  std::vector<geometry::Segment2> edges_;
  geometry::BoxIndex index_;  ///< of the edges, where they are many
  double reach_ = 0, size_ = 1;
  geometry::Box2 box_;
  std::size_t columns_ = 0, rows_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace mansard::block::detail
