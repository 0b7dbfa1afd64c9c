#include "lab/simulate/detail/noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>

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

/// Weights of the two lattices; their squares add up to 1.
constexpr double coarse = 0.9, fine = 0.4359;

/// The share of a lattice value at `t` from its point, in lattice units: one minus the quintic.
auto kernel(double t) -> double {
  const double u = std::abs(t);
  return u < 1 ? 1 - u * u * u * (u * (6 * u - 15) + 10) : 0;
}

/// ∫ kernel(t) kernel(t + lag) dt. The kernel is a quintic on either side of 0, so that six Gauss points integrate each
/// piece between the ends and the two middles exactly.
auto overlap(double lag) -> double {
  const double far = std::abs(lag);
  if (far >= 2) return 0;
  constexpr std::array at{0.2386191860831969, 0.6612093864662645, 0.9324695142031521};
  constexpr std::array weight{0.4679139345726910, 0.3607615730481386, 0.1713244923791704};
  std::array<double, 4> ends{far - 1, 0, far, 1};
  std::ranges::sort(ends);
  double sum = 0;
  for (std::size_t piece = 0; piece + 1 < ends.size(); ++piece) {
    const double from = std::max(ends[piece], far - 1), to = std::min(ends[piece + 1], 1.0);
    if (from >= to) continue;
    const double middle = (from + to) / 2, half = (to - from) / 2;
    for (std::size_t k = 0; k < at.size(); ++k)
      for (const double t : {middle - half * at[k], middle + half * at[k]})
        sum += weight[k] * half * kernel(t) * kernel(t - far);
  }
  return sum;
}

/// Correlation of the values of one lattice, `apart` in lattice units.
auto lattice_correlation(Point3 apart) -> double {
  constexpr double whole = 181.0 / 231;  // overlap(0)
  return overlap(apart.x) * overlap(apart.y) * overlap(apart.z) / (whole * whole * whole);
}

}  // namespace

auto near_normal(base::Random& random) -> double {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += random.uniform();
  return sum;
}

auto drawn(std::uint64_t seed, std::int64_t a, std::int64_t b, std::int64_t c) -> double {
  std::uint64_t key = seed;
  for (const auto part : {a, b, c}) key = base::Random(key, static_cast<std::uint64_t>(part)).next();
  return static_cast<double>(key >> 11) * 0x1.0p-53;
}

auto Noise::at(Point3 p) const -> double {
  // The mean square of the interpolated values is 1/3 (181/231)³: 1/3 at a point of the lattice, and ∫ s² + (1 − s)² of
  // the quintic in each direction.
  constexpr double unit = 2.4972;
  const Point3 q = (1 / step_) * turned(p);
  return unit * (coarse * lattice(seed_, q) + fine * lattice(seed_ + 1, 2.0 * turned(q)));
}

auto correlation(double wavelength, Point3 apart) -> double {
  const Point3 q = (2 / wavelength) * turned(apart);
  return coarse * coarse * lattice_correlation(q) + fine * fine * lattice_correlation(2.0 * turned(q));
}

}  // namespace mansard::simulate::detail
