#include "mansard/extrude/detail/plane.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace mansard::extrude::detail {
namespace {

/// Of a plane whose predicates fit into 512 bits: bits of A, B and S, and of D. Then
///   W is six products of A, B, S: 3 · 72 + 3 = 219 bits; E six of A, B, D: 2 · 72 + 112 + 3 = 259; X and Y six of A or
///   B, S, D: 259; A X + B Y + S E − D W four of 72 + 259 or 112 + 219: 333; the difference of two times E · W' − E' ·
///   W: 259 + 219 + 1 = 479, the largest; and `nearest` shifts a numerator of 259 bits so that the quotient has 64: 64
///   + 219 + 1 = 284.
/// Planes of the input have: A, B < 2⁴¹ · scale, S < 2⁴¹ · run (2²⁶ quanta for 1 km), scale = rise (2²⁶), D < 2⁴¹ · 2³⁸
/// · 2²⁶.
constexpr std::size_t most_bits = 72, most_offset_bits = 112;

/// Of integers of any size: events upon events make planes whose coefficients are no finite doubles. Both are
/// truncated to within 2 u, the quotient rounded: 5 u.
auto ratio(const mpz_class& n, const mpz_class& d) -> double {
  long n_power = 0, d_power = 0;
  const double n_digits = mpz_get_d_2exp(&n_power, n.get_mpz_t()), d_digits = mpz_get_d_2exp(&d_power, d.get_mpz_t());
  return std::ldexp(n_digits / d_digits, static_cast<int>(n_power - d_power));
}

/// The next double towards zero, as GMP converts.
auto truncated(Int128 value) -> double {
  UInt128 magnitude = value < 0 ? -static_cast<UInt128>(value) : static_cast<UInt128>(value);
  int power = 0;
  while ((magnitude >> 64) != 0) {
    magnitude >>= 11;  // 53 of 64 bits are needed, so that none of those is lost
    power += 11;
  }
  auto digits = static_cast<std::uint64_t>(magnitude);
  if (const int spare = static_cast<int>(std::bit_width(digits)) - 53; spare > 0) {
    digits >>= spare;
    power += spare;
  }
  const double size = std::ldexp(static_cast<double>(digits), power);
  return value < 0 ? -size : size;
}

/// Doubles and narrowness from exact coefficients.
auto finished(Plane plane, Coefficients<mpz_class> exact) -> Plane {
  const mpz_class scale = abs(exact.A) > abs(exact.B)
                              ? mpz_class(exact.A * plane.direction.l / -mpz_class(plane.direction.b))
                              : mpz_class(exact.B * plane.direction.l / mpz_class(plane.direction.a));
  plane.nx = -static_cast<double>(plane.direction.b) / static_cast<double>(plane.direction.l);
  plane.ny = static_cast<double>(plane.direction.a) / static_cast<double>(plane.direction.l);
  plane.c = ratio(exact.D, scale);
  plane.s = ratio(exact.S, scale);
  plane.narrow = bits_of(exact.A) <= most_bits && bits_of(exact.B) <= most_bits && bits_of(exact.S) <= most_bits &&
                 bits_of(exact.D) <= most_offset_bits;
  if (plane.narrow) plane.whole = {to_int128(exact.A), to_int128(exact.B), to_int128(exact.D), to_int128(exact.S)};
  else plane.unbounded = std::make_shared<const Coefficients<mpz_class>>(std::move(exact));
  return plane;
}

auto sign_of(const Wide& value) -> int { return value.sign(); }
auto sign_of(const mpz_class& value) -> int { return sgn(value); }

/// Where three planes meet, homogeneous: x = X / W, y = Y / W, t = −E / W (Cramer's rule on A x + B y − S t = D).
template <class Number>
struct Meet {
  Number X, Y, E, W;
};

template <class Number>
auto det(const Number& a, const Number& b, const Number& c, const Number& m_bc, const Number& m_ac, const Number& m_ab)
    -> Number {
  return Number(a * m_bc) - Number(b * m_ac) + Number(c * m_ab);
}

template <class Number>
struct Triangle {
  const Coefficients<Number>&p, &q, &r;
  Number pq, pr, qr;  ///< minors A B

