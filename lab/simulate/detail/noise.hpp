// Spatially correlated noise, evaluated at any place in any order.
#pragma once

#include <cstdint>

#include "mansard/geometry/points.hpp"

namespace mansard::simulate::detail {

/// Uniform in [0, 1), by the seed and three integers alone.
[[nodiscard]] auto drawn(std::uint64_t seed, std::int64_t a, std::int64_t b = 0, std::int64_t c = 0) -> double;

/// Smooth noise of mean 0 and root mean square 1 over space: random values on two turned lattices, of half and a
/// quarter of the wavelength, smoothly interpolated.
class Noise {
 public:
  /// `wavelength` in metres, > 0.
  Noise(std::uint64_t seed, double wavelength) : seed_(seed), step_(wavelength / 2) {}
  [[nodiscard]] auto at(geometry::Point3 p) const -> double;

 private:
  std::uint64_t seed_;
  double step_;
};

}  // namespace mansard::simulate::detail
