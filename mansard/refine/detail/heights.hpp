// Heights of a surface seen from above, on a grid.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
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

/// Samples, points or the cells of a grid, and what they lie on.
struct OnPlanes {
  std::span<const geometry::Point2> places;
  std::span<const std::uint32_t> planes;  ///< of each: a number of a plane, or one of planes::Found
  std::span<const double> heights;        ///< of each; m above the base
  double area = 0;                        ///< m²: the ground of one
  bool of_points = false;
};

/// Where the line of that y crosses the edge, if it does; an end counts for one of the two edges that share it.
inline void add_crossing(geometry::Point2 a, geometry::Point2 b, double y, std::vector<double>& crossings) {
  if ((a.y <= y) != (b.y <= y)) crossings.push_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
}

/// Sorts the crossings of a row and calls see(first, last) for the columns [first, last) whose centres lie inside, by
/// the even-odd rule.
template <class See>
void each_span(const Heights& grid, std::vector<double>& crossings, See see) {
  if (crossings.size() == 2) {  // nearly always
    if (crossings[1] < crossings[0]) std::swap(crossings[0], crossings[1]);
  } else {
    std::ranges::sort(crossings);
  }
  // The number of the first column that is not left of x: within a cell of what the quotient says.
  const auto column_at = [&grid](double x) {
    const double most = static_cast<double>(grid.columns);
    return static_cast<std::size_t>(std::clamp(std::ceil((x - grid.origin.x) / grid.spacing), 0.0, most));
  };
  for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
    const std::size_t first = column_at(crossings[k]);
    std::size_t last = std::max(first, column_at(crossings[k + 1]));
    while (last > first && grid.centre(last - 1, 0).x >= crossings[k + 1]) --last;
    while (last < grid.columns && grid.centre(last, 0).x < crossings[k + 1]) ++last;
    if (first < last) see(first, last);
  }
}

/// The same, by column.
template <class See>
void each_between(const Heights& grid, std::vector<double>& crossings, See see) {
  each_span(grid, crossings, [&see](std::size_t first, std::size_t last) {
    for (std::size_t column = first; column < last; ++column) see(column);
  });
}

}  // namespace mansard::refine::detail
