// Dormers on slopes: found where they are, and nothing else taken for one.
#include "mansard/refine/detail/dormers.hpp"

#include <gmock/gmock.h>

#include "scans.hpp"

namespace {

using namespace scans;
using testing::IsEmpty;
using testing::SizeIs;

const geometry::Ring house = rectangle(10, 20, 12, 9);

auto gabled() -> Plan { return plan(house, {roof(5, 0.9), wall(5), roof(5, 0.9), wall(5)}, 12); }
/// A box on the southern slope, its front 0.8 m from the eaves.
auto box(double x, double width, double high) -> Plan {
  const double front = 5 + 0.9 * 0.8;
  const double depth = high / 0.9;
  return plan(rectangle(x, 20.8, width, depth), std::vector<Profile>(4, wall(front + high)), front + high);
}

/// As a scan shows it: every 0.2 m, smoothed with a standard deviation of 0.35 m.
auto melted(const std::vector<Plan>& seen) -> rays::Scene {
  const auto sharp = scan(seen, 0);
  constexpr double step = 0.2, deviation = 0.35;
  constexpr int reach = 5, columns = 80, rows = 65;
  geometry::Mesh mesh;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const Point2 at{8 + step * i, 18 + step * j};
      double sum = 0, weights = 0;
      for (int dj = -reach; dj <= reach; ++dj)
        for (int di = -reach; di <= reach; ++di) {
          const Point2 off{step * di, step * dj};
          const double weight = std::exp(-dot(off, off) / (2 * deviation * deviation));
          sum += weight * sharp.top(at + off).value_or(ground), weights += weight;
        }
      mesh.vertices.push_back({at.x, at.y, sum / weights});
    }
  for (std::uint32_t j = 0; j + 1 < rows; ++j)
    for (std::uint32_t i = 0; i + 1 < columns; ++i) {
      const std::uint32_t a = j * columns + i;
      mesh.triangles.push_back({a, a + 1, a + columns});
      mesh.triangles.push_back({a + 1, a + columns + 1, a + columns});
    }
  return rays::Scene(mesh);
}

auto options_at(double price) -> refine::Options {
  refine::Options options;
  options.dormers.price = price;
  return options;
}

auto refined(const std::vector<Plan>& seen, const refine::Options& options = options_at(0.25))
    -> std::vector<refine::Part> {
  auto out = refine::refine(std::vector{flat_draft(house, 6)}, scan(seen), options, {});
  EXPECT_THAT(out.failed, IsEmpty());
  for (const auto& part : out.parts) {
    EXPECT_THAT(solid::check(part.raised.solid), IsEmpty());
    EXPECT_EQ(part.raised.outcome, extrude::Outcome::full);
  }
  return std::move(out.parts);
}

TEST(Dormers, become_parts_in_holes_of_the_roof) {
  const auto parts = refined({gabled(), box(12, 1.6, 1.4), box(16, 1.6, 1.4)});
  ASSERT_THAT(parts, SizeIs(3));
  EXPECT_THAT(parts[0].plan.holes, SizeIs(2));
  EXPECT_NEAR(difference(parts, {gabled(), box(12, 1.6, 1.4), box(16, 1.6, 1.4)}), 0, 0.15);
  for (const std::size_t d : {1U, 2U}) {
    EXPECT_NEAR(geometry::area(model::polygon_of(parts[d].plan)), 1.6 * 1.4 / 0.9, 0.8);
    EXPECT_NEAR(parts[d].plan.cap, 5 + 0.9 * 0.8 + 1.4, 0.15);
  }
}

TEST(Dormers, that_a_scan_melts_are_found_where_they_are) {
  // Low ones, 1.4 m wide, on a flat slope and 0.5 m behind the eaves: a scan shows half of their height.
  constexpr double slope = 0.5, front = 0.5, high = 1.2;
  const double eaves = 5 + slope * front + high;
  std::vector<Plan> seen{plan(house, {roof(5, slope), wall(5), roof(5, slope), wall(5)}, 12)};
  for (const double x : {12.0, 15.3, 18.6})
    seen.push_back(plan(rectangle(x, 20 + front, 1.4, high / slope), std::vector<Profile>(4, wall(eaves)), eaves));
  const auto refined = refine::refine(std::vector{flat_draft(house, 6)}, melted(seen), options_at(0.25), {});
  ASSERT_THAT(refined.parts, SizeIs(4));
  for (std::size_t d = 1; d < 4; ++d) {
    const auto box = geometry::bounds(refined.parts[d].plan.outer.points);
    EXPECT_NEAR(box.most.x - box.least.x, 1.4, 0.35);
    EXPECT_NEAR(box.least.y, 20 + front, 0.4);
    EXPECT_NEAR(refined.parts[d].plan.cap, eaves, 0.3);
  }
}

TEST(Dormers, leave_one_face_of_the_slope_around_and_behind_them) {
  const auto parts = refined({gabled(), box(12, 1.6, 1.4), box(16, 1.6, 1.4)});
  ASSERT_THAT(parts, SizeIs(3));
  std::size_t slopes = 0, loops = 0;
  for (const auto& face : parts[0].raised.solid.faces)
    if (face.normal.z > 0.1) ++slopes, loops += face.loops.size();
  EXPECT_EQ(slopes, 2U);
  EXPECT_EQ(loops, 4U);  // both holes are in one of them
}

TEST(Dormers, that_are_none_leave_the_roof_as_it_is) {
  const auto looked_for = refined({gabled(), box(12, 0.6, 1.4)}),
             not_looked_for = refined({gabled(), box(12, 0.6, 1.4)}, options_at(0));
  ASSERT_THAT(looked_for, SizeIs(1));
  EXPECT_EQ(looked_for[0].plan, not_looked_for[0].plan);
}

TEST(Dormers, are_looked_for_by_default) { EXPECT_THAT(refined({gabled(), box(12, 1.6, 1.4)}, {}), SizeIs(2)); }

TEST(Dormers, cost_what_they_must_explain) {
  EXPECT_THAT(refined({gabled(), box(12, 1.6, 1.4)}, options_at(100)), SizeIs(1));
  EXPECT_THAT(refined({gabled(), box(12, 1.6, 1.4)}, options_at(0)), SizeIs(1));
}

TEST(Dormers, too_narrow_ones_and_plain_roofs_are_none) {
  EXPECT_THAT(refined({gabled()}), SizeIs(1));
  EXPECT_THAT(refined({gabled(), box(12, 0.6, 1.4)}), SizeIs(1));  // a chimney
}

}  // namespace
