// A part's heights on a grid that lies along one of its directions, so that walls along it are rows and columns.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "mansard/geometry/polygon.hpp"
#include "mansard/refine/detail/heights.hpp"
#include "mansard/refine/options.hpp"

namespace mansard::refine::detail::carve {

/// Axes of the plane: first points along `axis`, second to its left.
struct Frame {
  geometry::Point2 axis{1, 0};  ///< unit
  [[nodiscard]] auto to(geometry::Point2 p) const -> geometry::Point2 {
    return {dot(p, axis), dot(p, geometry::left_of(axis))};
  }
  [[nodiscard]] auto back(geometry::Point2 p) const -> geometry::Point2 {
    return p.x * axis + p.y * geometry::left_of(axis);
  }
};

[[nodiscard]] auto in_frame(const geometry::Polygon& polygon, const Frame& frame) -> geometry::Polygon;
[[nodiscard]] auto from_frame(const geometry::Polygon& polygon, const Frame& frame) -> geometry::Polygon;

enum class Cell : std::uint8_t { outside, unseen, seen };

struct Raster {
  Frame frame;
  geometry::Polygon part;  ///< in the frame
  geometry::Point2 least;  ///< centre of cell (0, 0), in the frame
  double spacing = 0.25;   ///< m
  int columns = 0, rows = 0;
  std::vector<Cell> state;
  std::vector<float> z;         ///< m, 0 where not seen
  std::vector<float> residual;  ///< m, measured less model; 0 where not seen

  [[nodiscard]] auto at(int column, int row) const -> std::size_t {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
  [[nodiscard]] auto inside(int column, int row) const -> bool {
    return column >= 0 && row >= 0 && column < columns && row < rows && state[at(column, row)] != Cell::outside;
  }
  [[nodiscard]] auto x(int column) const -> double { return least.x + spacing * column; }
  [[nodiscard]] auto y(int row) const -> double { return least.y + spacing * row; }
  [[nodiscard]] auto cell_area() const -> double { return spacing * spacing; }
};

/// The part's cells, by linear interpolation of what was seen; with axis (1, 0) the cells of the heights themselves.
[[nodiscard]] auto raster_of(const geometry::Polygon& part, const Heights& measured, const Heights& model,
                             const Frame& frame, const Options::Directions& options) -> Raster;

/// The same with its axes exchanged.
[[nodiscard]] auto turned(const Raster& raster) -> Raster;

/// Which cells have their centre in the polygon, given in the raster's frame; 1 or 0 per cell.
[[nodiscard]] auto cells_in(const geometry::Polygon& polygon, const Raster& raster) -> std::vector<std::uint8_t>;

/// The direction in which most of the part's edges go, by length, modulo 90°.
[[nodiscard]] auto direction_of(const geometry::Polygon& part, const Options::Directions& options) -> Frame;

}  // namespace mansard::refine::detail::carve
