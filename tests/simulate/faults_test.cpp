#include "lab/simulate/faults.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "lab/simulate/points.hpp"
#include "mansard/rays/rays.hpp"
#include "simulate/houses.hpp"

namespace mansard::simulate {
namespace {

/// A house of 12 by 10 m, 9 m high, with a fault.
struct Planted {
  Truth truth = test::truth_of({test::house("one", 0, 0, 12, 10, 9)});
  Scan scan = test::scanned(truth, test::clean());
  Fault fault;
  explicit Planted(FaultKind kind, double amount) : fault{0, kind, amount, 0} { plant({fault}, truth, 1, scan); }
  /// z from above; −99 where nothing is seen.
  [[nodiscard]] auto top(geometry::Point2 at) const -> double { return rays::Scene(scan.mesh).top(at).value_or(-99); }
};

TEST(Faults, hide_one_side) {
  const Planted one(FaultKind::unseen, 0.5);
  EXPECT_NEAR(one.top({2, 5}), 9, 0.3);
  EXPECT_EQ(one.top({10, 5}), -99);
  EXPECT_GT(one.top({16, 5}), -1) << "the ground beyond stays";
}

TEST(Faults, put_a_crown_on_the_roof) {
  const Planted one(FaultKind::crown, 0.3);
  double highest = 0;
  for (const auto v : one.scan.mesh.vertices) highest = std::max(highest, v.z);
  EXPECT_GT(highest, 10);
  EXPECT_LT(highest, 14);
}

TEST(Faults, put_a_scaffold_around_the_walls) {
  const Planted one(FaultKind::scaffold, 1.2);
  EXPECT_NEAR(one.top({-0.6, 5}), 9, 0.6);
  EXPECT_NEAR(one.top({-2, 5}), 0, 0.3);
}

TEST(Faults, put_a_crane_above_it) { EXPECT_NEAR(Planted(FaultKind::crane, 8).top({11, 5}), 9, 9) << "boom or roof"; }

TEST(Faults, put_a_deck_on_one_side) {
  const Planted one(FaultKind::deck, 2);
  EXPECT_NEAR(one.top({13, 5}), 6, 0.3);
  EXPECT_NEAR(one.top({-1, 5}), 0, 0.3);
}

TEST(Faults, take_the_building_away) { EXPECT_NEAR(Planted(FaultKind::demolished, 0).top({6, 5}), 0, 0.4); }

TEST(Faults, take_a_storey_off) { EXPECT_NEAR(Planted(FaultKind::lower, 3).top({6, 5}), 6, 0.3); }

TEST(Faults, make_pits) {
  const Planted one(FaultKind::pits, 0.4);
  const rays::Scene scene(one.scan.mesh);
  int deep = 0, all = 0;
  for (double x = 1; x < 11; x += 0.5)
    for (double y = 1; y < 9; y += 0.5) {
      ++all;
      deep += scene.top({x, y}).value_or(0) < 8.5 ? 1 : 0;
    }
  EXPECT_GT(deep, all / 20);
  EXPECT_LT(deep, all / 2);
}

TEST(Faults, draw_the_footprint_elsewhere) {
  const auto truth = test::truth_of({test::house("one", 0, 0, 12, 10, 9)});
  const auto drawn = [&](FaultKind kind, double amount) {
    auto footprints = survey(truth, {0, 0, 0, 0, 0}, 1);
    EXPECT_TRUE(footprints);
    plant({{0, kind, amount, 0}}, truth, *footprints);
    return geometry::bounds(footprints->front().polygons);
  };
  EXPECT_NEAR(drawn(FaultKind::moved, 2).least.x, 2, 1e-9);
  EXPECT_NEAR(drawn(FaultKind::larger, 1.5).most.x, 15, 1e-9);
  EXPECT_NEAR(drawn(FaultKind::smaller, 0.5).least.x, 3, 1e-9);
  EXPECT_GT(drawn(FaultKind::turned, 0.3).most.y, 11);
}

TEST(Faults, thin_points_and_change_their_class) {
  const auto truth = test::truth_of({test::house("one", 0, 0, 12, 10, 9)});
  const auto scan = test::scanned(truth, test::clean());
  const auto count = [&](FaultKind kind, double amount, int classification) {
    auto points = airborne_points(scan, {8, 0, 0}, 1);
    plant({{0, kind, amount, 0}}, truth, 1, points);
    return std::ranges::count(points.points, classification, &formats::CloudPoint::classification);
  };
  EXPECT_NEAR(static_cast<double>(count(FaultKind::sparse, 0.5, 6)), 60, 30);
  EXPECT_NEAR(static_cast<double>(count(FaultKind::classes, 0.5, 67)), 480, 60);
  EXPECT_GT(count(FaultKind::moved, 2, 6), 900) << "which is no fault of points";
}

TEST(Faults, are_drawn_by_the_seed) {
  std::vector<model::Building> houses;
  for (int i = 0; i < 60; ++i) houses.push_back(test::house("h" + std::to_string(i), 20 * i, 0, 20 * i + 10, 10, 6));
  const auto truth = test::truth_of(houses);
  const auto one = faults_of(truth, 0.5, true, true, 7), again = faults_of(truth, 0.5, true, true, 7);
  ASSERT_EQ(one.size(), again.size());
  EXPECT_NEAR(static_cast<double>(one.size()), 30, 12);
  std::set<FaultKind> kinds;
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].amount, again[i].amount);
    kinds.insert(one[i].kind);
  }
  EXPECT_GT(kinds.size(), 7U);
  for (const auto& fault : faults_of(truth, 1, false, false, 7)) {
    EXPECT_NE(fault.kind, FaultKind::classes);
    EXPECT_NE(fault.kind, FaultKind::sparse);
    EXPECT_NE(fault.kind, FaultKind::lower);
  }
  EXPECT_TRUE(faults_of(truth, 0, true, true, 7).empty());
}

TEST(Faults, are_written_down) {
  const auto truth = test::pair_of_houses();
  const auto footprints = survey(truth, {0, 0, 0, 0, 0}, 1);
  ASSERT_TRUE(footprints);
  simulate::Planted planted;
  planted.faults = {{1, FaultKind::moved, 2, 0.5}};
  const auto text = truth_json(truth, *footprints, {}, "test", {}, planted);
  EXPECT_THAT(text, testing::HasSubstr("\"faults\""));
  EXPECT_THAT(text, testing::HasSubstr("\"kind\": \"moved\""));
  EXPECT_THAT(text, testing::HasSubstr("\"building\": \"high\""));
}

}  // namespace
}  // namespace mansard::simulate