  Triangle(const Coefficients<Number>& i, const Coefficients<Number>& j, const Coefficients<Number>& k)
      : p(i), q(j), r(k), pq(i.A * j.B - j.A * i.B), pr(i.A * k.B - k.A * i.B), qr(j.A * k.B - k.A * j.B) {}

  [[nodiscard]] auto W() const -> Number { return det<Number>(p.S, q.S, r.S, qr, pr, pq); }
  [[nodiscard]] auto E() const -> Number { return det<Number>(p.D, q.D, r.D, qr, pr, pq); }
  [[nodiscard]] auto X() const -> Number {
    return det<Number>(p.D, q.D, r.D, Number(q.B * r.S - r.B * q.S), Number(p.B * r.S - r.B * p.S),
                       Number(p.B * q.S - q.B * p.S));
  }
  [[nodiscard]] auto Y() const -> Number {
    return det<Number>(p.D, q.D, r.D, Number(r.A * q.S - q.A * r.S), Number(r.A * p.S - p.A * r.S),
                       Number(q.A * p.S - p.A * q.S));
  }
  [[nodiscard]] auto meet() const -> Meet<Number> { return {X(), Y(), E(), W()}; }
};

/// A double with a bound: |exact − value| ≤ k · u · size with k known at the place of use.
struct Bounded {
  double value, size;
  friend auto operator+(Bounded a, Bounded b) -> Bounded { return {a.value + b.value, a.size + b.size}; }
  friend auto operator-(Bounded a, Bounded b) -> Bounded { return {a.value - b.value, a.size + b.size}; }
  friend auto operator*(Bounded a, Bounded b) -> Bounded { return {a.value * b.value, a.size * b.size}; }
};
auto bounded(double v) -> Bounded { return {v, std::abs(v)}; }
auto bounded(const Plane& p) -> Coefficients<Bounded> {
  return {bounded(p.nx), bounded(p.ny), bounded(p.c), bounded(p.s)};
}
/// Error bound of W and of A X + B Y + S E − D W, relative to `size`, the same with absolute values. Inputs: nx and ny
/// within 1 u, c and s within 8 u, relative. A minor of A and B: 1 + 1 + 1 u a product, 1 u the difference: 4 u; of A
/// or B and S: 1 + 8 + 1 + 1 = 11 u. W, E: 8 u for S or D, 1 u the product, 2 u the sums of three: 15 u. X, Y: 8 + 11 +
/// 1 + 2 = 22 u. The sum of four: at most 8 + 15 + 1 (or 1 + 22 + 1) + 3 = 27 u. `size` itself is computed within as
/// many u of itself, which is of order u². 32 would do; 64 costs no time.
constexpr double sign_error = 64 * unit_roundoff;
/// What underflow takes from at most 30 products: 2⁻¹⁰⁷⁴ each, times three coefficients below 2⁴¹ at most: 2⁻⁹⁴⁶.
constexpr double underflow = 0x1.0p-900;

auto certain_sign(Bounded b) -> int {
  const double bound = sign_error * b.size + underflow;
  return b.value > bound ? 1 : (b.value < -bound ? -1 : 0);
}

template <class Number>
auto side_of(const Coefficients<Number>& l, const Meet<Number>& m) -> Number {
  return Number(l.A * m.X) + Number(l.B * m.Y) + Number(l.S * m.E) - Number(l.D * m.W);
}

auto enclosed(Fraction f) -> Fraction {
  const double value = f.narrow ? nearest(f.n, f.d) : nearest(f.un, f.ud);
  f.lo = std::nextafter(value, -std::numeric_limits<double>::infinity());
  f.hi = std::nextafter(value, std::numeric_limits<double>::infinity());
  return f;
}

auto bit_length(const Wide& v) -> int { return v == 0 ? 0 : static_cast<int>(msb(v)) + 1; }
auto bit_length(const mpz_class& v) -> int { return v == 0 ? 0 : static_cast<int>(bits_of(v)); }
auto low_word(const Wide& v) -> std::uint64_t { return static_cast<std::uint64_t>(v); }
auto low_word(const mpz_class& v) -> std::uint64_t { return v.get_ui(); }

/// For magnitudes. The quotient is taken to 63 or 64 bits, the last of which also says whether anything is left over:
/// then its rounding to 53 bits is the value's.
template <class Number>
auto nearest_magnitude(Number n, Number d) -> double {
  if (n == 0) return 0;
  const int shift = 63 - (bit_length(n) - bit_length(d));
  // Wide numbers have room: quotients of the kernel have |n| < 2^262 and d < 2^222 (see Plane::narrow).
  if (shift >= 0) n <<= shift;
  else d <<= -shift;
  const Number quotient = n / d;
  std::uint64_t digits = low_word(quotient);
  if (Number(quotient * d) != n) digits |= 1;
  return std::ldexp(static_cast<double>(digits), -shift);
}

/// Whole numbers of 256 bits, two's complement: enough where three planes with small coefficients meet, as nearly all
/// of buildings have.
struct Middle {
  UInt128 high = 0, low = 0;

