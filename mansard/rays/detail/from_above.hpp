// The top surface of a mesh, seen along vertical lines: in doubles, the same on every processor.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "mansard/geometry/mesh.hpp"

namespace mansard::rays::detail {

/// The triangles of a mesh by the cells of a grid in plan.
/// Guarantees: 1 every point of the plan of a triangle that is not vertical is on that triangle: whether a point is in
/// a triangle is decided exactly, edges included · 2 the result depends on the triangles alone, and where two are
/// equally high it is the one with the lower index · 3 a height is never outside its triangle's.
/// Cost: O(n) to build and in memory; O(triangles over a cell) per query.
class FromAbove {
 public:
  explicit FromAbove(const geometry::Mesh& mesh);

  struct Seen {
    double z = 0;
    std::uint32_t triangle = 0;
  };
  [[nodiscard]] auto operator()(geometry::Point2 at) const -> std::optional<Seen>;

 private:
  /// One coordinate of the grid: cells of equal size from `least` on.
  struct Axis {
    double least = 0, size = 1;
    std::size_t count = 1;
    [[nodiscard]] auto cell(double along) const -> std::size_t;
  };
  void choose_cells(const geometry::Box2& box);
  [[nodiscard]] auto entries() const -> std::size_t;
  void fill();

  const geometry::Mesh* mesh_;
  std::vector<std::uint32_t> flat_;    ///< triangles with an area in plan
  std::vector<geometry::Box2> boxes_;  ///< of these, in plan
  std::vector<std::int8_t> turns_;     ///< the orientation of each, in plan
  geometry::Box2 box_;
  Axis x_, y_;
  std::vector<std::size_t> start_;     ///< of cell i: inside_[start_[i]] … inside_[start_[i + 1] - 1]
  std::vector<std::uint32_t> inside_;  ///< indices into flat_, ascending per cell
};

}  // namespace mansard::rays::detail
