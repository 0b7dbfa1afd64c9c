// The top surface of a mesh on a grid, and what is seen below it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mansard/geometry/mesh.hpp"
#include "mansard/vegetation/vegetation.hpp"

namespace mansard::vegetation::detail {

/// Cells of one size, aligned to integer multiples of it.
struct Grid {
  double spacing = 0.25;
  std::int64_t column = 0, row = 0;  ///< of the first cell, counted from the origin of the frame
  std::size_t columns = 0, rows = 0;
  [[nodiscard]] auto size() const -> std::size_t { return columns * rows; }
  [[nodiscard]] auto centre(std::size_t x, std::size_t y) const -> geometry::Point2 {
    return {(static_cast<double>(column + static_cast<std::int64_t>(x)) + 0.5) * spacing,
            (static_cast<double>(row + static_cast<std::int64_t>(y)) + 0.5) * spacing};
  }
  [[nodiscard]] auto centre(std::size_t cell) const -> geometry::Point2 {
    return centre(cell % columns, cell / columns);
  }
};

/// Calls go(cell, columns, rows) for the cells of the square of 2 · reach + 1 cells around one, with how far off they
/// are.
template <class Go>
void each_around(const Grid& grid, std::size_t cell, std::int64_t reach, Go go) {
  const auto column = static_cast<std::int64_t>(cell % grid.columns);
  const auto row = static_cast<std::int64_t>(cell / grid.columns);
  for (std::int64_t y = -reach; y <= reach; ++y)
    for (std::int64_t x = -reach; x <= reach; ++x)
      if (column + x >= 0 && row + y >= 0 && column + x < static_cast<std::int64_t>(grid.columns) &&
          row + y < static_cast<std::int64_t>(grid.rows))
        go(static_cast<std::size_t>(row + y) * grid.columns + static_cast<std::size_t>(column + x), x, y);
}

struct Surface {
  Grid grid;
  std::vector<double> top;    ///< z, metres; NaN where nothing is
  std::vector<double> under;  ///< z of the highest underside below the top; NaN where none is
};

/// `triangles`: those of the mesh that may lie over the grid.
[[nodiscard]] auto surface_of(const geometry::Mesh& mesh, std::span<const std::uint32_t> triangles, const Grid& grid)
    -> Surface;

/// A plane through the samples of a square.
struct Fitted {
  double rms = 0;          ///< m perpendicular to it; infinite where too little is known
  geometry::Point2 slope;  ///< rise per metre
  double middle = 0;       ///< z in the middle of the square
};
/// Through the squares of 2 · half + 1 samples around every sample.
[[nodiscard]] auto planes_of(const Surface& surface, std::size_t half) -> std::vector<Fitted>;

/// The least, or the highest, of the squares of 2 · half + 1 cells around every cell.
[[nodiscard]] auto least_around(const Grid& grid, const std::vector<double>& values, std::size_t half)
    -> std::vector<double>;
[[nodiscard]] auto greatest_around(const Grid& grid, const std::vector<double>& values, std::size_t half)
    -> std::vector<double>;

/// A connected region of the surface that is no plane.
struct Blob {
  Crown seen;
  std::vector<std::uint32_t> cells;  ///< ascending
  bool hangs = false;                ///< over what is below it, as a crown does
  bool dome = false;                 ///< hangs over too little for a crown, but has the shape of one
  bool too_long = false;             ///< longer than the margin around a tile
};
/// Those that begin in the core of the grid, `halo` cells from its border.
[[nodiscard]] auto blobs_of(const Surface& surface, std::size_t halo, std::span<const geometry::Polygon> outline,
                            const Options& options) -> std::vector<Blob>;

[[nodiscard]] auto is_crown(const Blob& blob, const Options& options) -> bool;

/// Whether a region covers more than half of one of the footprints.
[[nodiscard]] auto covers_any(const Blob& blob, const Grid& grid,
                              std::span<const std::vector<geometry::Polygon>> footprints) -> bool;

/// Whether a region is an annex that the scan has rounded: it ends where the outline does and leans on what is higher.
[[nodiscard]] auto is_annex(const Blob& blob, const Surface& surface, std::span<const geometry::Polygon> outline)
    -> bool;

}  // namespace mansard::vegetation::detail
