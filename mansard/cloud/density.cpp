#include "mansard/cloud/density.hpp"

#include <algorithm>
#include <cmath>

namespace mansard::cloud {

Density::Density(std::vector<GroundTile> tiles) : tiles_(std::move(tiles)) {
  std::erase_if(tiles_, [](const GroundTile& tile) { return tile.points.empty(); });
  for (std::size_t i = 0; i < tiles_.size(); ++i) by_place_[{tiles_[i].x, tiles_[i].y}] = i;
  if (!tiles_.empty()) side_ = static_cast<std::int64_t>(tiles_.front().columns);
}

auto Density::at(std::int64_t x, std::int64_t y) const -> double {
  const auto corner = [&](std::int64_t c) { return (c / side_ - (c % side_ < 0 ? 1 : 0)) * side_; };
  const auto found = by_place_.find({corner(x), corner(y)});
  if (found == by_place_.end()) return 0;
  const auto& tile = tiles_[found->second];
  return static_cast<double>(
      tile.points[static_cast<std::size_t>(y - tile.y) * tile.columns + static_cast<std::size_t>(x - tile.x)]);
}

auto Density::over(std::span<const geometry::Polygon> polygons, geometry::Point2 origin) const
    -> std::optional<double> {
  constexpr double fine = 0.25, most_places = 250'000;  // m: sixteen places in a cell
  geometry::Box2 box;
  for (const auto& polygon : polygons) box.include(geometry::bounds(polygon.outer));
  if (box.empty()) return std::nullopt;
  const geometry::Point2 extent = box.most - box.least;
  const double step = std::max(fine, std::sqrt(extent.x * extent.y / most_places));
  // From the corner of a cell on: the same places wherever the origin is, by whole metres.
  const double x0 = std::floor(box.least.x + origin.x), y0 = std::floor(box.least.y + origin.y);
  double sum = 0;
  std::size_t places = 0;
  for (double j = 0.5; y0 - origin.y + j * step <= box.most.y; ++j)
    for (double i = 0.5; x0 - origin.x + i * step <= box.most.x; ++i) {
      const double x = x0 + i * step, y = y0 + j * step;
      const geometry::Point2 p{x - origin.x, y - origin.y};
      if (!geometry::contains(polygons, p)) continue;
      ++places;
      sum += at(static_cast<std::int64_t>(std::floor(x)), static_cast<std::int64_t>(std::floor(y)));
    }
  if (places == 0) return std::nullopt;
  return sum / static_cast<double>(places);
}

}  // namespace mansard::cloud
