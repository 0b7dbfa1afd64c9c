// Heights of a surface seen from above, on a grid.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "mansard/geometry/points.hpp"

namespace mansard::refine::detail {

/// Heights above a part's base; NaN where nothing was seen, or outside the part.
struct Heights {
  geometry::Point2 origin;  ///< centre of cell (0, 0), metres
  double spacing = 0.25;    ///< m
  std::size_t columns = 0, rows = 0;
  std::vector<double> z;  ///< m, row by row from the south
  [[nodiscard]] auto centre(std::size_t column, std::size_t row) const -> geometry::Point2 {
    return {origin.x + spacing * static_cast<double>(column), origin.y + spacing * static_cast<double>(row)};
  }
  /// Of an entry of `z`.
  [[nodiscard]] auto centre(std::size_t cell) const -> geometry::Point2 {
    return centre(cell % columns, cell / columns);
  }
  [[nodiscard]] auto at(std::size_t column, std::size_t row) const -> double { return z[row * columns + column]; }
};

/// Where the line of that y crosses the edge, if it does; an end counts for one of the two edges that share it.
inline void add_crossing(geometry::Point2 a, geometry::Point2 b, double y, std::vector<double>& crossings) {
  if ((a.y <= y) != (b.y <= y)) crossings.push_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
}

/// Sorts the crossings and calls see(column) for every cell of the row whose centre lies inside, by the even-odd rule.
template <class See>
void each_between(const Heights& grid, std::size_t row, std::vector<double>& crossings, See see) {
  std::ranges::sort(crossings);
  for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
    const double first = std::ceil((crossings[k] - grid.origin.x) / grid.spacing);
    for (auto column = static_cast<std::size_t>(std::max(0.0, first)); column < grid.columns; ++column) {
      if (grid.centre(column, row).x >= crossings[k + 1]) break;
      see(column);
    }
  }
}

}  // namespace mansard::refine::detail
