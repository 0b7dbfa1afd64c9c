#include "mansard/geometry/extent.hpp"

#include <algorithm>
#include <limits>

namespace mansard::geometry {
namespace {

auto convex_hull(std::vector<Point2> points) -> std::vector<Point2> {
  std::ranges::sort(points);
  points.erase(std::ranges::unique(points).begin(), points.end());
  if (points.size() < 3) return points;
  std::vector<Point2> hull;
  const auto add_chain = [&](auto first, auto last) {
    const auto base = hull.size();
    for (auto p = first; p != last; ++p) {
      while (hull.size() >= base + 2 && cross(hull.back() - hull[hull.size() - 2], *p - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(*p);
    }
    hull.pop_back();
  };
  add_chain(points.begin(), points.end());
  add_chain(points.rbegin(), points.rend());
  return hull;
}

}  // namespace

auto extent_of(std::vector<Point2> points) -> Extent {
  const auto hull = convex_hull(std::move(points));
  if (hull.size() < 3) return {};
  // A side of the smallest rectangle lies on the hull. Those on the three sides of a triangle have one area, and so
  // have some of symmetric shapes: rounding must not choose among them.
  constexpr double as_small = 1 + 1e-6;
  std::vector<Extent> all;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Point2 along = normalised(hull[(i + 1) % hull.size()] - hull[i]), across = left_of(along);
    double from = 0, to = 0, deep = 0;
    for (const auto p : hull) {
      const double a = dot(along, p - hull[i]);
      from = std::min(from, a), to = std::max(to, a), deep = std::max(deep, dot(across, p - hull[i]));
    }
    const Point2 first = hull[i] + from * along, last = hull[i] + to * along, up = deep * across;
    all.push_back({std::min(to - from, deep), std::max(to - from, deep), {first, last, last + up, first + up}});
    least = std::min(least, (to - from) * deep);
  }
  Extent out{.width = std::numeric_limits<double>::infinity()};
  for (const auto& one : all)
    if (one.width * one.length <= as_small * least && one.width < out.width) out = one;
  return out;
}

}  // namespace mansard::geometry
