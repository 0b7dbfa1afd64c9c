#include "mansard/evaluate/detail/strip.hpp"
#include "mansard/geometry/edges.hpp"

#include <algorithm>
#include <cmath>

namespace mansard::evaluate::detail {
namespace {

/// m; half of what two footprints that touch may lie apart, as where footprints are grouped into blocks.
constexpr double half_touch = 0.05;

}  // namespace

auto Strip::along_each(std::span<const geometry::Polygon> polygons, double width) -> Strip {
  Strip strip;
  strip.width_ = width;
  if (!(width > 0)) return strip;
  for (const auto& polygon : polygons)
    geometry::each_edge(polygon, [&](auto from, auto to) { strip.boundary_.push_back({from, to}); });
  return strip;
}

auto Strip::along_union(std::span<const geometry::Polygon> polygons, double width) -> base::Result<Strip> {
  std::vector<geometry::Polygon> grown;
  for (const auto& polygon : polygons) {
    const auto wider = geometry::buffer(polygon, half_touch);
    if (!wider) return wider.failure();
    grown.insert(grown.end(), wider->begin(), wider->end());
  }
  const auto united = geometry::unite(grown);
  if (!united) return united.failure();
  return along_each(*united, width > 0 ? width + half_touch : 0);
}

auto Strip::row(const Grid& grid, std::int64_t j) const -> std::vector<bool> {
  std::vector<bool> in(static_cast<std::size_t>(grid.columns), false);
  if (in.empty()) return in;
  const double y = grid.centre(0, j).y;
  for (const auto& segment : boundary_) {
    const auto [a, b] = segment;
    if (std::max(a.y, b.y) < y - width_ || std::min(a.y, b.y) > y + width_) continue;
    // Where the segment is near the row; none of it farther off matters.
    const auto x_at = [&](double at) {
      const double share = a.y == b.y ? 0 : std::clamp((at - a.y) / (b.y - a.y), 0.0, 1.0);
      return a.x + share * (b.x - a.x);
    };
    const double one = a.y == b.y ? a.x : x_at(y - width_), other = a.y == b.y ? b.x : x_at(y + width_);
    const auto column = [&](double x) {
      const double at = std::floor(x / grid.spacing) - static_cast<double>(grid.column);
      return static_cast<std::int64_t>(std::clamp(at, 0.0, static_cast<double>(grid.columns - 1)));
    };
    const auto last = column(std::max(one, other) + width_);
    for (auto i = column(std::min(one, other) - width_); i <= last; ++i)
      if (geometry::distance(segment, grid.centre(i, j)) <= width_) in[static_cast<std::size_t>(i)] = true;
  }
  return in;
}

}  // namespace mansard::evaluate::detail
