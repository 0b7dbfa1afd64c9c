// Plots of numbers: lines over a value, colours over two.
#pragma once

#include <string>
#include <vector>

#include "mansard/geometry/points.hpp"

namespace mansard::explore::detail {

/// Round values (1, 2 or 5 times a power of ten apart) from at most `least` to at least `most`, about `wanted` of them.
[[nodiscard]] auto ticks(double least, double most, std::size_t wanted) -> std::vector<double>;

struct Series {
  std::string name;
  std::vector<geometry::Point2> points;  ///< y NaN: a gap
};

struct LineChart {
  std::string title, x_label;
  std::vector<std::string> x_names;  ///< where x are words: those at x = 0, 1, …
  std::vector<Series> series;        ///< named below the plot where there are several
};
/// y starts at zero unless there are negative values.
[[nodiscard]] auto line_chart(const LineChart& chart) -> std::string;

struct HeatMap {
  std::string title, x_label, y_label;
  std::vector<std::string> x_names, y_names;
  std::vector<double> values;  ///< row by row, as many as x_names a row; NaN: empty
  int decimals = 0;
};
[[nodiscard]] auto heat_map(const HeatMap& map) -> std::string;

}  // namespace mansard::explore::detail
