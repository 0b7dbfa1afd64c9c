// The predicates of the sweep: each of their three tiers has the last word where it must, and all agree.
#include "mansard/extrude/detail/plane.hpp"

#include <gmock/gmock.h>

#include <tuple>

#include "mansard/base/run.hpp"

namespace {

using namespace mansard;
using namespace mansard::extrude::detail;

/// A line through a point at t = 0 that moves inward at a speed.
auto through(std::int64_t k, int quarters, Rational x, Rational y, Rational speed) -> Plane {
  const Direction d = direction_of({k, quarters});
  const Rational offset = (Rational(d.a) * y - Rational(d.b) * x) / d.l;
  return plane_of(d, offset, speed);
}

/// The sign of A x + B y − S t − D from rationals alone.
auto side_by_rationals(const Planes& planes, const Plane& plane, const Triple& at) -> int {
  const auto e = planes.exact(at);
  const auto c = plane.narrow ? Rational(to_integer(plane.whole.D)) : Rational(plane.unbounded->D);
  const auto s = plane.narrow ? Rational(to_integer(plane.whole.S)) : Rational(plane.unbounded->S);
  const auto a = plane.narrow ? Rational(to_integer(plane.whole.A)) : Rational(plane.unbounded->A);
  const auto b = plane.narrow ? Rational(to_integer(plane.whole.B)) : Rational(plane.unbounded->B);
  return sgn(Rational(a * e.x + b * e.y - s * e.t - c));
}

TEST(Plane, is_the_same_from_integers_as_from_rationals) {
  base::Random random(7);
  const auto below = [&random](double most) { return static_cast<std::int64_t>(random.uniform(0, most)); };
  for (int i = 0; i < 20000; ++i) {
    const double size = i % 4 == 0 ? 0x1.0p39 : 0x1.0p22, steep = i % 3 == 0 ? 0x1.0p29 : 0x1.0p12;
    const Direction d = direction_of({below(0x1.0p19) - (1 << 18), static_cast<int>(below(4))});
    const std::int64_t offset = below(2 * size) - static_cast<std::int64_t>(size), height = below(size);
    const std::int64_t run = i % 5 == 0 ? 0 : below(steep), rise = 1 + below(steep);
    Rational slope{mpz_class(run), mpz_class(rise)};
    slope.canonicalize();
    const Plane made = plane_of(d, offset, height, slope.get_num().get_si(), slope.get_den().get_si());
    const Plane expected = plane_of(d, Rational(offset) - slope * Rational(height), slope);
    ASSERT_TRUE(made.narrow && expected.narrow) << i;
    EXPECT_TRUE(made.direction == expected.direction) << i;
    EXPECT_TRUE(made.whole.A == expected.whole.A && made.whole.B == expected.whole.B) << i;
    EXPECT_TRUE(made.whole.D == expected.whole.D && made.whole.S == expected.whole.S) << i;
    EXPECT_EQ(std::tie(made.nx, made.ny, made.c, made.s), std::tie(expected.nx, expected.ny, expected.c, expected.s))
        << i;
  }
}

TEST(Predicate, is_decided_by_doubles_where_they_are_sure) {
  Planes planes;
  const PlaneId south = planes.add(through(0, 0, 0, 0, 1)), east = planes.add(through(0, 1, 1000, 0, 1)),
                north = planes.add(through(0, 2, 0, 600, 1)), west = planes.add(through(0, 3, 0, 0, 1));
  EXPECT_EQ(planes.side(west, {south, east, north}), 1);
  EXPECT_EQ(planes.tiers().filtered, 1U);
  EXPECT_EQ(planes.tiers().fixed, 0U);
  EXPECT_EQ(planes.tiers().unbounded, 0U);
}

// The roof of a turned square: its four planes meet in the apex.
TEST(Predicate, needs_fixed_width_integers_where_four_planes_meet_in_a_point) {
  Planes planes;
  std::vector<PlaneId> sides;
  for (int quarters = 0; quarters < 4; ++quarters)
    sides.push_back(planes.add(plane_of(direction_of({123456, quarters}), -70001, Rational(5, 7))));
  EXPECT_TRUE(planes[sides[0]].narrow);
  EXPECT_EQ(planes.side(sides[3], {sides[0], sides[1], sides[2]}), 0);
  EXPECT_EQ(planes.tiers().fixed, 1U);
  const Fraction apex = planes.time({sides[0], sides[1], sides[2]}), same = planes.time({sides[1], sides[2], sides[3]});
  EXPECT_EQ(planes.compare(apex, same), 0);
  EXPECT_EQ(planes.tiers().fixed, 2U);
  EXPECT_EQ(planes.compare(apex, fraction_of(98001)), 1);
  EXPECT_EQ(planes.compare(apex, fraction_of(98002)), -1);
  EXPECT_EQ(planes.tiers().unbounded, 0U);
}

TEST(Predicate, needs_unbounded_integers_for_planes_that_events_have_made) {
  Planes planes;
  const PlaneId a = planes.add(through(123456, 0, Rational(70001, 3), 11, Rational(12345, 67891))),
                b = planes.add(through(-234567, 1, 5, Rational(9999, 7), Rational(23456, 98765))),
                c = planes.add(through(345678, 2, 77, 10001, Rational(34567, 54321)));
  // A connector through the point where the three meet, as a joint makes it.
  const auto p = planes.exact({a, b, c});
  const Plane joint = plane_of(direction_of({3, 3}), Rational(p.x), 0);
  EXPECT_FALSE(joint.narrow);
  const PlaneId derived = planes.add(through(3, 1, p.x, p.y, 0));
  EXPECT_FALSE(planes[derived].narrow);
  EXPECT_EQ(planes.side(derived, {a, b, c}), 0);
  EXPECT_EQ(planes.tiers().unbounded, 1U);
}

TEST(Predicate, gives_the_same_sign_in_every_tier_as_rational_arithmetic) {
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE(seed);
    base::Random random(seed);
    Planes planes;
    const auto whole = [&](std::int64_t most) {
      return static_cast<std::int64_t>(random.index(static_cast<std::size_t>(2 * most))) - most;
    };
    // Every third plane goes through one common point, so that zeros occur.
    const Rational x(whole(100000), 3), y(whole(100000), 7);
    std::vector<PlaneId> ids;
    for (int i = 0; i < 6; ++i) {
      const bool common = random.index(3) != 0;
      Rational px = common ? x : Rational(whole(1000000)), py = common ? y : Rational(whole(1000000));
      px.canonicalize();
      py.canonicalize();
      Rational speed(static_cast<long>(random.index(50)), static_cast<unsigned long>(1 + random.index(50)));
      speed.canonicalize();
      if (random.index(2) == 0) speed = 0;
      if (random.index(4) == 0) px += Rational(1, mpz_class(mpz_class(1) << 90)), px.canonicalize();  // not narrow
      ids.push_back(planes.add(through(whole(400000), static_cast<int>(random.index(4)), px, py, speed)));
    }
    const Triple at{ids[0], ids[1], ids[2]};
    const int convergence = planes.convergence(at);
    if (convergence == 0) continue;
    for (int i = 3; i < 6; ++i) EXPECT_EQ(planes.side(ids[i], at), side_by_rationals(planes, planes[ids[i]], at)) << i;
    const auto e = planes.exact(at);
    const auto place = planes.nearest(at);
    EXPECT_EQ(place.x, nearest(e.x.get_num(), e.x.get_den()));
    EXPECT_EQ(place.z, nearest(e.t.get_num(), e.t.get_den()));
    const Triple other{ids[3], ids[4], ids[5]};
    if (planes.convergence(other) == 0) continue;
    const int order = cmp(e.t, planes.exact(other).t);
    EXPECT_EQ(planes.compare(planes.time(at), planes.time(other)), (order > 0) - (order < 0));
  }
}

