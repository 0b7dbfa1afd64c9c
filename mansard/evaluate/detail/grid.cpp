#include "mansard/evaluate/detail/grid.hpp"
#include "mansard/geometry/edges.hpp"

#include <algorithm>
#include <cmath>

namespace mansard::evaluate::detail {

auto grid_over(const geometry::Box2& box, double spacing) -> Grid {
  Grid grid{spacing, 0, 0, 0, 0};
  if (box.empty()) return grid;
  grid.column = static_cast<std::int64_t>(std::floor(box.least.x / spacing));
  grid.row = static_cast<std::int64_t>(std::floor(box.least.y / spacing));
  grid.columns = static_cast<std::int64_t>(std::ceil(box.most.x / spacing)) - grid.column;
  grid.rows = static_cast<std::int64_t>(std::ceil(box.most.y / spacing)) - grid.row;
  return grid;
}

Cover::Cover(std::span<const geometry::Polygon> polygons) : polygons_(polygons) {
  for (const auto& polygon : polygons) boxes_.push_back(geometry::bounds(polygon.outer));
}

auto Cover::row(const Grid& grid, std::int64_t j) const -> std::vector<bool> {
  std::vector<bool> inside(static_cast<std::size_t>(grid.columns), false);
  const double y = grid.centre(0, j).y;
  std::vector<double> crossings;
  for (std::size_t p = 0; p < polygons_.size(); ++p) {
    if (boxes_[p].least.y > y || boxes_[p].most.y < y) continue;
    crossings.clear();
    geometry::each_edge(polygons_[p], [&](auto a, auto b) {
      if ((a.y <= y) != (b.y <= y)) crossings.push_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
    });
    std::ranges::sort(crossings);
    for (std::size_t c = 0; c + 1 < crossings.size(); c += 2) {
      const auto cell = [&](double x) {
        const double at = std::ceil(x / grid.spacing - 0.5) - static_cast<double>(grid.column);
        return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(grid.columns)));
      };
      for (std::size_t i = cell(crossings[c]); i < cell(crossings[c + 1]); ++i) inside[i] = true;
    }
  }
  return inside;
}

}  // namespace mansard::evaluate::detail
