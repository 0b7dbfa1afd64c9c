// A grid over the plan whose cells are whole multiples of its spacing, and which of its cells polygons cover.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mansard/geometry/polygon.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::evaluate::detail {

/// Cell (i, j) is [i, i + 1]·spacing × [j, j + 1]·spacing and is sampled at its centre.
struct Grid {
  double spacing = 0.25;             ///< m
  std::int64_t column = 0, row = 0;  ///< of the south-west cell
  std::int64_t columns = 0, rows = 0;

  [[nodiscard]] auto centre(std::int64_t i, std::int64_t j) const -> geometry::Point2 {
    return {(static_cast<double>(column + i) + 0.5) * spacing, (static_cast<double>(row + j) + 0.5) * spacing};
  }
};

/// The cells that overlap the box in more than its border.
[[nodiscard]] auto grid_over(const geometry::Box2& box, double spacing) -> Grid;

/// Polygons prepared for queries row by row.
class Cover {
 public:
  explicit Cover(std::span<const geometry::Polygon> polygons);
  /// Per column of row `j`: whether its centre is in one of the polygons.
  [[nodiscard]] auto row(const Grid& grid, std::int64_t j) const -> std::vector<bool>;

 private:
  std::span<const geometry::Polygon> polygons_;
  std::vector<geometry::Box2> boxes_;
};

/// A cell of the grid, seen from above.
struct Cell {
  std::int64_t column = 0;
  geometry::Point2 centre;
  bool inside = false;                   ///< in one of the polygons
  std::optional<double> built, scanned;  ///< z of the model's and of the mesh's top surface
};

enum class Where : std::uint8_t { inside, everywhere };

/// Calls see(cell) for every cell of row `j` over which there is a polygon, or, everywhere, a polygon or a model; from
/// the west.
template <class See>
void each_cell(const Grid& grid, std::int64_t j, Where where, const Cover& cover, const rays::Scene& model,
               const rays::Scene& mesh, See see) {
  const auto inside = cover.row(grid, j);
  for (std::int64_t i = 0; i < grid.columns; ++i) {
    Cell cell{i, grid.centre(i, j), inside[static_cast<std::size_t>(i)], {}, {}};
    if (where == Where::inside && !cell.inside) continue;
    cell.built = model.top(cell.centre);
    if (!cell.built && !cell.inside) continue;
    cell.scanned = mesh.top(cell.centre);
    see(cell);
  }
}

}  // namespace mansard::evaluate::detail
