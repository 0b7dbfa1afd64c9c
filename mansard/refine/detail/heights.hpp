// Heights of a surface seen from above, on a grid.
#pragma once

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
  [[nodiscard]] auto at(std::size_t column, std::size_t row) const -> double { return z[row * columns + column]; }
};

}  // namespace mansard::refine::detail
