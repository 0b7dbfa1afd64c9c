// Spatially correlated noise, evaluated at any place in any order.
#pragma once

#include <cstdint>

#include "mansard/base/run.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::simulate::detail {

/// Uniform in [0, 1), by the seed and three integers alone.
[[nodiscard]] auto drawn(std::uint64_t seed, std::int64_t a, std::int64_t b = 0, std::int64_t c = 0) -> double;

/// Mean 0, variance 1, nearly normal: the sum of twelve uniform numbers, which has the same bits on every processor.
[[nodiscard]] auto near_normal(base::Random& random) -> double;
/// Numbers of their own for each of many things. Streams of base::Random follow each other along one sequence, one step
/// apart, so that sums over several numbers of neighbouring streams are not independent.
[[nodiscard]] inline auto random_of(std::uint64_t seed, std::uint64_t thing) -> base::Random {
  return base::Random(base::Random(seed, thing).next());
}

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

/// Correlation of the noise of a wavelength (metres, > 0) between two places `apart` metres from each other: 1 for the
/// zero vector, the mean over all positions of the lattices.
[[nodiscard]] auto correlation(double wavelength, geometry::Point3 apart) -> double;

}  // namespace mansard::simulate::detail
