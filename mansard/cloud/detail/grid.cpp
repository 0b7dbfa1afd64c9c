#include "mansard/cloud/detail/grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "mansard/cloud/classes.hpp"

namespace mansard::cloud::detail {
namespace {

/// Whether a surface is made of it. In a classified cloud what is unclassified are trees, cars and masts (AHN, for
/// one); elsewhere it is everything.
auto is_surface(const Point& p, Buildings buildings) -> bool {
  switch (use_of(p.classification)) {
    case Use::terrain:
    case Use::buildings:
    case Use::surface: return true;
    case Use::wires: return false;
    case Use::vegetation: return buildings == Buildings::top;
    case Use::outliers:
    case Use::undecided: break;
  }
  return buildings == Buildings::top ||
         (buildings == Buildings::by_shape && (p.flags & (only_return | last_return)) != 0);
}

}  // namespace

Grid::Grid(std::vector<Point> points, std::int64_t cell, Buildings buildings)
    : cell_(cell), buildings_(buildings), starts_(window * window + 1, 0), heights_(window * window) {
  const auto cell_of = [&](const Point& p) { return index(p.x / cell_, p.y / cell_); };
  std::erase_if(points, [&](const Point& p) { return !is_surface(p, buildings); });
  for (const auto& p : points) ++starts_[cell_of(p)];
  std::uint32_t sum = 0;
  for (auto& start : starts_) start = sum += start;
  points_.resize(points.size());
  for (const auto& p : points) points_[--starts_[cell_of(p)]] = p;
  for (std::size_t i = 0; i + 1 < starts_.size(); ++i)
    std::sort(points_.begin() + starts_[i], points_.begin() + starts_[i + 1], [](const Point& a, const Point& b) {
      return std::tie(b.z, a.x, a.y, a.classification, a.flags) < std::tie(a.z, b.x, b.y, b.classification, b.flags);
    });
}

/// Among the layers below `top`; with `highest`, the highest of them.
auto Grid::layer_below(std::size_t cell, std::int64_t top, std::int64_t step, bool highest) const -> Height {
  const auto all = std::span(points_).subspan(starts_[cell], starts_[cell + 1] - starts_[cell]);
  std::span<const Point> best;
  for (std::size_t i = 0, end = 0; i < all.size(); i = end) {
    for (end = i + 1; end < all.size() && all[end - 1].z - all[end].z <= step;) ++end;
    if (all[i].z >= top) continue;
    const auto layer = all.subspan(i, end - i);
    const auto of_building = std::ranges::count(layer, std::uint8_t{building}, &Point::classification);
    // A roof's edge has fewer points in a cell than the ground below it.
    if (highest || (buildings_ == Buildings::by_class && 2 * static_cast<std::size_t>(of_building) > layer.size())) {
      best = layer;
      break;
    }
    if (layer.size() > best.size()) best = layer;
  }
  // Of a wall in view, points go down without a gap: its top is what is seen from above.
  std::size_t used = 0;
  while (used < best.size() && best.front().z - best[used].z <= step) ++used;
  best = best.first(used);
  Height out;
  if (best.empty()) return out;
  std::int64_t x = 0, y = 0, z = 0;
  std::size_t buildings = 0;
  for (const auto& p : best) {
    x += p.x;
    y += p.y;
    z += p.z;
    buildings += p.classification == building ? 1 : 0;
  }
  // Rounded as an integer, the mean is at the same place in every window.
  const auto n = static_cast<std::int64_t>(best.size());
  const auto mean = [n](std::int64_t sum) {
    const std::int64_t doubled = 2 * sum + n;
    const std::int64_t floor = doubled / (2 * n) - (doubled % (2 * n) < 0 ? 1 : 0);
    return static_cast<double>(floor) / per_metre;
  };
  out.points = static_cast<std::uint32_t>(best.size());
  out.x = mean(x);
  out.y = mean(y);
  out.z = mean(z);
  out.least = best.back().z;
  out.building = 2 * buildings > best.size();
  return out;
}

void Grid::choose(double step) {
  const auto units = static_cast<std::int64_t>(step * per_metre);
  constexpr std::int64_t everything = std::numeric_limits<std::int64_t>::max();
  for (std::size_t i = 0; i < heights_.size(); ++i)
    heights_[i] = layer_below(i, everything, units, buildings_ == Buildings::top);
}

void Grid::lower(std::int64_t column, std::int64_t row, double step) {
  auto& height = at(column, row);
  height = layer_below(index(column, row), height.least, static_cast<std::int64_t>(step * per_metre), true);
}

}  // namespace mansard::cloud::detail
