// Values at the centres of square cells, row by row from the south-west.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "mansard/geometry/points.hpp"

namespace mansard::derive::detail {

/// Where cells lie.
struct Place {
  geometry::Point2 corner;  ///< the south-west one of cell (0, 0), metres
  double cell = 0.5;        ///< m
  std::size_t columns = 0, rows = 0;

  [[nodiscard]] auto size() const -> std::size_t { return columns * rows; }
  [[nodiscard]] auto index(std::size_t column, std::size_t row) const -> std::size_t { return row * columns + column; }
  [[nodiscard]] auto centre(std::size_t column, std::size_t row) const -> geometry::Point2 {
    return {corner.x + (static_cast<double>(column) + 0.5) * cell, corner.y + (static_cast<double>(row) + 0.5) * cell};
  }
  /// So many metres in whole cells, at least one.
  [[nodiscard]] auto cells(double metres) const -> std::size_t {
    return static_cast<std::size_t>(std::max(1.0, std::round(metres / cell)));
  }
};

using Heights = std::vector<float>;      ///< z or m; NaN for none
using Mask = std::vector<std::uint8_t>;  ///< 0 or 1

inline constexpr float none = std::numeric_limits<float>::quiet_NaN();

/// The four neighbours that exist.
template <class Visit>
void for_neighbours(const Place& place, std::size_t cell, Visit&& visit) {
  const std::size_t column = cell % place.columns, row = cell / place.columns;
  if (row > 0) visit(cell - place.columns);
  if (column > 0) visit(cell - 1);
  if (column + 1 < place.columns) visit(cell + 1);
  if (row + 1 < place.rows) visit(cell + place.columns);
}

/// Cells with a side in common, numbered from 1 in the order of their first cell; 0 outside the mask.
struct Blobs {
  std::vector<std::int32_t> of;      ///< per cell
  std::vector<std::size_t> size{0};  ///< cells of each; size[0] is not used
};
[[nodiscard]] auto blobs_of(const Place& place, const Mask& mask) -> Blobs;

/// The least, or with `most` the greatest, value of the square of (2 · reach + 1)² cells around each; NaN is passed
/// over.
[[nodiscard]] auto extreme(const Place& place, const Heights& heights, std::size_t reach, bool most) -> Heights;

/// Cells within so many cells (as the crow flies) of the mask; the mask without those within so many cells of what is
/// not in it. What
/// lies beyond the grid is like the grid's rim.
[[nodiscard]] auto grown(const Place& place, const Mask& mask, double cells) -> Mask;
[[nodiscard]] auto shrunk(const Place& place, const Mask& mask, double cells) -> Mask;

/// Sums over squares of (2 · reach + 1)² cells, clipped to the grid.
[[nodiscard]] auto sums(const Place& place, const std::vector<float>& values, std::size_t reach) -> std::vector<double>;

}  // namespace mansard::derive::detail
