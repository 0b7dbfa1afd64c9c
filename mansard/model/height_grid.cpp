#include <cmath>

#include "mansard/model/scene.hpp"

namespace mansard::model {

auto HeightGrid::at(geometry::Point2 p) const -> std::optional<double> {
  const double x = (p.x - centre.x) / cell, y = (p.y - centre.y) / cell;
  if (!(x >= 0 && y >= 0) || columns < 2 || rows < 2) return std::nullopt;
  if (!(x <= static_cast<double>(columns - 1) && y <= static_cast<double>(rows - 1))) return std::nullopt;
  const auto i = std::min(static_cast<std::size_t>(x), columns - 2),
             j = std::min(static_cast<std::size_t>(y), rows - 2);
  const double u = x - static_cast<double>(i), v = y - static_cast<double>(j);
  const auto value = [&](std::size_t column, std::size_t row) -> double { return values[row * columns + column]; };
  const double z = (1 - v) * ((1 - u) * value(i, j) + u * value(i + 1, j)) +
                   v * ((1 - u) * value(i, j + 1) + u * value(i + 1, j + 1));
  if (std::isnan(z)) return std::nullopt;
  return z - base;
}

}  // namespace mansard::model