TEST(Predicate, has_finite_doubles_of_planes_whose_integers_are_too_large_for_them) {
  const mpz_class large = mpz_class(1) << 1100;
  const Plane plane = plane_of(direction_of({3, 1}), Rational(large + 1, large / 1024), Rational(large, large * 3 + 1));
  EXPECT_FALSE(plane.narrow);
  EXPECT_DOUBLE_EQ(plane.c, 1024);
  EXPECT_DOUBLE_EQ(plane.s, 1.0 / 3);
}

TEST(Nearest, rounds_a_quotient_as_a_division_of_doubles_does) {
  base::Random random(7);
  for (int i = 0; i < 2000; ++i) {
    const auto n = static_cast<std::int64_t>(random.index(std::size_t{1} << 53)),
               d = static_cast<std::int64_t>(1 + random.index(std::size_t{1} << 40));
    EXPECT_EQ(nearest(Wide(n), Wide(d)), static_cast<double>(n) / static_cast<double>(d));
    EXPECT_EQ(nearest(mpz_class(-n), mpz_class(d)), -static_cast<double>(n) / static_cast<double>(d));
    // The same value written with larger numbers.
    const Wide factor = Wide(d) * Wide(n + 3) * Wide(1000003);
    EXPECT_EQ(nearest(Wide(Wide(n) * factor), Wide(Wide(d) * factor)), nearest(Wide(n), Wide(d)));
  }
}

TEST(Nearest, is_that_of_rationals_where_small_planes_meet) {
  base::Random random(11);
  const auto below = [&random](double most) { return static_cast<std::int64_t>(random.uniform(0, most)); };
  int met = 0;
  for (int i = 0; i < 20000; ++i) {
    const double size = i % 4 == 0 ? 0x1.0p39 : 0x1.0p22, steep = i % 3 == 0 ? 0x1.0p29 : 0x1.0p17;
    Planes planes;
    Triple at{};
    for (PlaneId& id : at) {
      const std::int64_t offset = below(2 * size) - static_cast<std::int64_t>(size), height = below(size);
      const std::int64_t run = i % 5 == 0 ? 0 : below(steep), rise = 1 + below(steep);
      Rational slope{mpz_class(run), mpz_class(rise)};
      slope.canonicalize();
      const Direction d = direction_of({below(0x1.0p19) - (1 << 18), static_cast<int>(below(4))});
      id = planes.add(plane_of(d, i % 7 == 0 ? 0 : offset, height, slope.get_num().get_si(), slope.get_den().get_si()));
    }
    if (i % 2 == 0) at[2] = planes.add(moment_plane(below(size)));
    if (planes.convergence(at) == 0) continue;
    ++met;
    const auto e = planes.exact(at);
    const auto place = planes.nearest(at);
    EXPECT_EQ(place.x, nearest(e.x.get_num(), e.x.get_den())) << i;
    EXPECT_EQ(place.y, nearest(e.y.get_num(), e.y.get_den())) << i;
    EXPECT_EQ(place.z, nearest(e.t.get_num(), e.t.get_den())) << i;
  }
  EXPECT_GT(met, 10000);
}

}  // namespace
