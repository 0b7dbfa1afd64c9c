// Lines and planes by least squares, from sums. Sums add and subtract, so the fit of any union or difference of sets of
// points needs no second pass over the points. Rounding: a sum of n squares of coordinates below c is exact to about
// n · c² · 2⁻⁵³, so give coordinates relative to a point nearby.
#pragma once

#include <algorithm>
#include <cmath>

#include "mansard/geometry/points.hpp"

namespace mansard::geometry {

/// z = at_zero + slope · x.
struct FittedLine {
  double at_zero = 0, slope = 0;
};

/// Weighted sums over points (x, z) for the line z(x) with the least sum of squared vertical distances.
struct LineSums {
  double weight = 0, x = 0, z = 0, xx = 0, xz = 0, zz = 0;

  void add(double px, double pz, double w = 1) {
    weight += w, x += w * px, z += w * pz;
    xx += w * px * px, xz += w * px * pz, zz += w * pz * pz;
  }
  auto operator+=(const LineSums& o) -> LineSums& {
    weight += o.weight, x += o.x, z += o.z, xx += o.xx, xz += o.xz, zz += o.zz;
    return *this;
  }
  friend auto operator-(const LineSums& a, const LineSums& b) -> LineSums {
    return {a.weight - b.weight, a.x - b.x, a.z - b.z, a.xx - b.xx, a.xz - b.xz, a.zz - b.zz};
  }

  /// Σ w (x − mean)², Σ w (x − mean)(z − mean), Σ w (z − mean)²; the weight must not be 0.
  [[nodiscard]] auto spread() const -> double { return xx - x * x / weight; }
  [[nodiscard]] auto joint() const -> double { return xz - x * z / weight; }
  [[nodiscard]] auto rise() const -> double { return zz - z * z / weight; }

  /// The line of that slope through the centre.
  [[nodiscard]] auto line(double slope) const -> FittedLine { return {z / weight - slope * x / weight, slope}; }
  /// Σ w (distance)² to the best line, and to the best level one.
  [[nodiscard]] auto residual() const -> double {
    if (!(weight > 0)) return 0;
    const double across = spread(), along = joint(), all = rise();
    return across > 0 ? std::max(0.0, all - along * along / across) : all;
  }
  [[nodiscard]] auto residual_level() const -> double { return weight > 0 ? std::max(0.0, rise()) : 0; }
};

/// The normal equations of the slopes of a plane z(x, y) through the centre from which x, y and z are measured.
struct SlopeEquations {
  double xx = 0, xy = 0, yy = 0, xz = 0, yz = 0;

  void add(double px, double py, double pz, double w) {
    xx += w * px * px, xy += w * px * py, yy += w * py * py, xz += w * px * pz, yz += w * py * pz;
  }
  /// About 0 where all points are on one line in plan; at most xx · yy.
  [[nodiscard]] auto determinant() const -> double { return xx * yy - xy * xy; }
  /// Rise per unit of x and of y; the determinant must not be 0.
  [[nodiscard]] auto slopes() const -> Point2 {
    const double det = determinant();
    return {(xz * yy - yz * xy) / det, (yz * xx - xz * xy) / det};
  }
};

/// z = at_zero + slope.x · x + slope.y · y.
struct FittedPlane {
  double at_zero = 0;
  Point2 slope;
  [[nodiscard]] auto at(double x, double y) const -> double { return at_zero + slope.x * x + slope.y * y; }
};

/// Sums over points for the plane z(x, y) with the least sum of squared vertical distances.
struct PlaneSums {
  double count = 0, x = 0, y = 0, z = 0, xx = 0, xy = 0, yy = 0, xz = 0, yz = 0;

  void add(double px, double py, double pz) {
    count += 1, x += px, y += py, z += pz;
    xx += px * px, xy += px * py, yy += py * py, xz += px * pz, yz += py * pz;
  }
  auto operator+=(const PlaneSums& o) -> PlaneSums& {
    count += o.count, x += o.x, y += o.y, z += o.z;
    xx += o.xx, xy += o.xy, yy += o.yy, xz += o.xz, yz += o.yz;
    return *this;
  }
  auto operator-=(const PlaneSums& o) -> PlaneSums& {
    count -= o.count, x -= o.x, y -= o.y, z -= o.z;
    xx -= o.xx, xy -= o.xy, yy -= o.yy, xz -= o.xz, yz -= o.yz;
    return *this;
  }

  /// About the centre; the count must not be 0.
  [[nodiscard]] auto centred() const -> SlopeEquations {
    return {xx - x * x / count, xy - x * y / count, yy - y * y / count, xz - x * z / count, yz - y * z / count};
  }
  /// The plane of those slopes through the centre.
  [[nodiscard]] auto plane(Point2 slope) const -> FittedPlane {
    return {(z - slope.x * x - slope.y * y) / count, slope};
  }
};

/// ∫1, ∫x, ∫y, ∫x², ∫xy, ∫y² over the length of segments, for the line in plan with the least ∫ squared distance.
struct AxisSums {
  double weight = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;

  void add(Point2 a, Point2 b) {
    const auto d = b - a;
    const double l = length(d), mx = 0.5 * (a.x + b.x), my = 0.5 * (a.y + b.y);
    weight += l;
    x += l * mx;
    y += l * my;
    xx += l * (mx * mx + d.x * d.x / 12);
    xy += l * (mx * my + d.x * d.y / 12);
    yy += l * (my * my + d.y * d.y / 12);
  }
  friend auto operator+(const AxisSums& a, const AxisSums& b) -> AxisSums {
    return {a.weight + b.weight, a.x + b.x, a.y + b.y, a.xx + b.xx, a.xy + b.xy, a.yy + b.yy};
  }
  friend auto operator-(const AxisSums& a, const AxisSums& b) -> AxisSums {
    return {a.weight - b.weight, a.x - b.x, a.y - b.y, a.xx - b.xx, a.xy - b.xy, a.yy - b.yy};
  }

  [[nodiscard]] auto centre() const -> Point2 { return weight > 0 ? Point2{x / weight, y / weight} : Point2{}; }

  /// ∫ squared distance to the best line, m³: it never shrinks as segments are added.
  [[nodiscard]] auto residual() const -> double {
    if (!(weight > 0)) return 0;
    const double cxx = xx - x * x / weight, cyy = yy - y * y / weight, cxy = xy - x * y / weight;
    const double difference = cxx - cyy;  // not hypot: this is the innermost loop, and metres do not overflow
    return std::max(0.0, 0.5 * (cxx + cyy - std::sqrt(difference * difference + 4 * cxy * cxy)));
  }

  /// Unit vector along the best line; its sign is free. (1, 0) where all directions are equally good.
  [[nodiscard]] auto direction() const -> Point2 {
    if (!(weight > 0)) return {1, 0};
    const double cxx = xx - x * x / weight, cyy = yy - y * y / weight, cxy = xy - x * y / weight;
    const double root = std::hypot(cxx - cyy, 2 * cxy);
    // Two forms of the eigenvector; the longer one loses no digits.
    const Point2 v = cxx >= cyy ? Point2{cxx - cyy + root, 2 * cxy} : Point2{2 * cxy, cyy - cxx + root};
    return length(v) > 0 ? normalised(v) : Point2{1, 0};
  }
};

}  // namespace mansard::geometry
