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

  /// A place where a vertical line crosses the mesh.
  struct Crossing {
    double z = 0;
    bool upward = false;  ///< whether the triangle's front is above
    std::uint32_t triangle = 0;
  };
  /// All crossings, the topmost first; one of those at the same height and the same way, as on a common edge.
  void crossings(geometry::Point2 at, std::vector<Crossing>& out) const;

 private:
  /// One coordinate of the grid: cells of equal size from `least` on.
  struct Axis {
    double least = 0, size = 1;
    std::size_t count = 1;
    [[nodiscard]] auto cell(double along) const -> std::size_t;
  };
  /// A triangle with an area in plan: its box in plan and its top, rounded outward to floats, as a first answer.
  struct Flat {
    float west = 0, south = 0, east = 0, north = 0, top = 0;
    std::uint32_t triangle = 0;
  };
  [[nodiscard]] auto cell_of(geometry::Point2 p) const -> std::size_t { return y_.cell(p.y) * x_.count + x_.cell(p.x); }
  template <class Visit>
  void each_cell(const Flat& one, Visit visit) const;
  /// visit(Flat, corners, z) for every triangle over a point of which wanted(Flat) holds, z where the point is.
  template <class Wanted, class Visit>
  void each_over(geometry::Point2 at, Wanted wanted, Visit visit) const;
  void choose_cells(const geometry::Box2& box);
  void order_by_cell();
  [[nodiscard]] auto entries() const -> std::size_t;
  void fill();

  const geometry::Mesh* mesh_;
  std::vector<Flat> flat_;  ///< by the cells of their south-western corners, in the mesh's order
  geometry::Box2 box_;
  Axis x_, y_;
  std::vector<std::size_t> start_;     ///< of cell i: inside_[start_[i]] … inside_[start_[i + 1] - 1]
  std::vector<std::uint32_t> inside_;  ///< indices into flat_
};

}  // namespace mansard::rays::detail
