// Scans that have the faces of the truth themselves.
#include <gmock/gmock.h>
#include <cmath>

#include "mansard/rays/rays.hpp"
#include "simulate/houses.hpp"

namespace mansard::simulate {
namespace {

using geometry::Point2;
using geometry::Point3;
using test::area_of;
using test::scanned;

auto exact() -> ScanOptions {
  auto options = test::clean();
  options.exact = true;
  return options;
}

TEST(ExactScan, is_what_the_preset_clean_asks_for) {
  Options options;
  auto list = option_list(options);
  for (const auto& [key, value] : presets().front().values) ASSERT_TRUE(list.find(key.substr(9))->set(value)) << key;
  EXPECT_EQ(presets().front().name, "clean");
  EXPECT_TRUE(keeps_faces(options.scan));
}

TEST(ExactScan, has_the_faces_that_can_be_seen_and_level_ground) {  // guarantee 4
  const auto scan = scanned(test::pair_of_houses(), exact());
  EXPECT_NEAR(area_of(scan, Class::roof), 240, 1e-6);
  // 34 m of walls each, and 3 m of the higher house above the lower one.
  EXPECT_NEAR(area_of(scan, Class::wall), 34 * 6 + 34 * 9 + 10 * 3, 1e-6);
  EXPECT_NEAR(area_of(scan, Class::ground), 48 * 34 - 240, 1e-6);
  for (const auto v : scan.mesh.vertices)
    EXPECT_LT(std::min({std::abs(v.z), std::abs(v.z - 6), std::abs(v.z - 9)}), 1e-9) << v.z;
  for (std::size_t t = 0; t < scan.classes.size(); ++t) {
    const auto n = normalised(test::across(scan.mesh, scan.mesh.triangles[t]));
    EXPECT_NEAR(n.z, scan.classes[t] == Class::wall ? 0 : 1, 1e-9);
    EXPECT_EQ(scan.buildings[t] == Scan::none, scan.classes[t] == Class::ground);
  }
  EXPECT_EQ(scan.planted.noise, 0);
  EXPECT_EQ(scan.planted.spacing, 0);
  EXPECT_EQ(scan.planted.blur, 0);
}

TEST(ExactScan, has_ground_that_meets_the_feet_of_the_buildings) {
  auto high = test::house("high", 30.3, 0.7, 40, 10, 6);
  high.parts[0].plan.base = 4;
  const auto scan = scanned(test::truth_of({test::house("low", 0.1, 0.2, 10.3, 9.9, 6), high}), exact());
  std::size_t feet = 0;
  for (std::size_t t = 0; t < scan.classes.size(); ++t) {
    if (scan.classes[t] != Class::ground) continue;
    for (const auto corner : scan.mesh.triangles[t]) {
      const auto v = scan.mesh.vertices[corner];
      const bool by_low =
          v.x > 0 && v.x < 10.4 && v.y > 0.1 && v.y<10, by_high = v.x> 30.2 && v.x < 40.1 && v.y > 0.6 && v.y < 10.1;
      if (by_low || by_high) {
        EXPECT_EQ(v.z, by_low ? 0 : 4);
      }
      feet += by_low || by_high ? 1 : 0;
    }
  }
  EXPECT_GT(feet, 50U);
}

TEST(ExactScan, of_every_kind_of_block_has_the_heights_of_the_truth_from_above) {
  for (const auto kind : {Kind::terrace, Kind::perimeter, Kind::courtyard, Kind::towers, Kind::detached}) {
    const auto block = make_block(kind, {}, 3);
    ASSERT_TRUE(block);
    const auto surface = surface_of(block->city);
    const auto scan = scanned(*block, exact());
    const rays::Scene truth(surface->mesh), seen(scan.mesh);
    const auto box = geometry::Box2::of(scan.mesh.vertices);
    base::Random random(1);
    std::size_t roofs = 0, holes = 0;
    for (int i = 0; i < 5000; ++i) {
      const Point2 p{random.uniform(box.least.x, box.most.x), random.uniform(box.least.y, box.most.y)};
      const auto there = truth.top(p), here = seen.top(p);
      holes += here ? 0 : 1;
      if (!there || !here) continue;
      EXPECT_NEAR(*here, *there, 1e-4) << to_string(kind) << " " << p.x << " " << p.y;
      ++roofs;
    }
    EXPECT_EQ(holes, 0U) << to_string(kind);
    EXPECT_GT(roofs, 300U) << to_string(kind);
  }
}

TEST(ExactScan, is_sampled_where_noise_losses_or_objects_are_asked_for) {
  auto options = exact();
  EXPECT_TRUE(keeps_faces(options));
  for (double ScanOptions::*const member :
       {&ScanOptions::melt, &ScanOptions::noise, &ScanOptions::bulge, &ScanOptions::holes, &ScanOptions::missing_walls,
        &ScanOptions::seam, &ScanOptions::trees, &ScanOptions::cars, &ScanOptions::chimneys, &ScanOptions::crowns,
        &ScanOptions::roof_trees}) {
    auto other = options;
    other.*member = 0.1;
    EXPECT_FALSE(keeps_faces(other));
  }
  options.melt = 0.2;
  auto sampled = options;
  sampled.exact = false;
  EXPECT_EQ(ply(scanned(test::pair_of_houses(), options), {}), ply(scanned(test::pair_of_houses(), sampled), {}));
}

TEST(ExactScan, has_the_same_bytes_at_any_thread_count) {  // guarantee 3
  const auto block = make_block(Kind::terrace, {}, 1);
  std::vector<std::string> bytes;
  for (const std::size_t threads : {1, 2}) {
    base::limit_threads(threads);
    bytes.push_back(ply(scanned(*block, exact()), {}));
  }
  base::limit_threads(0);
  EXPECT_EQ(bytes[0], bytes[1]);
}

}  // namespace
}  // namespace mansard::simulate
