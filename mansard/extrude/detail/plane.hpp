// Moving lines as planes in (x, y, t), where three of them meet, and every decision of the sweep about that.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "mansard/extrude/detail/direction.hpp"
#include "mansard/extrude/detail/numbers.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::extrude::detail {

/// How often each tier of the predicates had the last word: doubles with a bound on their error, integers of 512 bits,
/// and GMP for planes that events have made.
struct Tiers {
  std::uint64_t filtered = 0, fixed = 0, unbounded = 0;
  auto operator+=(const Tiers& o) -> Tiers& {
    filtered += o.filtered;
    fixed += o.fixed;
    unbounded += o.unbounded;
    return *this;
  }
};

template <class Number>
struct Coefficients {
  Number A, B, D, S;
};

/// A x + B y = D + S t in integers, x, y and z in quanta; (A, B) is the line's direction turned left, times a
/// positive factor. The interior is where the left side is the greater one. t is the height, or a terrace's time τ.
/// A plane with A = B = 0 is a moment: S t = −D.
struct Plane {
  Direction direction;
  bool narrow = true;                      ///< |A|, |B|, |S| < 2^72, |D| < 2^112: then all predicates stay below 2^479
  Coefficients<Int128> whole{0, 0, 0, 0};  ///< when narrow
  std::shared_ptr<const Coefficients<mpz_class>> unbounded;  ///< when not
  /// Unit normal, offset and speed in quanta. nx and ny are within 2^-53, relative: a quotient of integers below
  /// 2^41. c and s are within 2^-50: two numbers truncated (2^-52 each), a quotient.
  double nx = 0, ny = 0, c = 0, s = 0;

  [[nodiscard]] auto is_static() const -> bool { return narrow ? whole.S == 0 : unbounded->S == 0; }
};

/// The line n · x = offset + slope t in quanta, n the direction turned left.
[[nodiscard]] auto plane_of(const Direction& direction, const Rational& offset, const Rational& speed) -> Plane;
/// The same from integers, without allocation: a line that is at `offset` quanta at a height of `height` quanta and
/// moves by run / rise, in lowest terms, rise > 0. |offset| < 2^40, |height| < 2^39; run, rise < 2^30.
[[nodiscard]] auto plane_of(const Direction& direction, std::int64_t offset, std::int64_t height, std::int64_t run,
                            std::int64_t rise) -> Plane;
/// The same line looked at from the other side.
[[nodiscard]] auto flipped(const Plane& plane) -> Plane;
/// Where a moving line is at t, for ever.
[[nodiscard]] auto at_rest(const Plane& plane, std::int64_t t) -> Plane;
/// The moment t = quanta.
[[nodiscard]] auto moment_plane(std::int64_t t) -> Plane;

using PlaneId = std::uint32_t;
inline constexpr std::uint32_t none = UINT32_MAX;

/// A point of space-time where three planes meet.
using Triple = std::array<PlaneId, 3>;

/// n / d with d > 0, exact.
struct Fraction {
  bool narrow = true;
  Wide n = 0, d = 1;
  mpz_class un, ud;
  double lo = 0, hi = 0;  ///< the value lies within
};

/// All planes of one sweep, with the predicates. Identifiers stay valid.
class Planes {
 public:
  auto add(Plane plane) -> PlaneId {
    planes_.push_back(std::move(plane));
    return static_cast<PlaneId>(planes_.size() - 1);
  }
  [[nodiscard]] auto operator[](PlaneId id) const -> const Plane& { return planes_[id]; }
  [[nodiscard]] auto size() const -> std::size_t { return planes_.size(); }

  /// Sign of det [A B S]: zero when the three lines never meet in one point, or always.
  [[nodiscard]] auto convergence(const Triple& at) const -> int;
  /// On which side of the plane the point lies: +1 the interior, 0 on it. The triple's planes must meet in a point.
  [[nodiscard]] auto side(PlaneId plane, const Triple& at) const -> int;
  /// When the three lines meet.
  [[nodiscard]] auto time(const Triple& at) const -> Fraction;
  [[nodiscard]] auto compare(const Fraction& a, const Fraction& b) const -> int;

  struct Exact {
    Rational x, y, t;  ///< quanta
  };
  [[nodiscard]] auto exact(const Triple& at) const -> Exact;
  /// x, y, t as the nearest doubles, quanta.
  [[nodiscard]] auto nearest(const Triple& at) const -> geometry::Point3;

  [[nodiscard]] auto tiers() const -> const Tiers& { return tiers_; }

 private:
  [[nodiscard]] auto narrow(const Triple& at) const -> bool {
    return planes_[at[0]].narrow && planes_[at[1]].narrow && planes_[at[2]].narrow;
  }
  template <class Number>
  [[nodiscard]] auto coefficients(PlaneId id) const -> Coefficients<Number>;

  std::vector<Plane> planes_;
  mutable Tiers tiers_;
};

[[nodiscard]] auto fraction_of(std::int64_t whole) -> Fraction;

/// n / d as the nearest double, ties to even: equal values give equal doubles however they are written.
[[nodiscard]] auto nearest(const Wide& n, const Wide& d) -> double;
[[nodiscard]] auto nearest(const mpz_class& n, const mpz_class& d) -> double;

}  // namespace mansard::extrude::detail