  [[nodiscard]] auto is_negative() const -> bool { return static_cast<Int128>(high) < 0; }
  [[nodiscard]] auto is_zero() const -> bool { return high == 0 && low == 0; }
  friend auto operator+(Middle a, Middle b) -> Middle {
    const UInt128 low = a.low + b.low;
    return {a.high + b.high + (low < a.low ? 1 : 0), low};
  }
  friend auto operator-(Middle a) -> Middle {
    const UInt128 low = -a.low;
    return {~a.high + (low == 0 ? 1 : 0), low};
  }
  friend auto operator-(Middle a, Middle b) -> Middle { return a + -b; }
  [[nodiscard]] auto shifted_up(int by) const -> Middle {
    if (by == 0) return *this;
    if (by >= 128) return {low << (by - 128), 0};
    return {high << by | low >> (128 - by), low << by};
  }
  [[nodiscard]] auto shifted_down(int by) const -> Middle {
    if (by == 0) return *this;
    if (by >= 128) return {0, high >> (by - 128)};
    return {high >> by, low >> by | high << (128 - by)};
  }
};

/// Of magnitudes.
auto product_of(UInt128 a, UInt128 b) -> Middle {
  const auto low = [](UInt128 v) { return static_cast<UInt128>(static_cast<std::uint64_t>(v)); };
  const UInt128 ll = low(a) * low(b), lh = low(a) * (b >> 64), hl = (a >> 64) * low(b), hh = (a >> 64) * (b >> 64);
  const UInt128 middle = (ll >> 64) + low(lh) + low(hl);
  return {hh + (lh >> 64) + (hl >> 64) + (middle >> 64), middle << 64 | low(ll)};
}
auto product_of(Int128 a, Int128 b) -> Middle {
  const auto magnitude = [](Int128 v) { return v < 0 ? -static_cast<UInt128>(v) : static_cast<UInt128>(v); };
  const Middle product = product_of(magnitude(a), magnitude(b));
  return (a < 0) != (b < 0) ? -product : product;
}
auto bits_in(UInt128 v) -> int {
  const auto high = static_cast<std::uint64_t>(v >> 64);
  return high != 0 ? 64 + static_cast<int>(std::bit_width(high))
                   : static_cast<int>(std::bit_width(static_cast<std::uint64_t>(v)));
}
auto bits_in(Middle v) -> int { return v.high != 0 ? 128 + bits_in(v.high) : bits_in(v.low); }

/// n / d as `nearest_magnitude` gives it, of magnitudes below 2^239 and 2^189: shifted, both stay below 2^253. The
/// quotient of their leading digits, 64 bits of d and the same of n and 64 more, is too large by 2 at most (D. E.
/// Knuth, The Art of Computer Programming 2, 4.3.1, theorem B).
auto nearest_magnitude(Middle n, Middle d) -> double {
  if (n.is_zero()) return 0;
  const int shift = 63 - (bits_in(n) - bits_in(d));
  if (shift >= 0) n = n.shifted_up(shift);
  else d = d.shifted_up(-shift);
  const int off = bits_in(d) - 64;
  const UInt128 leading_n = off >= 0 ? n.shifted_down(off).low : n.shifted_up(-off).low,
                leading_d = off >= 0 ? d.shifted_down(off).low : d.shifted_up(-off).low;
  const UInt128 most = UINT64_MAX;
  UInt128 quotient = std::min(leading_n / leading_d, most);
  const auto times = [&](UInt128 q) {  // q < 2^64, and the product is below 2^254
    const Middle low = product_of(d.low, q);
    return Middle{low.high + d.high * q, low.low};
  };
  Middle rest = n - times(quotient);
  for (; rest.is_negative(); rest = rest + d) --quotient;
  auto digits = static_cast<std::uint64_t>(quotient);
  if (!rest.is_zero()) digits |= 1;
  return std::ldexp(static_cast<double>(digits), -shift);
}
/// As `nearest`.
auto quotient_of(Middle n, Middle d) -> double {
  const bool minus = n.is_negative() != d.is_negative() && !n.is_zero();
  const double magnitude = nearest_magnitude(n.is_negative() ? -n : n, d.is_negative() ? -d : d);
  return minus ? -magnitude : magnitude;
}

/// |A|, |B|, |S| < 2^62, |D| < 2^112: minors of A, B and S are below 2^125, W below 2^189, X, Y and E below 2^239.
auto is_small(const Plane& plane) -> bool {
  const auto is_below = [](Int128 value, int bits) {
    const Int128 most = static_cast<Int128>(1) << bits;
    return value < most && value > -most;
  };
  const auto& c = plane.whole;
  return plane.narrow && is_below(c.A, 62) && is_below(c.B, 62) && is_below(c.S, 62) && is_below(c.D, 112);
}

/// Where three planes meet that are small.
auto meet_of(const Coefficients<Int128>& p, const Coefficients<Int128>& q, const Coefficients<Int128>& r)
    -> Meet<Middle> {
  const auto det_of = [](Int128 a, Int128 b, Int128 c, Int128 m_bc, Int128 m_ac, Int128 m_ab) {
    return product_of(a, m_bc) - product_of(b, m_ac) + product_of(c, m_ab);
  };
  const Int128 pq = p.A * q.B - q.A * p.B, pr = p.A * r.B - r.A * p.B, qr = q.A * r.B - r.A * q.B;
  return {det_of(p.D, q.D, r.D, q.B * r.S - r.B * q.S, p.B * r.S - r.B * p.S, p.B * q.S - q.B * p.S),
          det_of(p.D, q.D, r.D, r.A * q.S - q.A * r.S, r.A * p.S - p.A * r.S, q.A * p.S - p.A * q.S),
          det_of(p.D, q.D, r.D, qr, pr, pq), det_of(p.S, q.S, r.S, qr, pr, pq)};
}

}  // namespace

