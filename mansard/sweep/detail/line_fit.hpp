// Least-squares lines through segments, by their moments.
#pragma once

#include <algorithm>
#include <cmath>

#include "mansard/geometry/points.hpp"

namespace mansard::sweep::detail {

/// ∫1, ∫x, ∫y, ∫x², ∫xy, ∫y² over the length of segments: additive, so that the line through any union of pieces
/// is had without looking at the pieces again.
struct Moments {
  double weight = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;

  void add(geometry::Point2 a, geometry::Point2 b) {
    const auto d = b - a;
    const double l = geometry::length(d), mx = 0.5 * (a.x + b.x), my = 0.5 * (a.y + b.y);
    weight += l;
    x += l * mx;
    y += l * my;
    xx += l * (mx * mx + d.x * d.x / 12);
    xy += l * (mx * my + d.x * d.y / 12);
    yy += l * (my * my + d.y * d.y / 12);
  }
  friend auto operator+(const Moments& a, const Moments& b) -> Moments {
    return {a.weight + b.weight, a.x + b.x, a.y + b.y, a.xx + b.xx, a.xy + b.xy, a.yy + b.yy};
  }
  friend auto operator-(const Moments& a, const Moments& b) -> Moments {
    return {a.weight - b.weight, a.x - b.x, a.y - b.y, a.xx - b.xx, a.xy - b.xy, a.yy - b.yy};
  }

  [[nodiscard]] auto centre() const -> geometry::Point2 {
    return weight > 0 ? geometry::Point2{x / weight, y / weight} : geometry::Point2{};
  }

  /// ∫ squared distance to the best line, m³: it never shrinks as segments are added.
  [[nodiscard]] auto residual() const -> double {
    if (!(weight > 0)) return 0;
    const double cxx = xx - x * x / weight, cyy = yy - y * y / weight, cxy = xy - x * y / weight;
    const double difference = cxx - cyy;  // not hypot: this is the innermost loop, and metres do not overflow
    return std::max(0.0, 0.5 * (cxx + cyy - std::sqrt(difference * difference + 4 * cxy * cxy)));
  }

  /// Of the best line; its sign is free. (1, 0) when nothing is preferred.
  [[nodiscard]] auto direction() const -> geometry::Point2 {
    if (!(weight > 0)) return {1, 0};
    const double cxx = xx - x * x / weight, cyy = yy - y * y / weight, cxy = xy - x * y / weight;
    const double root = std::hypot(cxx - cyy, 2 * cxy);
    // Two forms of the eigenvector; the longer one loses no digits.
    const geometry::Point2 v =
        cxx >= cyy ? geometry::Point2{cxx - cyy + root, 2 * cxy} : geometry::Point2{2 * cxy, cyy - cxx + root};
    return length(v) > 0 ? normalised(v) : geometry::Point2{1, 0};
  }
};

}  // namespace mansard::sweep::detail
