// A tile of cells with its points.
#pragma once

#include <cstdint>
#include <vector>

#include "mansard/cloud/cloud.hpp"

namespace mansard::cloud::detail {

/// Coordinates are integers in this unit, so that sums do not depend on the order of points: 2⁻¹² m, a quarter of a
/// millimetre.
constexpr std::int64_t per_metre = 4096;
constexpr std::int64_t tile_cells = 256;
/// Cells around a tile that its surface depends on; more than any step below looks.
constexpr std::int64_t halo = 40;
constexpr std::int64_t window = tile_cells + 2 * halo;

/// A point in a tile's window.
struct Point {
  std::int32_t x = 0, y = 0;  ///< from the window's south-west corner
  std::int32_t z = 0;
  std::uint8_t classification = 0;
  std::uint8_t flags = 0;    ///< see below
  std::uint16_t source = 0;  ///< the strip; 0: not known
};
constexpr std::uint8_t only_return = 1, last_return = 2;

/// A height of a cell, and where in the cell it was measured: the mean of the points that it is of.
struct Height {
  std::uint32_t points = 0;    ///< 0: none; a filled one has 1
  double x = 0, y = 0, z = 0;  ///< m, from the window's south-west corner; z absolute
  std::int32_t least = 0;      ///< z of the lowest point that it is of
  bool building = false;       ///< most of its points are of class 6
  bool filled = false;
};

/// Cells row by row from the south-west.
class Grid {
 public:
  Grid(std::vector<Point> points, std::int64_t cell, Buildings buildings);

  [[nodiscard]] auto at(std::int64_t column, std::int64_t row) const -> const Height& {
    return heights_[index(column, row)];
  }
  [[nodiscard]] auto at(std::int64_t column, std::int64_t row) -> Height& { return heights_[index(column, row)]; }
  [[nodiscard]] static auto inside(std::int64_t column, std::int64_t row) -> bool {
    return column >= 0 && row >= 0 && column < window && row < window;
  }
  /// The points of a cell, from the highest down.
  [[nodiscard]] auto points_of(std::int64_t column, std::int64_t row) const -> std::span<const Point> {
    const auto i = index(column, row);
    return std::span(points_).subspan(starts_[i], starts_[i + 1] - starts_[i]);
  }
  [[nodiscard]] auto side() const -> double { return static_cast<double>(cell_) / per_metre; }
  [[nodiscard]] auto buildings() const -> Buildings { return buildings_; }

  /// Gives every cell the height of one layer: points without a gap of `step` between them. By class, it is the highest
  /// of which most points are of a building, else the one with most points, the higher of two with as many; by `top`,
  /// it is the highest.
  void choose(double step);
  /// Gives a cell its next lower layer, or none.
  void lower(std::int64_t column, std::int64_t row, double step);

  [[nodiscard]] static auto index(std::int64_t column, std::int64_t row) -> std::size_t {
    return static_cast<std::size_t>(row * window + column);
  }

 private:
  [[nodiscard]] auto layer_below(std::size_t cell, std::int64_t top, std::int64_t step, bool highest) const -> Height;

  std::int64_t cell_;
  Buildings buildings_;
  std::vector<Point> points_;
  std::vector<std::uint32_t> starts_;
  std::vector<Height> heights_;
};

/// Removes points that belong to no surface and fills small gaps; counts the cells of the tile itself.
void clean(Grid& grid, const Options& options, Counts& counts);

/// The surface of the tile's own cells, from the window's south-west corner, and its points.
[[nodiscard]] auto mesh_of(const Grid& grid, const Options& options) -> geometry::Mesh;
/// The points in the tile's own cells, all that may be of a surface: those with another return below them are not in
/// the grid where buildings are found by shape.
[[nodiscard]] auto points_of(const Grid& grid) -> std::vector<geometry::Point3>;

}  // namespace mansard::cloud::detail
