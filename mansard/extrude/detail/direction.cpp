#include "mansard/extrude/detail/direction.hpp"

#include <cmath>
#include <numbers>
#include <numeric>

namespace mansard::extrude::detail {
namespace {

constexpr std::int64_t one = std::int64_t{1} << 20;

}  // namespace

auto bearing_of(geometry::Point2 vector) -> Bearing {
  const double angle = std::atan2(vector.y, vector.x);
  const int quarters = static_cast<int>(std::lround(angle / (std::numbers::pi / 2)));
  const double rest = angle - quarters * (std::numbers::pi / 2);
  return {std::llround(std::tan(rest / 2) * static_cast<double>(one)), (quarters + 4) % 4};
}

auto direction_of(Bearing bearing) -> Direction {
  // The rational parametrisation of the circle: ((1 − t²) / (1 + t²), 2t / (1 + t²)) with t = k / 2^20.
  const std::int64_t k = bearing.k;
  Direction d{one * one - k * k, 2 * k * one, one * one + k * k};
  const std::int64_t common = std::gcd(std::gcd(d.a, d.b), d.l);
  d = {d.a / common, d.b / common, d.l / common};
  for (int quarter = 0; quarter < bearing.quarters; ++quarter) d = d.left();
  return d;
}

auto angle_less(const Direction& p, const Direction& q) -> bool {
  const auto lower_half = [](const Direction& d) { return d.b < 0 || (d.b == 0 && d.a < 0); };
  if (lower_half(p) != lower_half(q)) return lower_half(q);
  return cross(p, q) > 0;
}

}  // namespace mansard::extrude::detail
