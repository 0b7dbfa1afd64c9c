#include "mansard/cloud/detail/compare_strips.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "mansard/cloud/classes.hpp"

namespace mansard::cloud::detail {
namespace {

constexpr std::size_t points_of_a_strip = 3;
/// More strips over one place than a survey flies: what has the lowest numbers is compared.
constexpr std::size_t most_strips = 8;
constexpr double steepest = 0.1763;  // tan 10°
/// m, RMS about the plane: between tiles on a roof (0.05) and plants (0.4 and more).
constexpr double roughness = 0.2;

/// Whether the height of the point is that of something solid.
auto is_solid(const Point& p) -> bool {
  if (p.source == 0) return false;  // not known
  const auto use = use_of(p.classification);
  if (use == Use::terrain) return true;
  return (p.flags & only_return) != 0 && use != Use::vegetation && use != Use::wires;
}

/// Of a strip's points in a cell: sums from their mean on, in metres.
struct Share {
  std::uint16_t strip = 0;
  double points = 0;
  double x = 0, y = 0, z = 0;  ///< the mean
  double xx = 0, xy = 0, yy = 0, xz = 0, yz = 0, zz = 0;
};

auto share_of(std::span<const Point> points) -> Share {
  Share out;
  out.strip = points.front().source;
  out.points = static_cast<double>(points.size());
  const auto metres = [](std::int32_t c) { return static_cast<double>(c) / per_metre; };
  for (const auto& p : points) {
    out.x += metres(p.x) / out.points;
    out.y += metres(p.y) / out.points;
    out.z += metres(p.z) / out.points;
  }
  for (const auto& p : points) {
    const double x = metres(p.x) - out.x, y = metres(p.y) - out.y, z = metres(p.z) - out.z;
    out.xx += x * x;
    out.xy += x * y;
    out.yy += y * y;
    out.xz += x * z;
    out.yz += y * z;
    out.zz += z * z;
  }
  return out;
}

/// Solid points of a cell, strip by strip; `points` are given up.
auto shares_of(std::vector<Point>& points) -> std::vector<Share> {
  std::ranges::stable_sort(points, {}, &Point::source);
  std::vector<Share> out;
  for (std::size_t i = 0, end = 0; i < points.size() && out.size() < most_strips; i = end) {
    for (end = i + 1; end < points.size() && points[end].source == points[i].source;) ++end;
    if (end - i >= points_of_a_strip) out.push_back(share_of(std::span(points).subspan(i, end - i)));
  }
  return out;
}

/// Planes of one slope through all strips: the slope, where they are flat.
auto flat_slope(const std::vector<Share>& shares) -> std::optional<std::array<double, 2>> {
  Share sum;
  for (const auto& s : shares) {
    sum.points += s.points;
    sum.xx += s.xx;
    sum.xy += s.xy;
    sum.yy += s.yy;
    sum.xz += s.xz;
    sum.yz += s.yz;
    sum.zz += s.zz;
  }
  const double determinant = sum.xx * sum.yy - sum.xy * sum.xy;
  if (!(determinant > 1e-3 * (sum.xx + sum.yy) * (sum.xx + sum.yy))) return std::nullopt;  // on one line
  const double b = (sum.xz * sum.yy - sum.yz * sum.xy) / determinant,
               c = (sum.yz * sum.xx - sum.xz * sum.xy) / determinant;
  const double squares = std::max(0.0, sum.zz - b * sum.xz - c * sum.yz);
  if (std::hypot(b, c) > steepest || squares > roughness * roughness * sum.points) return std::nullopt;
  return std::array{b, c};
}

void compare_in_cell(std::span<const Point> all, StripOverlaps& out) {
  const auto solid = [](const Point& p) { return is_solid(p); };
  const auto first = std::ranges::find_if(all, solid);
  // Most cells have one strip.
  if (std::ranges::none_of(first, all.end(), [&](const Point& p) { return p.source != first->source && solid(p); }))
    return;
  std::vector<Point> points;
  std::ranges::copy_if(all, std::back_inserter(points), solid);
  // From the first point on, which is the same whatever the tile: so are all sums.
  const auto [x, y] = std::pair(points.front().x, points.front().y);
  for (auto& p : points) {
    p.x -= x;
    p.y -= y;
  }
  const auto shares = shares_of(points);
  if (shares.size() < 2) return;
  const auto slope = flat_slope(shares);
  if (!slope) return;
  const auto height = [&](const Share& s) { return s.z - (*slope)[0] * s.x - (*slope)[1] * s.y; };
  for (std::size_t i = 0; i < shares.size(); ++i)
    for (std::size_t k = i + 1; k < shares.size(); ++k)
      out.add({shares[i].strip, shares[k].strip}, height(shares[k]) - height(shares[i]));
}

}  // namespace

auto compare_strips(const Metres& metres) -> StripOverlaps {
  StripOverlaps out;
  for (std::int64_t row = 0; row < metres.side(); ++row)
    for (std::int64_t column = 0; column < metres.side(); ++column) compare_in_cell(metres.points_of(column, row), out);
  return out;
}

}  // namespace mansard::cloud::detail
