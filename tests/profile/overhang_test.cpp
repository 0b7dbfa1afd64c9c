// How far eaves overhang: drawn houses of which the scan shows the walls below the roof, and some of which it does not.
#include "mansard/profile/overhang.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "profile/houses.hpp"

namespace {

using namespace houses;  // NOLINT: the fixture of this folder
using mansard::model::Plan;
using mansard::profile::measure_overhangs;
using mansard::profile::Options;
using mansard::profile::PlanOverhangs;

constexpr std::size_t south = 0, east = 1, north = 2, west = 3;
constexpr double gutter = 6, pitch = 0.8;

/// A gabled house of 14 by 9 m whose roof goes on beyond its south and north walls, with a level soffit.
struct Drawn {
  double overhang_south = 0.4, overhang_north = 0.4;
  bool walls = true;
  double noise = 0;
};

auto house_of(const Drawn& drawn) -> House {
  House house;
  house.noise = drawn.noise;
  house.edge = 0.2;
  return house;
}

auto scan_of(const Drawn& drawn) -> Scan {
  const House house = house_of(drawn);
  Scan scan(house);
  const double l = house.length, w = house.width, e = house.edge;
  const double s0 = -drawn.overhang_south, s1 = w + drawn.overhang_north;
  const auto roof = [&](double y) { return gutter + pitch * std::min(y, w - y); };
  scan.sheet(cells(l, e), cells(s1 - s0, e), [&](double s, double t) {
    const double y = s0 + t * (s1 - s0);
    return Point3{s * l, y, roof(y)};
  });
  scan.sheet(cells(l + 10, 1), cells(w + 10, 1), [&](double s, double t) {
    return Point3{s * (l + 10) - 5, t * (w + 10) - 5, 0};
  });
  const auto upright = [&](Point2 a, Point2 b, double top) {
    const double size = mansard::geometry::length(b - a);
    scan.sheet(cells(size, e), cells(top, e), [&](double s, double t) {
      const Point2 p = a + s * (b - a);
      return Point3{p.x, p.y, t * top};
    });
  };
  if (!drawn.walls) {  // as seen from above: the roof's edge down to the ground
    upright({0, s0}, {l, s0}, roof(s0));
    upright({l, s1}, {0, s1}, roof(s1));
    return scan;
  }
  const auto soffit = [&](double wall, double edge) {
    if (wall == edge) return;
    scan.sheet(cells(l, e), cells(std::abs(edge - wall), e), [&](double s, double t) {
      return Point3{s * l, wall + t * (edge - wall), roof(edge)};
    });
  };
  upright({0, 0}, {l, 0}, roof(s0));
  upright({l, w}, {0, w}, roof(s1));
  soffit(0, s0);
  soffit(w, s1);
  return scan;
}

/// The plan that the house has: walls below the roof, gables in the east and west.
auto plan_of(const House& house, double outward = 0) -> Plan {
  Plan plan;
  const double l = house.length, w = house.width;
  plan.outer.points = {placed(house, 0, -outward), placed(house, l, -outward), placed(house, l, w + outward),
                       placed(house, 0, w + outward)};
  plan.outer.profile_of_edge = {0, 1, 0, 1};
  const double eave = gutter - outward * pitch;
  plan.profiles = {{{0, 0}, {0, eave}, {4.5, eave + 4.5 * pitch}}, {{0, 0}, {0, 15}}};
  plan.base = house.ground;
  plan.cap = 15;
  return plan;
}

auto measured(const Mesh& mesh, const Plan& plan, const Options& options = {}) -> PlanOverhangs {
  return measure_overhangs(std::array{plan}, mesh, options).front();
}

TEST(MeasureOverhangs, finds_what_was_drawn_along_each_edge) {
  Drawn drawn;
  drawn.overhang_north = 0.8;
  const auto seen = measured(scan_of(drawn).mesh, plan_of(house_of(drawn)))[0];
  ASSERT_TRUE(seen[south] && seen[north]);
  EXPECT_NEAR(seen[south]->distance, 0.4, 0.03);
  EXPECT_NEAR(seen[north]->distance, 0.8, 0.03);
  EXPECT_LE(seen[south]->outermost, 0.4 + 1e-6);
  EXPECT_NEAR(seen[south]->wall, 0, 0.01);
  EXPECT_GT(seen[south]->support, 0.9);
  EXPECT_FALSE(seen[east] || seen[west]);
}

TEST(MeasureOverhangs, is_from_the_wall_wherever_the_edge_of_the_plan_is) {
  const Drawn drawn;
  for (const double outward : {-0.15, 0.15}) {
    SCOPED_TRACE(outward);
    const auto seen = measured(scan_of(drawn).mesh, plan_of(house_of(drawn), outward))[0];
    ASSERT_TRUE(seen[south]);
    EXPECT_NEAR(seen[south]->distance, 0.4, 0.04);
    EXPECT_NEAR(seen[south]->wall, -outward, 0.02);
  }
}

TEST(MeasureOverhangs, bears_the_noise_of_scans) {
  Drawn drawn;
  drawn.noise = 0.04;
  drawn.overhang_south = 0.5;
  drawn.overhang_north = 0;
  const auto seen = measured(scan_of(drawn).mesh, plan_of(house_of(drawn)))[0];
  ASSERT_TRUE(seen[south]);
  EXPECT_NEAR(seen[south]->distance, 0.5, 0.1);
  EXPECT_FALSE(seen[north]);
}

TEST(MeasureOverhangs, guarantees_1_that_small_and_large_ones_do_not_count) {
  Drawn drawn;
  drawn.overhang_south = 0.1;
  drawn.overhang_north = 2;
  const auto seen = measured(scan_of(drawn).mesh, plan_of(house_of(drawn)))[0];
  EXPECT_FALSE(seen[south] || seen[north]);
  Options options;
  options.overhang_min = 0.05;
  options.overhang_max = 2.5;
  const auto more = measured(scan_of(drawn).mesh, plan_of(house_of(drawn)), options)[0];
  ASSERT_TRUE(more[south] && more[north]);
  EXPECT_NEAR(more[south]->distance, 0.1, 0.03);
  EXPECT_NEAR(more[north]->distance, 2, 0.05);
}

TEST(MeasureOverhangs, guarantees_2_that_a_height_field_has_none) {
  Drawn drawn;
  drawn.walls = false;
  for (const double noise : {0.0, 0.05})
    for (const double outward : {0.0, 0.2, 0.4}) {  // footprints at the walls, in between, and at the eaves
      drawn.noise = noise;
      const auto seen = measured(scan_of(drawn).mesh, plan_of(house_of(drawn), outward))[0];
      EXPECT_FALSE(seen[south] || seen[north]) << outward << " " << noise;
    }
}

TEST(MeasureOverhangs, guarantees_3_that_they_end_halfway_to_a_neighbour) {
  Drawn drawn;
  drawn.overhang_south = 0.6;
  auto scan = scan_of(drawn);
  const double l = house_of(drawn).length;
  scan.sheet(30, 30, [&](double s, double t) { return Point3{s * l, -1.0, t * 9}; });
  const auto seen = measured(scan.mesh, plan_of(house_of(drawn)))[0];
  ASSERT_TRUE(seen[south] && seen[north]);
  EXPECT_NEAR(seen[south]->distance, 0.5, 0.01);
  EXPECT_NEAR(seen[north]->distance, 0.4, 0.03);
}

TEST(MeasureOverhangs, finds_none_where_too_little_of_the_wall_is_seen) {
  const Drawn drawn;
  const House house = house_of(drawn);
  auto mesh = scan_of(drawn).mesh;
  // Everything upright in the eastern three quarters is lost.
  std::erase_if(mesh.triangles, [&](const auto& t) {
    double x = 0, top = 0, low = 1e9;
    for (const auto v : t) {
      const auto p = mesh.vertices[v];
      const Point2 d = mansard::geometry::xy(p) - house.at;
      x = std::max(x, std::cos(house.turned) * d.x + std::sin(house.turned) * d.y);
      top = std::max(top, p.z - house.ground);
      low = std::min(low, p.z - house.ground);
    }
    return x > house.length / 4 && low > 0.3 && top < 5.5;
  });
  EXPECT_FALSE(measured(mesh, plan_of(house))[0][south]);
  Options options;
  options.overhang_support = 0.1;
  const auto seen = measured(mesh, plan_of(house), options)[0];
  ASSERT_TRUE(seen[south]);
  EXPECT_NEAR(seen[south]->distance, 0.4, 0.03);
}

}  // namespace
