#include "lab/simulate/detail/noise.hpp"

#include <array>
#include <cmath>

#include "mansard/base/run.hpp"

namespace mansard::simulate::detail {
namespace {

using geometry::Point3;

/// Value noise on the unit lattice: uniform in [−1, 1] at its points, quintic in between.
auto lattice(std::uint64_t seed, Point3 p) -> double {
  const std::array<double, 3> at{p.x, p.y, p.z};
  std::array<std::int64_t, 3> cell{};
  std::array<double, 3> s{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double floor = std::floor(at[i]), t = at[i] - floor;
    cell[i] = static_cast<std::int64_t>(floor);
    s[i] = t * t * t * (t * (6 * t - 15) + 10);
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::array<std::int64_t, 3> of = cell;
    for (std::size_t i = 0; i < 3; ++i) {
      const bool high = (corner >> i & 1) != 0;
      weight *= high ? s[i] : 1 - s[i];
      of[i] += high ? 1 : 0;
    }
    sum += weight * (2 * drawn(seed, of[0], of[1], of[2]) - 1);
  }
  return sum;
}

/// Turned, so that the lattice lies along nothing that is built.
auto turned(Point3 p) -> Point3 {
  const Point3 q{0.8 * p.x - 0.6 * p.y, 0.6 * p.x + 0.8 * p.y, p.z};
  return {q.x, 0.8 * q.y - 0.6 * q.z, 0.6 * q.y + 0.8 * q.z};
}

}  // namespace

auto drawn(std::uint64_t seed, std::int64_t a, std::int64_t b, std::int64_t c) -> double {
  std::uint64_t key = seed;
  for (const auto part : {a, b, c}) key = base::Random(key, static_cast<std::uint64_t>(part)).next();
  return static_cast<double>(key >> 11) * 0x1.0p-53;
}

auto Noise::at(Point3 p) const -> double {
  // The mean square of the interpolated values is 1/3 (181/231)³: 1/3 at a point of the lattice, and ∫ s² + (1 − s)² of
  // the quintic in each direction.
  constexpr double unit = 2.4972, coarse = 0.9, fine = 0.4359;  // coarse² + fine² = 1
  const Point3 q = (1 / step_) * turned(p);
  return unit * (coarse * lattice(seed_, q) + fine * lattice(seed_ + 1, 2.0 * turned(q)));
}

}  // namespace mansard::simulate::detail