auto nearest(const Wide& n, const Wide& d) -> double {
  const double magnitude = nearest_magnitude<Wide>(abs(n), abs(d));
  return n.sign() * d.sign() < 0 ? -magnitude : magnitude;
}
auto nearest(const mpz_class& n, const mpz_class& d) -> double {
  const double magnitude = nearest_magnitude<mpz_class>(abs(n), abs(d));
  return sgn(n) * sgn(d) < 0 ? -magnitude : magnitude;
}

auto plane_of(const Direction& direction, const Rational& offset, const Rational& speed) -> Plane {
  const mpz_class scale = lcm(offset.get_den(), speed.get_den());
  Plane plane;
  plane.direction = direction;
  const mpz_class l(direction.l);
  return finished(std::move(plane), {-mpz_class(direction.b) * scale, mpz_class(direction.a) * scale,
                                     l * offset.get_num() * mpz_class(scale / offset.get_den()),
                                     l * speed.get_num() * mpz_class(scale / speed.get_den())});
}

auto plane_of(const Direction& direction, std::int64_t offset, std::int64_t height, std::int64_t run, std::int64_t rise)
    -> Plane {
  Plane plane;
  plane.direction = direction;
  // As above: the offset at height 0 is (offset · rise − run · height) / rise, whose denominator divides that of the
  // speed. A, B, S < 2⁴¹ · 2³⁰, D < 2⁴¹ · (2⁷⁰ + 2⁷⁰) = 2¹¹².
  const Int128 l = direction.l, scale = l * rise;
  plane.whole = {-static_cast<Int128>(direction.b) * rise, static_cast<Int128>(direction.a) * rise,
                 l * (static_cast<Int128>(offset) * rise - static_cast<Int128>(run) * height), l * run};
  plane.nx = -static_cast<double>(direction.b) / static_cast<double>(direction.l);
  plane.ny = static_cast<double>(direction.a) / static_cast<double>(direction.l);
  plane.c = truncated(plane.whole.D) / truncated(scale);
  plane.s = truncated(plane.whole.S) / truncated(scale);
  return plane;
}

