#include "mansard/extrude/detail/direction.hpp"

#include <bit>
#include <cmath>

namespace mansard::extrude::detail {
namespace {

/// The table's steps are 2 / 2^20 rad: an edge of 100 m moves by 0.1 mm at its ends at most. k is at most
/// tan(22.5°) · 2^20, so that l = q² + p² ≤ 1.18 · 2^40.
constexpr std::int64_t one = std::int64_t{1} << 20;

}  // namespace

auto bearing_of(geometry::Point2 vector) -> Bearing {
  // Quarter turns by comparison, not by an angle: the four turned vectors then meet the same numbers.
  double u = vector.x, v = vector.y;
  int quarters = 0;
  while (!(u > 0 && -u < v && v <= u) && quarters < 4) {
    const double turned = -u;
    u = v;
    v = turned;
    ++quarters;
  }
  if (quarters == 4) return {};  // no vector at all
  return {std::llround(v / (u + std::sqrt(u * u + v * v)) * static_cast<double>(one)), quarters};
}

auto direction_of(Bearing bearing) -> Direction {
  // The rational parametrisation of the circle: ((1 − t²) / (1 + t²), 2t / (1 + t²)) with t = k / 2^20 in lowest terms.
  Direction d{1, 0, 1};
  if (bearing.k != 0) {
    const int twos = std::countr_zero(static_cast<std::uint64_t>(bearing.k));
    const std::int64_t p = bearing.k >> twos, q = one >> twos;
    d = {q * q - p * p, 2 * p * q, q * q + p * p};
  }
  for (int quarter = 0; quarter < bearing.quarters; ++quarter) d = d.left();
  return d;
}

auto angle_less(const Direction& p, const Direction& q) -> bool {
  const auto lower_half = [](const Direction& d) { return d.b < 0 || (d.b == 0 && d.a < 0); };
  if (lower_half(p) != lower_half(q)) return lower_half(q);
  return cross(p, q) > 0;
}

}  // namespace mansard::extrude::detail
