#include "mansard/evaluate/detail/corners.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

namespace mansard::evaluate::detail {
namespace {

using geometry::Point3;
using SnapCell = std::array<std::int64_t, 3>;

auto cell_of(Point3 p) -> SnapCell {
  const auto at = [](double x) { return static_cast<std::int64_t>(std::floor(x / Corners::snap)); };
  return {at(p.x), at(p.y), at(p.z)};
}

}  // namespace

Corners::Corners(const model::ModelBuilding& building) {
  std::map<SnapCell, std::vector<std::uint32_t>> cells;
  const auto number_of = [&](Point3 p) {
    const auto at = cell_of(p);
    for (std::int64_t i = -1; i <= 1; ++i)
      for (std::int64_t j = -1; j <= 1; ++j)
        for (std::int64_t k = -1; k <= 1; ++k) {
          const auto found = cells.find({at[0] + i, at[1] + j, at[2] + k});
          if (found == cells.end()) continue;
          for (const auto n : found->second)
            if (length(points[n] - p) <= snap) return n;
        }
    const auto n = static_cast<std::uint32_t>(points.size());
    points.push_back(p);
    cells[at].push_back(n);
    return n;
  };
  for (const auto& part : building.parts)
    for (const auto& face : part.faces)
      for (const auto& loop : face.loops)
        for (const auto p : loop) of_corner.push_back(number_of(p));
  by_x_.resize(points.size());
  std::iota(by_x_.begin(), by_x_.end(), 0U);
  std::ranges::stable_sort(by_x_, {}, [&](std::uint32_t n) { return points[n].x; });
}

auto Corners::along(std::uint32_t from, std::uint32_t to) const -> std::vector<std::uint32_t> {
  std::vector<std::uint32_t> out{from};
  if (from == to) return out;
  const Point3 a = points[from], d = points[to] - a;
  const double squared = dot(d, d);
  const auto [west, east] = std::minmax(points[from].x, points[to].x);
  std::vector<std::pair<double, std::uint32_t>> between;
  auto at = std::ranges::lower_bound(by_x_, west - snap, {}, [&](std::uint32_t n) { return points[n].x; });
  for (; at != by_x_.end() && points[*at].x <= east + snap; ++at) {
    if (*at == from || *at == to) continue;
    const double t = dot(points[*at] - a, d) / squared;
    if (t > 0 && t < 1 && length(points[*at] - (a + t * d)) <= snap) between.emplace_back(t, *at);
  }
  std::ranges::sort(between);
  for (const auto& [t, n] : between) out.push_back(n);
  out.push_back(to);
  return out;
}

}  // namespace mansard::evaluate::detail