auto flipped(const Plane& plane) -> Plane {
  Plane other = plane;
  other.direction = plane.direction.reversed();
  other.nx = -plane.nx;
  other.ny = -plane.ny;
  other.c = -plane.c;
  other.s = -plane.s;
  if (plane.narrow) {
    other.whole = {-plane.whole.A, -plane.whole.B, -plane.whole.D, -plane.whole.S};
  } else {
    const auto& u = *plane.unbounded;
    other.unbounded = std::make_shared<const Coefficients<mpz_class>>(Coefficients<mpz_class>{-u.A, -u.B, -u.D, -u.S});
  }
  return other;
}

auto at_rest(const Plane& plane, std::int64_t t) -> Plane {
  Coefficients<mpz_class> exact = plane.narrow
                                      ? Coefficients<mpz_class>{to_integer(plane.whole.A), to_integer(plane.whole.B),
                                                                to_integer(plane.whole.D), to_integer(plane.whole.S)}
                                      : *plane.unbounded;
  exact.D += exact.S * mpz_class(t);
  exact.S = 0;
  Plane rest;
  rest.direction = plane.direction;
  return finished(std::move(rest), std::move(exact));
}

auto moment_plane(std::int64_t t) -> Plane {
  Plane plane;
  plane.whole = {0, 0, -static_cast<Int128>(t), 1};
  plane.c = -static_cast<double>(t);
  plane.s = 1;
  return plane;
}

template <class Number>
auto Planes::coefficients(PlaneId id) const -> Coefficients<Number> {
  const Plane& p = planes_[id];
  if constexpr (std::is_same_v<Number, Wide>) {
    return {Wide(p.whole.A), Wide(p.whole.B), Wide(p.whole.D), Wide(p.whole.S)};
  } else {
    if (!p.narrow) return *p.unbounded;
    return {to_integer(p.whole.A), to_integer(p.whole.B), to_integer(p.whole.D), to_integer(p.whole.S)};
  }
}

auto Planes::convergence(const Triple& at) const -> int {
  {
    const auto p = bounded(planes_[at[0]]), q = bounded(planes_[at[1]]), r = bounded(planes_[at[2]]);
    if (const int sure = certain_sign(Triangle<Bounded>(p, q, r).W()); sure != 0) return ++tiers_.filtered, sure;
  }
  const auto exactly = [&]<class Number>(Number) {
    const auto p = coefficients<Number>(at[0]), q = coefficients<Number>(at[1]), r = coefficients<Number>(at[2]);
    return sign_of(Triangle<Number>(p, q, r).W());
  };
  if (narrow(at)) return ++tiers_.fixed, exactly(Wide());
  return ++tiers_.unbounded, exactly(mpz_class());
}

auto Planes::side(PlaneId plane, const Triple& at) const -> int {
  {
    const auto p = bounded(planes_[at[0]]), q = bounded(planes_[at[1]]), r = bounded(planes_[at[2]]);
    const Meet<Bounded> m = Triangle<Bounded>(p, q, r).meet();
    const int sure = certain_sign(side_of(bounded(planes_[plane]), m)) * certain_sign(m.W);
    if (sure != 0) return ++tiers_.filtered, sure;
  }
  const auto exactly = [&]<class Number>(Number) {
    const auto p = coefficients<Number>(at[0]), q = coefficients<Number>(at[1]), r = coefficients<Number>(at[2]),
               l = coefficients<Number>(plane);
    const Meet<Number> m = Triangle<Number>(p, q, r).meet();
    if (sign_of(m.W) == 0) throw Broken("three lines that do not meet in one point");
    return sign_of(side_of(l, m)) * sign_of(m.W);
  };
  if (narrow(at) && planes_[plane].narrow) return ++tiers_.fixed, exactly(Wide());
  return ++tiers_.unbounded, exactly(mpz_class());
}

