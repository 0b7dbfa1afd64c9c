// Which cells of a model are far enough from its walls to be compared with a scan in height.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace mansard::evaluate {

/// Heights of a model's top surface on a grid, row by row.
struct HeightCells {
  static constexpr double outside = std::numeric_limits<double>::quiet_NaN();  ///< what is not looked at
  std::size_t columns = 0, rows = 0;
  double spacing = 0.25;        ///< m
  std::vector<double> heights;  ///< m
};

/// m; the difference in height of neighbouring cells that is a wall: 0.5 m, or more where a roof of 68° has that.
[[nodiscard]] auto step_of_walls(double spacing) -> double;

/// Whether each cell is to be compared: not where a wall (step_of_walls) or the end of the cells is nearer than
/// `reach`, m: there a scan shows either side of the wall, and the height of the wall would count as an error of the
/// roof. Where less than a fifth of the cells were left, `reach` is as much smaller as is needed for that; with 0, and
/// where nothing else helps, all are compared.
[[nodiscard]] auto away_from_walls(const HeightCells& cells, double reach) -> std::vector<bool>;

}  // namespace mansard::evaluate
