// The direction table: rational unit vectors, so that parallel, opposite and perpendicular edges are exactly so.
#pragma once

#include <compare>
#include <cstdint>

#include "mansard/extrude/detail/numbers.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::extrude::detail {

/// A unit vector (a / l, b / l) with whole a, b, l and a² + b² = l², in lowest terms: equal directions have equal
/// members. All are below 2^41, so products of two fit 128 bits.
struct Direction {
  std::int64_t a = 1, b = 0, l = 1;
  friend auto operator<=>(const Direction&, const Direction&) = default;

  [[nodiscard]] auto left() const -> Direction { return {-b, a, l}; }
  [[nodiscard]] auto reversed() const -> Direction { return {-a, -b, l}; }
  [[nodiscard]] auto approximate() const -> geometry::Point2 {
    return {static_cast<double>(a) / static_cast<double>(l), static_cast<double>(b) / static_cast<double>(l)};
  }
};

[[nodiscard]] inline auto cross(const Direction& p, const Direction& q) -> Int128 {
  return static_cast<Int128>(p.a) * q.b - static_cast<Int128>(p.b) * q.a;
}
[[nodiscard]] inline auto dot(const Direction& p, const Direction& q) -> Int128 {
  return static_cast<Int128>(p.a) * q.a + static_cast<Int128>(p.b) * q.b;
}

/// An angle modulo a quarter turn as k (t = k / 2^20 of the half angle, within ±22.5°), and the quarter turns beside
/// it.
struct Bearing {
  std::int64_t k = 0;
  int quarters = 0;
};
/// The table's entry nearest to a vector. A quarter turn of the vector adds to `quarters` alone, and a mirrored vector
/// has −k, bit for bit; but a vector at exactly 45° to the axes has the greatest k and its mirror image too, because no
/// rational unit vector lies there.
[[nodiscard]] auto bearing_of(geometry::Point2 vector) -> Bearing;
[[nodiscard]] auto direction_of(Bearing bearing) -> Direction;

/// Which of two rays comes first counter-clockwise from the positive x axis; exact.
[[nodiscard]] auto angle_less(const Direction& p, const Direction& q) -> bool;

}  // namespace mansard::extrude::detail
