// The numbers of the kernel: exact rationals for decisions, intervals to know which decisions are open.
#pragma once

#include <gmpxx.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

namespace mansard::extrude::detail {

using Rational = mpq_class;
__extension__ typedef __int128 Int128;
__extension__ typedef unsigned __int128 UInt128;

/// An invariant of the sweep does not hold. Caught at the door, which then goes down the ladder.
struct Broken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Offsets and heights are multiples of 2^-16 m (15 µm), so that rationals stay small.
inline constexpr double quantum = 0x1.0p-16;

[[nodiscard]] inline auto quantised(double metres) -> Rational {
  return Rational(mpz_class(std::nearbyint(metres / quantum)), 65536);
}
/// The same in lowest terms.
[[nodiscard]] inline auto on_grid(double metres) -> Rational {
  Rational value = quantised(metres);
  value.canonicalize();
  return value;
}

[[nodiscard]] inline auto sign(Int128 value) -> int { return (value > 0) - (value < 0); }

[[nodiscard]] inline auto to_integer(Int128 value) -> mpz_class {
  const bool negative = value < 0;
  const auto magnitude = negative ? -static_cast<UInt128>(value) : static_cast<UInt128>(value);
  mpz_class result(static_cast<unsigned long>(magnitude >> 64));
  result <<= 64;
  result += static_cast<unsigned long>(magnitude);
  return negative ? mpz_class(-result) : result;
}

/// A closed interval of doubles that surely holds the exact value: every operation rounds outward by one step more than
/// IEEE needs (relative 2^-52, plus the least normal number for results near zero).
struct Interval {
  double lo = 0, hi = 0;

  Interval() = default;
  Interval(double value) : lo(value), hi(value) {}  // NOLINT: doubles are exact intervals
  Interval(double least, double most) : lo(least), hi(most) {}
  /// Conversion from a rational truncates towards zero: within one unit in the last place.
  explicit Interval(const Rational& value) {
    const double d = value.get_d();
    *this = outward(d, d);
  }

  [[nodiscard]] static auto outward(double lo, double hi) -> Interval {
    constexpr double relative = 0x1.0p-52, absolute = std::numeric_limits<double>::min();
    return {lo - std::abs(lo) * relative - absolute, hi + std::abs(hi) * relative + absolute};
  }
  [[nodiscard]] static auto everything() -> Interval {
    return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  }

  friend auto operator+(Interval a, Interval b) -> Interval { return outward(a.lo + b.lo, a.hi + b.hi); }
  friend auto operator-(Interval a, Interval b) -> Interval { return outward(a.lo - b.hi, a.hi - b.lo); }
  friend auto operator*(Interval a, Interval b) -> Interval {
    const double p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
    if (std::isnan(p + q + r + s)) return everything();
    return outward(std::fmin(std::fmin(p, q), std::fmin(r, s)), std::fmax(std::fmax(p, q), std::fmax(r, s)));
  }
  friend auto operator/(Interval a, Interval b) -> Interval {
    if (b.lo <= 0 && b.hi >= 0) return everything();
    const double p = a.lo / b.lo, q = a.lo / b.hi, r = a.hi / b.lo, s = a.hi / b.hi;
    if (std::isnan(p + q + r + s)) return everything();
    return outward(std::fmin(std::fmin(p, q), std::fmin(r, s)), std::fmax(std::fmax(p, q), std::fmax(r, s)));
  }
  friend auto operator-(Interval a) -> Interval { return {-a.hi, -a.lo}; }

  [[nodiscard]] auto overlaps(Interval o) const -> bool { return lo <= o.hi && o.lo <= hi; }
  [[nodiscard]] auto holds_zero() const -> bool { return lo <= 0 && hi >= 0; }
};

/// An exact point in the plane.
struct ExactPoint {
  Rational x, y;
  friend auto operator==(const ExactPoint&, const ExactPoint&) -> bool = default;
};

}  // namespace mansard::extrude::detail
