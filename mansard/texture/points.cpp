#include "mansard/texture/points.hpp"

#include <algorithm>
#include <tuple>

namespace mansard::texture {
namespace {

using geometry::Point3;

auto along(Point3 p, int axis) -> double { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

/// A total order, up to points that are the same in everything.
auto key_of(const ScanPoint& p, int axis) {
  return std::tuple(along(p.position, axis), p.position.x, p.position.y, p.position.z, p.colour, p.ground);
}

}  // namespace

PointTree::PointTree(std::vector<ScanPoint> points) : points_(std::move(points)) { divide(0, points_.size(), 0); }

void PointTree::divide(std::size_t first, std::size_t last, int depth) {
  if (last - first < 2) return;
  const int axis = depth % 3;
  const std::size_t middle = first + (last - first) / 2;
  const auto at = [&](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(first), at(middle), at(last),
                   [&](const ScanPoint& a, const ScanPoint& b) { return key_of(a, axis) < key_of(b, axis); });
  divide(first, middle, depth + 1);
  divide(middle + 1, last, depth + 1);
}

void PointTree::search(std::size_t first, std::size_t last, int depth, Point3 p, std::size_t most,
                       std::vector<Near>& found, double& bound) const {
  if (first >= last) return;
  const std::size_t middle = first + (last - first) / 2;
  const Point3 way = points_[middle].position - p;
  if (const double squared = dot(way, way); squared <= bound) {
    const Near near{squared, static_cast<std::uint32_t>(middle)};
    if (found.size() < most || near < found.back()) {
      found.insert(std::ranges::upper_bound(found, near), near);
      if (found.size() > most) found.pop_back();
      if (found.size() == most) bound = found.back().squared;
    }
  }
  const double ahead = -along(way, depth % 3);  // how far p is beyond the plane that divides
  const auto below = [&] { search(first, middle, depth + 1, p, most, found, bound); };
  const auto above = [&] { search(middle + 1, last, depth + 1, p, most, found, bound); };
  if (ahead < 0) {
    below();
    if (ahead * ahead <= bound) above();
  } else {
    above();
    if (ahead * ahead <= bound) below();
  }
}

auto PointTree::nearest(Point3 p, std::size_t most, double within) const -> std::vector<Near> {
  std::vector<Near> found;
  if (most == 0) return found;
  found.reserve(most + 1);
  double bound = within * within;
  search(0, points_.size(), 0, p, most, found, bound);
  return found;
}

auto colour_at(const PointTree& points, Point3 p, double within) -> std::optional<std::array<std::uint8_t, 3>> {
  constexpr std::size_t few = 4;
  constexpr double close = 0.01;  // m²: no point counts for all others
  const auto near = points.nearest(p, few, within);
  if (near.empty()) return std::nullopt;
  std::array<double, 3> sum{};
  double weights = 0;
  for (const auto& one : near) {
    const double weight = 1 / (one.squared + close);
    for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * points.points()[one.point].colour[c];
    weights += weight;
  }
  std::array<std::uint8_t, 3> out{};
  for (std::size_t c = 0; c < 3; ++c) out[c] = formats::srgb_of(static_cast<std::uint16_t>(sum[c] / weights + 0.5));
  return out;
}

}  // namespace mansard::texture
