#include "mansard/vegetation/law.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mansard::vegetation {

auto decided_by(Options o, const model::Accuracy& scan) -> Options {
  // Times what noise leaves off a plane over the square, or the grown plane: a roof is hardly ever rougher. At least
  // what simulated crowns of odd seeds ask for (docs/decisions/0062): crowns are rough whatever the scan.
  constexpr double rougher = 1.2, off = 1.8;
  const double square = o.window / std::numbers::sqrt3;  // the disc whose moments of inertia are the square's
  o.roughness = std::max(o.roughness, rougher * scan.off_plane(square));
  o.even = std::max(o.even, off * scan.off_plane(square / 2));
  o.plane_distance = std::max(o.plane_distance, off * scan.off_plane(std::sqrt(o.plane_area / std::numbers::pi)));
  return o;
}

}  // namespace mansard::vegetation
