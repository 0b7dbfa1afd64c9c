// Roofs as formulas, seen as a scan sees them: melted over decimetres, noisy, in part not at all.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "mansard/geometry/polygon.hpp"
#include "mansard/refine/detail/propose.hpp"

namespace fields {

using mansard::geometry::Point2;
using mansard::geometry::Polygon;
using mansard::geometry::Ring;
using mansard::refine::detail::Heights;

using Roof = std::function<double(Point2)>;  // height above base, m, at a place of the part before it was turned

struct Scan {
  double noise = 0.08;    // m, standard deviation
  double melt = 0.3;      // m, standard deviation of the blur
  double turn = 0;        // radians about the origin, of part and roof together
  double spacing = 0.25;  // m
  double unseen = 0;      // share of cells
  unsigned seed = 1;
};

inline auto turned(Point2 p, double by) -> Point2 {
  return {std::cos(by) * p.x - std::sin(by) * p.y, std::sin(by) * p.x + std::cos(by) * p.y};
}

inline auto turned(Polygon polygon, double by) -> Polygon {
  for (auto& p : polygon.outer) p = turned(p, by);
  for (auto& hole : polygon.holes)
    for (auto& p : hole) p = turned(p, by);
  return polygon;
}

inline auto grid_over(const Polygon& part, double spacing) -> Heights {
  const auto box = mansard::geometry::bounds(part.outer);
  Heights out;
  out.spacing = spacing;
  out.origin = {box.least.x + spacing / 2, box.least.y + spacing / 2};
  out.columns = static_cast<std::size_t>(std::ceil((box.most.x - box.least.x) / spacing));
  out.rows = static_cast<std::size_t>(std::ceil((box.most.y - box.least.y) / spacing));
  out.z.assign(out.columns * out.rows, std::numeric_limits<double>::quiet_NaN());
  return out;
}

/// The roof over the part as it was turned; blurred by a small quadrature of the Gaussian.
inline auto scanned(const Polygon& turned_part, const Roof& roof, const Scan& scan) -> Heights {
  Heights out = grid_over(turned_part, scan.spacing);
  std::mt19937 random(scan.seed);
  std::normal_distribution<double> noise(0, 1);
  std::uniform_real_distribution<double> chance(0, 1);
  constexpr int taps = 5;  // on each side, over 2.5 standard deviations
  for (std::size_t j = 0; j < out.rows; ++j)
    for (std::size_t i = 0; i < out.columns; ++i) {
      const double error = scan.noise * noise(random);
      const bool hidden = chance(random) < scan.unseen;
      const Point2 there = out.centre(i, j);
      if (!mansard::geometry::contains(turned_part, there) || hidden) continue;
      const Point2 p = turned(there, -scan.turn);
      double sum = 0, weight = 0;
      for (int b = -taps; b <= taps; ++b)
        for (int a = -taps; a <= taps; ++a) {
          if (scan.melt == 0 && (a != 0 || b != 0)) continue;
          const double u = 2.5 * a / taps, v = 2.5 * b / taps, w = std::exp(-(u * u + v * v) / 2);
          sum += w * roof({p.x + scan.melt * u, p.y + scan.melt * v});
          weight += w;
        }
      out.z[j * out.columns + i] = sum / weight + error;
    }
  return out;
}

/// A model has neither noise nor melt.
inline auto modelled(const Polygon& turned_part, const Roof& roof, const Scan& scan) -> Heights {
  return scanned(turned_part, roof, {0, 0, scan.turn, scan.spacing, 0, 1});
}

inline auto flat(double height) -> Roof {
  return [=](Point2) { return height; };
}

/// Another height in a box.
inline auto with_box(Roof roof, Point2 least, Point2 most, double height) -> Roof {
  return [=](Point2 p) { return p.x > least.x && p.x < most.x && p.y > least.y && p.y < most.y ? height : roof(p); };
}

inline auto rectangle(Point2 least, Point2 most) -> Polygon {
  return {{least, {most.x, least.y}, most, {least.x, most.y}}, {}};
}

}  // namespace fields