auto Planes::time(const Triple& at) const -> Fraction {
  Fraction f;
  f.narrow = narrow(at);
  const auto exactly = [&]<class Number>(Number& n, Number& d) {
    const auto p = coefficients<Number>(at[0]), q = coefficients<Number>(at[1]), r = coefficients<Number>(at[2]);
    const Triangle<Number> triangle(p, q, r);
    n = -triangle.E();
    d = triangle.W();
    if (sign_of(d) == 0) throw Broken("three lines that do not meet in one point");
    if (sign_of(d) < 0) {
      n = -n;
      d = -d;
    }
  };
  if (f.narrow) exactly(f.n, f.d);
  else exactly(f.un, f.ud);
  return enclosed(std::move(f));
}

auto Planes::compare(const Fraction& a, const Fraction& b) const -> int {
  if (a.hi < b.lo || a.lo > b.hi) return ++tiers_.filtered, a.hi < b.lo ? -1 : 1;
  if (a.narrow && b.narrow) return ++tiers_.fixed, sign_of(Wide(Wide(a.n * b.d) - Wide(b.n * a.d)));
  ++tiers_.unbounded;
  const auto integer = [](const Wide& w) {
    mpz_class z(0);
    Wide rest = abs(w);
    for (mp_bitcnt_t shift = 0; rest != 0; shift += 64, rest >>= 64)
      z += mpz_class(static_cast<unsigned long>(static_cast<std::uint64_t>(rest & Wide(UINT64_MAX)))) << shift;
    return w.sign() < 0 ? mpz_class(-z) : z;
  };
  const mpz_class an = a.narrow ? integer(a.n) : a.un, ad = a.narrow ? integer(a.d) : a.ud,
                  bn = b.narrow ? integer(b.n) : b.un, bd = b.narrow ? integer(b.d) : b.ud;
  return sgn(mpz_class(an * bd - bn * ad));
}

auto Planes::exact(const Triple& at) const -> Exact {
  const auto p = coefficients<mpz_class>(at[0]), q = coefficients<mpz_class>(at[1]), r = coefficients<mpz_class>(at[2]);
  const Meet<mpz_class> m = Triangle<mpz_class>(p, q, r).meet();
  if (m.W == 0) throw Broken("three lines that do not meet in one point");
  Exact e{Rational(m.X, m.W), Rational(m.Y, m.W), Rational(-m.E, m.W)};
  e.x.canonicalize();
  e.y.canonicalize();
  e.t.canonicalize();
  return e;
}

auto Planes::nearest(const Triple& at) const -> geometry::Point3 {
  const Plane &i = planes_[at[0]], &j = planes_[at[1]], &k = planes_[at[2]];
  if (is_small(i) && is_small(j) && is_small(k)) {
    const auto m = meet_of(i.whole, j.whole, k.whole);
    if (m.W.is_zero()) throw Broken("three lines that do not meet in one point");
    return {quotient_of(m.X, m.W), quotient_of(m.Y, m.W), quotient_of(-m.E, m.W)};
  }
  const auto exactly = [&]<class Number>(Number) -> geometry::Point3 {
    const auto p = coefficients<Number>(at[0]), q = coefficients<Number>(at[1]), r = coefficients<Number>(at[2]);
    const Meet<Number> m = Triangle<Number>(p, q, r).meet();
    if (sign_of(m.W) == 0) throw Broken("three lines that do not meet in one point");
    return {detail::nearest(m.X, m.W), detail::nearest(m.Y, m.W), detail::nearest(Number(-m.E), m.W)};
  };
  return narrow(at) ? exactly(Wide()) : exactly(mpz_class());
}

auto fraction_of(std::int64_t whole) -> Fraction {
  Fraction f;
  f.n = whole;
  return enclosed(std::move(f));
}

}  // namespace mansard::extrude::detail
