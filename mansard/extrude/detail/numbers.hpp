// The numbers of the kernel: rationals at its edges, fixed-width integers within, and what both become in the end.
#pragma once

#include <gmpxx.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "mansard/geometry/points.hpp"

namespace mansard::extrude::detail {

/// u: a double nearest to a number is off by no more than this times the number.
inline constexpr double unit_roundoff = 0x1.0p-53;

using Rational = mpq_class;
__extension__ typedef __int128 Int128;
__extension__ typedef unsigned __int128 UInt128;

/// Whole numbers of up to 512 bits without allocation: the second tier of the predicates. Arithmetic is unchecked;
/// see `most_bits` in plane.cpp for why nothing overflows.
using Wide = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<512, 512, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked, void>,
    boost::multiprecision::et_off>;

/// An invariant of the sweep does not hold. Caught in the public function, which then tries simpler solids.
struct Broken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Offsets and heights are multiples of 2^-16 m (15 µm): whole quanta.
inline constexpr double quantum = 0x1.0p-16;
inline constexpr long quanta_per_metre = 65536;

[[nodiscard]] inline auto quantised(double metres) -> Rational {
  return Rational(mpz_class(std::nearbyint(metres / quantum)), quanta_per_metre);
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
/// Of a number below 2^126 in magnitude.
[[nodiscard]] inline auto to_int128(const mpz_class& value) -> Int128 {
  const mpz_class magnitude = abs(value), high = magnitude >> 64;
  const auto result = static_cast<Int128>((static_cast<UInt128>(high.get_ui()) << 64) | magnitude.get_ui());
  return value < 0 ? -result : result;
}
[[nodiscard]] inline auto bits_of(const mpz_class& value) -> std::size_t {
  return mpz_sizeinbase(value.get_mpz_t(), 2);
}

/// An exact point in the plane.
struct ExactPoint {
  Rational x, y;
  /// In the nearest doubles towards zero, as GMP converts.
  [[nodiscard]] auto approximate() const -> geometry::Point2 { return {x.get_d(), y.get_d()}; }
  friend auto operator==(const ExactPoint&, const ExactPoint&) -> bool = default;
};

}  // namespace mansard::extrude::detail
