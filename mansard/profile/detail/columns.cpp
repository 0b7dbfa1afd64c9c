#include "mansard/profile/detail/columns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mansard/base/statistics.hpp"
#include "mansard/geometry/fit.hpp"

namespace mansard::profile::detail {
namespace {

constexpr double hole = std::numeric_limits<double>::quiet_NaN();

auto middle(std::size_t column, const Options& o) -> double {
  return (static_cast<double>(column) + 0.5) * o.column_width;
}

/// Slopes of the plane through the columns [from, from + rising_tile) of neighbouring slices, by least squares.
struct Slope {
  double inward = 0, along = 0;
};
auto slope_of(std::span<const SliceColumns> slices, std::size_t begin, std::size_t end, std::size_t from,
              const Options& o) -> std::optional<Slope> {
  geometry::PlaneSums sums;  // heights over inward and along
  const double u0 = middle(from, o), t0 = slices[begin].along;
  std::size_t present = 0, possible = 0;
  for (std::size_t s = begin; s < end; ++s) {
    for (std::size_t b = from; b < from + o.rising_tile; ++b) {
      ++possible;
      if (b >= slices[s].heights.size() || std::isnan(slices[s].heights[b])) continue;
      ++present;
      sums.add(middle(b, o) - u0, slices[s].along - t0, slices[s].heights[b]);
    }
  }
  if (present < 3 || 2 * present < possible) return std::nullopt;
  const auto equations = sums.centred();
  if (equations.xx <= 0) return std::nullopt;
  // A single slice, or as good as one, says nothing about the slope along the run.
  if (equations.yy < 1e-6 * equations.xx || equations.determinant() < 1e-9)
    return Slope{equations.xz / equations.xx, 0};
  const auto slope = equations.slopes();
  return Slope{slope.x, slope.y};
}

}  // namespace

auto columns_of(std::span<const Piece> pieces, const Sample& sample, double base, std::optional<double> wall,
                const Options& o) -> SliceColumns {
  SliceColumns columns{sample.along, {}, wall, 0, 0};
  columns.heights.assign(static_cast<std::size_t>(std::max(0.0, sample.reach) / o.column_width), hole);
  for (const Piece& piece : pieces) {
    const double u0 = std::min(piece.low.inward, piece.high.inward), u1 = std::max(piece.low.inward, piece.high.inward);
    if (u1 <= 0 || u1 == u0) continue;
    const double slope = (piece.high.height - piece.low.height) / (piece.high.inward - piece.low.inward);
    auto b = static_cast<std::size_t>(std::max(0.0, std::ceil(u0 / o.column_width - 0.5)));
    for (; b < columns.heights.size() && middle(b, o) <= u1; ++b) {
      const double height = piece.low.height + slope * (middle(b, o) - piece.low.inward);
      if (!(height - base <= columns.heights[b])) columns.heights[b] = height - base;
    }
  }
  return columns;
}

void find_rising(std::vector<SliceColumns>& slices, const Options& o) {
  for (std::size_t s = 0; s < slices.size(); ++s) {
    SliceColumns& slice = slices[s];
    slice.first = slice.last = 0;
    std::size_t begin = s, end = s + 1;
    while (begin > 0 && (slice.along - slices[begin - 1].along <= o.rising_beside || begin == s)) --begin;
    while (end < slices.size() && (slices[end].along - slice.along <= o.rising_beside || end == s + 1)) ++end;

    const double start = o.corner + std::clamp(slice.wall.value_or(0.0), 0.0, o.wall_deepest);
    bool found = false;
    std::size_t misses = 0;
    auto b = static_cast<std::size_t>(std::ceil(start / o.column_width - 0.5));
    for (; b + o.rising_tile <= slice.heights.size(); b += o.rising_tile_step) {
      const auto slope = slope_of(slices, begin, end, b, o);
      const bool rises =
          slope && slope->inward >= o.rising_slope && std::abs(slope->along) <= o.rising_oblique * slope->inward;
      if (rises) {
        if (!found) slice.first = b;
        found = true;
        misses = 0;
        slice.last = b + o.rising_tile;
      } else if (found ? ++misses > o.rising_misses
                       : middle(b, o) > start + o.rising_start) {  // over a skylight or chimney, not farther
        break;
      }
    }
    if (!found) continue;
    // The last tile may lean over the ridge.
    std::size_t top = slice.first;
    for (std::size_t c = slice.first; c < slice.last; ++c)
      if (!std::isnan(slice.heights[c]) && !(slice.heights[c] < slice.heights[top])) top = c;
    slice.last = top + 1;
    const auto rounded = static_cast<std::size_t>(std::lround(o.corner / o.column_width));
    if (static_cast<double>(slice.last - slice.first) * o.column_width > 2 * o.rising_shortest) slice.last -= rounded;
    if (static_cast<double>(slice.last - slice.first) * o.column_width < o.rising_shortest)
      slice.first = slice.last = 0;
  }
}

auto pool(std::span<const SliceColumns> slices, const Options& o) -> std::vector<Pooled> {
  std::size_t rising = 0, deepest = 0;
  for (const auto& slice : slices) {
    rising += slice.first < slice.last ? 1 : 0;
    deepest = std::max(deepest, slice.last);
  }
  // A hip's triangle thins out towards its tip; what too few of the slices reach is not trusted.
  const auto enough = static_cast<std::size_t>(std::max(1.0, std::ceil(o.pool_share * static_cast<double>(rising))));
  std::vector<Pooled> pooled;
  for (std::size_t b = 0; b < deepest; ++b) {
    std::vector<double> heights;
    for (const auto& slice : slices)
      if (slice.first <= b && b < slice.last && !std::isnan(slice.heights[b])) heights.push_back(slice.heights[b]);
    if (heights.size() < enough) continue;
    const auto weight = static_cast<double>(heights.size());
    pooled.push_back({middle(b, o), base::median(std::move(heights)), weight});
  }
  return pooled;
}

auto edge_height(std::span<const SliceColumns> slices, const Options& o) -> std::optional<double> {
  std::vector<double> heights;
  for (const auto& slice : slices) {
    const double start = o.corner + std::clamp(slice.wall.value_or(0.0), 0.0, o.wall_deepest);
    const auto from = static_cast<std::size_t>(std::ceil(start / o.column_width - 0.5));
    std::vector<double> near;
    for (std::size_t b = std::min(from, slice.heights.size()); b < std::min(from + o.rising_tile, slice.heights.size());
         ++b)
      if (!std::isnan(slice.heights[b])) near.push_back(slice.heights[b]);
    if (!near.empty()) heights.push_back(base::median(std::move(near)));
  }
  if (heights.empty()) return std::nullopt;
  return base::median(std::move(heights));
}

auto find_setback(std::span<const SliceColumns> slices, const Options& o) -> std::optional<Setback> {
  std::size_t deepest = 0;
  for (const auto& slice : slices) deepest = std::max(deepest, slice.heights.size());
  std::vector<double> middles;  // median column by column, of all slices
  for (std::size_t b = 0; b < deepest; ++b) {
    std::vector<double> heights;
    for (const auto& slice : slices)
      if (b < slice.heights.size() && !std::isnan(slice.heights[b])) heights.push_back(slice.heights[b]);
    if (2 * heights.size() < slices.size()) break;
    middles.push_back(base::median(std::move(heights)));
  }
  // The first step up, where it is steepest. Before it are one level column at least and those that the scan smears.
  const std::size_t depth = std::max(o.setback_depth, o.setback_blur + 1);
  std::size_t wall = 0;
  double highest = o.setback_step;
  for (std::size_t b = depth; b + o.setback_blur < middles.size(); ++b) {
    const double step = middles[b + o.setback_blur - 1] - middles[b - o.setback_blur];
    if (step > highest) {
      highest = step;
      wall = b;
    } else if (wall > 0 && b > wall + 2 * o.setback_blur) {
      break;
    }
  }
  if (wall == 0) return std::nullopt;
  const double halfway = (middles[wall - o.setback_blur] + middles[wall + o.setback_blur - 1]) / 2;
  wall -= o.setback_blur;
  while (middles[wall] < halfway) ++wall;
  if (wall < depth) return std::nullopt;
  const auto begin = middles.begin() + 1,
             end = middles.begin() + static_cast<std::ptrdiff_t>(wall - o.setback_blur) + 1;
  const auto [low, high] = std::minmax_element(begin, end);
  if (*high - *low > o.setback_level) return std::nullopt;
  const Setback setback{static_cast<double>(wall) * o.column_width, base::median(std::vector<double>(begin, end))};
  if (setback.height < o.minimum_height) return std::nullopt;  // a yard

  std::size_t agreeing = 0;
  for (const auto& slice : slices) {
    if (wall + o.setback_blur >= slice.heights.size()) continue;
    const double front = slice.heights[wall - o.setback_blur], back = slice.heights[wall + o.setback_blur];
    agreeing += std::abs(front - setback.height) < o.setback_level && back - front > o.setback_step / 2 ? 1 : 0;
  }
  if (2 * agreeing < slices.size()) return std::nullopt;
  return setback;
}

auto behind(std::span<const SliceColumns> slices, const Setback& setback, const Options& o)
    -> std::vector<SliceColumns> {
  const auto skip = static_cast<std::size_t>(std::lround(setback.depth / o.column_width));
  std::vector<SliceColumns> out(slices.begin(), slices.end());
  for (auto& slice : out) {
    const auto count = std::min(skip, slice.heights.size());
    slice.heights.erase(slice.heights.begin(), slice.heights.begin() + static_cast<std::ptrdiff_t>(count));
    slice.wall.reset();
    slice.first = slice.last = 0;
  }
  return out;
}

}  // namespace mansard::profile::detail
