#include "mansard/crs/utm.hpp"

#include <algorithm>
#include <cmath>

namespace mansard::crs {

auto utm_zone(double longitude, double latitude, int geographic) -> int {
  if (!(latitude >= -80 && latitude <= 84)) return 0;
  const double turned = longitude - 360 * std::floor((longitude + 180) / 360);
  int zone = std::clamp(static_cast<int>(std::floor((turned + 180) / 6)) + 1, 1, 60);
  // The west coast of Norway, and Svalbard.
  if (latitude >= 56 && latitude < 64 && turned >= 3 && turned < 12) zone = 32;
  if (latitude >= 72 && turned >= 0 && turned < 42) zone = turned < 9 ? 31 : turned < 21 ? 33 : turned < 33 ? 35 : 37;
  constexpr int etrs89 = 4258, nad83 = 4269;
  if (geographic == etrs89 && latitude >= 0 && zone >= 28 && zone <= 38) return 25800 + zone;
  if (geographic == nad83 && latitude >= 0 && zone <= 23) return 26900 + zone;
  return (latitude >= 0 ? 32600 : 32700) + zone;
}

}  // namespace mansard::crs
