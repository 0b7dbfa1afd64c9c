#include <gmock/gmock.h>
#include <map>
#include <set>

#include "mansard/rays/rays.hpp"
#include "simulate/houses.hpp"

namespace mansard::simulate {
namespace {

using geometry::Point3;
using test::area_of;
using test::clean;
using test::scanned;

TEST(Scan, of_a_clean_box_has_its_heights_to_a_centimetre) {  // guarantee 1
  const auto scan = scanned(test::truth_of({test::house("a", 0, 0, 12, 10, 6)}), clean());
  std::size_t roofs = 0, grounds = 0;
  for (const auto v : scan.mesh.vertices) {
    const bool inside = v.x > 0.5 && v.x < 11.5 && v.y > 0.5 && v.y < 9.5;
    const bool outside = v.x < -0.5 || v.x > 12.5 || v.y < -0.5 || v.y > 10.5;
    if (!inside && !outside) continue;
    EXPECT_NEAR(v.z, inside ? 6 : 0, 0.01);
    ++(inside ? roofs : grounds);
  }
  EXPECT_GT(roofs, 500U);
  EXPECT_GT(grounds, 5000U);
}

TEST(Scan, of_a_clean_box_has_its_walls_to_three_centimetres) {
  const auto scan = scanned(test::truth_of({test::house("a", 0, 0, 12.13, 10, 6)}), clean());
  std::size_t seen = 0;
  for (const auto v : scan.mesh.vertices) {
    if (v.z < 0.5 || v.z > 5.5 || v.y < 1 || v.y > 9 || v.x < 6) continue;
    EXPECT_NEAR(v.x, 12.13, 0.03);
    ++seen;
  }
  EXPECT_GT(seen, 200U);
}

TEST(Scan, follows_turned_walls_and_sloped_roofs_within_the_resolution) {  // guarantee 1
  auto block = make_block(Kind::terrace, {}, 4);
  ASSERT_TRUE(block);
  auto options = clean();
  options.resolution = 0.4;
  const auto scan = scanned(*block, options);
  const auto surface = surface_of(block->city);
  const rays::Scene truth(surface->mesh);
  std::size_t looked_at = 0;
  for (std::size_t t = 0; t < scan.classes.size(); t += 7) {
    if (scan.classes[t] != Class::roof) continue;
    const auto p = test::centre(scan.mesh, scan.mesh.triangles[t]);
    // The nearest roof of the truth by rays along the axes: no further than the resolution.
    double nearest = 1e9;
    for (const Point3 way : {Point3{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}})
      if (const auto hit = truth.cast(p, way)) nearest = std::min(nearest, hit->distance);
    EXPECT_LT(nearest, options.resolution);
    ++looked_at;
  }
  EXPECT_GT(looked_at, 500U);
}

TEST(Scan, calls_nothing_ground_that_hangs_from_a_tree) {
  auto options = clean();
  options.height_field = true;
  options.resolution = 0.35;
  options.trees = 40;
  options.margin = 25;
  const auto scan = scanned(test::truth_of({test::house("a", 0, 0, 12, 10, 6)}), options);
  double hanging = 0, ground = 0;
  for (std::size_t t = 0; t < scan.classes.size(); ++t) {
    const auto across = test::across(scan.mesh, scan.mesh.triangles[t]);
    const double area = length(across) / 2, z = test::centre(scan.mesh, scan.mesh.triangles[t]).z;
    const auto p = test::centre(scan.mesh, scan.mesh.triangles[t]);
    const bool by_house = p.x > -1 && p.x < 13 && p.y > -1 && p.y < 11;
    if (z > 0.6) {
      EXPECT_NE(scan.classes[t], Class::ground) << p.x << " " << p.y << " " << p.z;
      if (!by_house && across.z < area) hanging += scan.classes[t] == Class::other ? area : 0;
    } else if (scan.classes[t] == Class::ground) {
      ground += area;
    }
  }
  EXPECT_GT(hanging, 100);
  EXPECT_GT(ground, 1000);
}

TEST(Scan, without_noise_is_labelled_as_its_geometry_says) {
  const auto scan = scanned(test::truth_of({test::house("a", 0, 0, 12, 10, 6, 3)}), clean());
  std::map<Class, std::size_t> right, all;
  for (std::size_t t = 0; t < scan.classes.size(); ++t) {
    const auto p = test::centre(scan.mesh, scan.mesh.triangles[t]);
    const auto n = normalised(test::across(scan.mesh, scan.mesh.triangles[t]));
    // Triangles at an edge are rounded and may be either.
    const bool ground = p.z < 0.3 && n.z > 0.9, wall = std::abs(n.z) < 0.3 && p.z > 0.5, roof = n.z > 0.6 && p.z > 5.9;
    if (ground + wall + roof != 1) continue;
    const auto expected = ground ? Class::ground : wall ? Class::wall : Class::roof;
    ++all[expected];
    right[expected] += scan.classes[t] == expected ? 1 : 0;
    EXPECT_EQ(scan.buildings[t] == 0, scan.classes[t] == Class::wall || scan.classes[t] == Class::roof);
  }
  for (const auto kind : {Class::wall, Class::roof, Class::ground}) {
    EXPECT_GT(all[kind], 1000U) << to_string(kind);
    EXPECT_GE(static_cast<double>(right[kind]), 0.99 * static_cast<double>(all[kind])) << to_string(kind);
  }
}

TEST(Scan, shows_nothing_of_the_wall_between_two_houses) {
  const auto scan = scanned(test::pair_of_houses(), clean());
  // Below the lower roof, away from the outer walls: only the higher house's wall above 6 m stands at x = 12.
  for (const auto v : scan.mesh.vertices)
    EXPECT_FALSE(v.z > 0.5 && v.z < 5.5 && v.x > 0.5 && v.x < 23.5 && v.y > 0.5 && v.y < 9.5) << v.x << " " << v.y;
  const double exposed =
      area_of(scan, Class::wall, [](Point3 p) { return std::abs(p.x - 12) < 0.3 && p.y > 1 && p.y < 9 && p.z < 8.7; });
  EXPECT_NEAR(exposed, 8 * 2.7, 2.5);
}

TEST(Scan, is_closed_but_for_its_border) {
  const auto scan = scanned(*make_block(Kind::courtyard, {}, 2), clean());
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const auto& t : scan.mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto a = t[i], b = t[(i + 1) % 3];
      uses[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  geometry::Box2 box;
  for (const auto v : scan.mesh.vertices) box.add(xy(v));
  std::size_t open = 0;
  for (const auto& [edge, balance] : uses) {
    if (balance == 0) continue;
    ++open;
    for (const auto v : {edge.first, edge.second}) {
      const auto p = scan.mesh.vertices[v];
      const double inside = std::min({p.x - box.least.x, box.most.x - p.x, p.y - box.least.y, box.most.y - p.y});
      ASSERT_LT(inside, 2.5 * clean().resolution);
    }
  }
  EXPECT_GT(open, 100U);
}

/// The heights over the middle of a large flat roof, less 6 m.
auto roof_errors(const ScanOptions& options, std::uint64_t seed) -> std::vector<double> {
  std::vector<double> errors;
  for (const auto v : scanned(test::truth_of({test::house("a", 0, 0, 60, 60, 6)}), options, seed).mesh.vertices)
    if (v.x > 3 && v.x < 57 && v.y > 3 && v.y < 57) errors.push_back(v.z - 6);
  return errors;
}

auto root_mean_square(const std::vector<double>& values) -> double {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

TEST(Scan, has_noise_of_the_asked_amplitude) {
  auto options = clean();
  options.resolution = 0.5;
  for (const double noise : {0.05, 0.2}) {
    options.noise = noise;
    options.noise_length = 2;
    const auto errors = roof_errors(options, 3);
    ASSERT_GT(errors.size(), 5000U);
    EXPECT_NEAR(root_mean_square(errors), noise, 0.1 * noise);
  }
}

TEST(Scan, has_noise_that_neighbours_share) {
  auto options = clean();
  options.resolution = 0.5;
  options.noise = 0.1;
  const auto roughness = [&](double wavelength) {
    options.noise_length = wavelength;
    const auto scan = scanned(test::truth_of({test::house("a", 0, 0, 40, 40, 6)}), options);
    std::vector<double> steps;
    for (const auto& t : scan.mesh.triangles) {
      const auto a = scan.mesh.vertices[t[0]], b = scan.mesh.vertices[t[1]];
      if (a.z > 5 && a.x > 3 && a.x < 37 && a.y > 3 && a.y < 37) steps.push_back(a.z - b.z);
    }
    return root_mean_square(steps);
  };
  EXPECT_LT(3 * roughness(8), roughness(1.5));
}

TEST(Scan, melts_edges_the_more_the_more_is_asked) {
  const auto truth = test::truth_of({test::house("a", 0, 0, 12, 10, 6)});
  const auto highest_at_corner = [&](double melt) {
    auto options = clean();
    options.melt = melt;
    double high = 0;
    for (const auto v : scanned(truth, options).mesh.vertices)
      if (std::abs(v.x) < 0.3 && std::abs(v.y) < 0.3) high = std::max(high, v.z);
    return high;
  };
  const double sharp = highest_at_corner(0), soft = highest_at_corner(0.3), softer = highest_at_corner(0.8);
  EXPECT_NEAR(sharp, 6, 0.3);
  EXPECT_LT(soft, sharp - 0.05);
  EXPECT_LT(softer, soft - 0.3);
}

TEST(Scan, loses_the_asked_share_of_walls_to_holes) {  // guarantee 2
  const auto truth = test::pair_of_houses();
  auto options = clean();
  const double whole = area_of(scanned(truth, options), Class::wall);
  for (const double share : {0.05, 0.3}) {
    options.holes = share;
    EXPECT_NEAR(1 - area_of(scanned(truth, options), Class::wall) / whole, share, 0.01);
  }
}

TEST(Scan, loses_walls_to_holes_low_down_first) {
  const auto truth = test::pair_of_houses();
  auto options = clean();
  const auto part = [&](double low, double high) {
    return area_of(scanned(truth, options), Class::wall, [&](Point3 p) { return p.z > low && p.z < high; });
  };
  const double low = part(0, 3), high = part(3, 6);
  options.holes = 0.25;
  EXPECT_LT(part(0, 3) / low, part(3, 6) / high - 0.1);
}

TEST(Scan, lacks_the_lower_part_of_walls_that_were_not_matched) {
  const auto truth = test::truth_of({test::house("a", 0, 0, 60, 40, 15)});
  auto options = clean();
  options.resolution = 0.5;
  const auto walls = [&](double low, double high) {
    return area_of(scanned(truth, options), Class::wall, [&](Point3 p) { return p.z > low && p.z < high; });
  };
  const double whole = walls(-1, 16);
  options.missing_walls = 1;
  options.missing_share = 0.6;
  EXPECT_NEAR(1 - walls(-1, 16) / whole, 0.6, 0.04);
  EXPECT_LT(walls(-1, 5), 0.01 * whole);  // 9 m and what a ragged border may keep below
  options.missing_share = 1;
  EXPECT_LT(walls(-1, 14), 0.01 * whole);
  options.missing_walls = 0;
  EXPECT_NEAR(walls(-1, 16), whole, 1e-6);
}

TEST(Scan, stands_on_ground_that_follows_the_feet_of_the_buildings) {
  auto high = test::house("high", 30, 0, 40, 10, 6);
  high.parts[0].plan.base = 4;
  const auto scan = scanned(test::truth_of({test::house("low", 0, 0, 10, 10, 6), high}), clean());
  for (const auto v : scan.mesh.vertices) {
    const bool before = v.y < -0.8 && v.y > -1.2;
    if (before && v.x > 2 && v.x < 8) {
      EXPECT_NEAR(v.z, 0, 0.3);
    }
    if (before && v.x > 32 && v.x < 38) {
      EXPECT_NEAR(v.z, 4, 0.3);
    }
    EXPECT_TRUE(v.z > -0.5 && v.z < 10.5);
  }
}

TEST(Scan, has_trees_and_cars_as_other_on_open_ground) {
  auto options = clean();
  options.trees = options.cars = 30;
  const auto scan = scanned(test::truth_of({test::house("a", 0, 0, 12, 10, 6)}), options);
  EXPECT_GT(area_of(scan, Class::other), 50);
  // Crowns of up to 3.2 m, not nearer than 1.5 m to a wall, reach over its eaves.
  EXPECT_EQ(area_of(scan, Class::other, [](Point3 p) { return p.x > 2 && p.x < 10 && p.y > 2 && p.y < 8; }), 0);
}

TEST(Scan, is_torn_at_the_borders_of_tiles) {
  auto options = clean();
  options.seam = 0.1;
  options.tile = 7;
  const auto truth = test::truth_of({test::house("a", 0, 0, 12, 10, 6)});
  const auto whole = scanned(truth, clean()), torn = scanned(truth, options);
  EXPECT_EQ(torn.mesh.triangles.size(), whole.mesh.triangles.size());
  EXPECT_GT(torn.mesh.vertices.size(), whole.mesh.vertices.size() + 100);
  std::set<double> heights;
  for (std::size_t t = 0; t < torn.classes.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto step = torn.mesh.vertices[torn.mesh.triangles[t][i]] - whole.mesh.vertices[whole.mesh.triangles[t][i]];
      ASSERT_LE(std::max({std::abs(step.x), std::abs(step.y), std::abs(step.z)}), 0.1 + 1e-9);
      heights.insert(std::round(step.z * 1e6));
    }
  EXPECT_GE(heights.size(), 16U);  // 36 × 34 m in tiles of 7 m
}

TEST(Scan, as_a_height_field_has_one_height_per_place) {
  auto options = clean();
  options.height_field = true;
  const auto scan = scanned(test::truth_of({test::house("a", 0, 0, 12, 10, 6, 3)}), options);
  for (const auto& t : scan.mesh.triangles) EXPECT_GT(test::across(scan.mesh, t).z, 0);
  for (const auto v : scan.mesh.vertices) {
    const bool inside = v.x > 0.1 && v.x < 11.9 && v.y > 0.1 && v.y < 9.9;
    const bool outside = v.x < -0.1 || v.x > 12.1 || v.y < -0.1 || v.y > 10.1;
    if (inside || outside) {
      EXPECT_NEAR(v.z, inside ? 9 - 0.6 * std::abs(v.y - 5) : 0, 0.01);
    }
  }
}

TEST(Scan, has_the_same_bytes_at_any_thread_count) {  // guarantee 3
  const auto block = make_block(Kind::terrace, {}, 1);
  for (const bool flat : {false, true}) {
    ScanOptions options;
    options.resolution = 0.5;
    options.height_field = flat;
    std::vector<std::string> bytes;
    for (const std::size_t threads : {1, 2, 2}) {
      base::limit_threads(threads);
      bytes.push_back(ply(scanned(*block, options, 7), {}));
    }
    base::limit_threads(0);
    EXPECT_EQ(bytes[0], bytes[1]);
    EXPECT_EQ(bytes[1], bytes[2]);
    EXPECT_NE(bytes[0], ply(scanned(*block, options, 8), {}));
  }
}

TEST(Scan, gives_up_without_triangles_and_with_too_many_cells) {
  const auto nothing = simulate::scan({}, {}, 1);
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().code, "simulate-nothing");
  const auto truth =
      test::truth_of({test::house("a", 0, 0, 12, 10, 6), test::house("b", 1e5, 1e5, 1e5 + 10, 1e5 + 10, 6)});
  const auto large = simulate::scan(*surface_of(truth.city), clean(), 1);
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().code, "simulate-size");
}

TEST(Scan, stops_on_request) {
  base::Cancel cancel;
  cancel.request();
  base::Run run;
  run.cancel = &cancel;
  const auto stopped = simulate::scan(*surface_of(test::pair_of_houses().city), {}, 1, run);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, "cancelled");
}

}  // namespace
}  // namespace mansard::simulate
