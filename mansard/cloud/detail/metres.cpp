#include "mansard/cloud/detail/metres.hpp"

#include <algorithm>
#include <tuple>

namespace mansard::cloud::detail {
namespace {

auto is_before(const Point& a, const Point& b) -> bool {
  return std::tie(a.x, a.y, a.z, a.classification, a.flags, a.source) <
         std::tie(b.x, b.y, b.z, b.classification, b.flags, b.source);
}

auto is_one_measurement(const Point& a, const Point& b) -> bool {
  return a.x == b.x && a.y == b.y && a.z == b.z && a.classification == b.classification && a.flags == b.flags;
}

/// In metres, of a length that may end within one.
auto metres_of(std::int64_t length) -> std::int64_t { return (length + per_metre - 1) / per_metre; }

}  // namespace

Metres::Metres(std::vector<Point> points, std::int64_t cell)
    : border_(cell * halo),
      around_(metres_of(border_)),
      side_(metres_of(cell * tile_cells)),
      columns_(side_ + 2 * around_),
      starts_(static_cast<std::size_t>(columns_ * columns_) + 1, 0) {
  for (const auto& p : points) ++starts_[cell_of(p)];
  std::uint32_t sum = 0;
  for (auto& start : starts_) start = sum += start;
  points_.resize(points.size());
  for (const auto& p : points) points_[--starts_[cell_of(p)]] = p;
  remove_repeated();
}

auto Metres::cell_of(const Point& p) const -> std::size_t {
  const auto along = [&](std::int64_t c) { return (c - border_ + around_ * per_metre) / per_metre; };
  return static_cast<std::size_t>(along(p.y) * columns_ + along(p.x));
}

auto Metres::is_own(const Point& p) const -> bool {
  const auto in = [&](std::int64_t c) { return c >= border_ && c < border_ + side_ * per_metre; };
  return in(p.x) && in(p.y);
}

void Metres::remove_repeated() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i + 1 < starts_.size(); ++i) {
    const std::size_t first = starts_[i], end = starts_[i + 1];
    starts_[i] = static_cast<std::uint32_t>(kept);
    std::sort(points_.begin() + static_cast<std::ptrdiff_t>(first), points_.begin() + static_cast<std::ptrdiff_t>(end),
              is_before);
    for (std::size_t k = first; k < end; ++k) {
      if (k > first && is_one_measurement(points_[kept - 1], points_[k])) repeated_ += is_own(points_[k]) ? 1 : 0;
      else points_[kept++] = points_[k];
    }
  }
  starts_.back() = static_cast<std::uint32_t>(kept);
  points_.resize(kept);
}

}  // namespace mansard::cloud::detail
