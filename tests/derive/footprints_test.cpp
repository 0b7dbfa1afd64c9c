#include "mansard/derive/derive.hpp"
#include "mansard/ingest/ingest.hpp"

#include <gmock/gmock.h>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>

namespace mansard::derive {
namespace {

using geometry::Mesh;
using geometry::Point2;
using geometry::Polygon;
using geometry::Ring;

/// What stands on the ground: a height above it within an outline.
struct Thing {
  Ring outline;
  std::function<double(Point2)> height;
};

using Terrain = std::function<double(Point2)>;

/// A scan from above: a height field with cells of 0.25 m, whose walls therefore lean by so much.
auto scan(double size, const Terrain& terrain, const std::vector<Thing>& things) -> model::Scene {
  constexpr double cell = 0.25;
  const auto count = static_cast<std::uint32_t>(std::lround(size / cell));
  model::Scene scene;
  for (std::uint32_t r = 0; r <= count; ++r)
    for (std::uint32_t c = 0; c <= count; ++c) {
      const Point2 p{c * cell, r * cell};
      double z = terrain(p);
      for (const auto& thing : things)
        if (geometry::contains(thing.outline, p)) z = std::max(z, terrain(p) + thing.height(p));
      scene.mesh.vertices.push_back({p.x, p.y, z});
    }
  for (std::uint32_t r = 0; r < count; ++r)
    for (std::uint32_t c = 0; c < count; ++c) {
      const std::uint32_t v = r * (count + 1) + c;
      scene.mesh.triangles.push_back({v, v + 1, v + count + 2});
      scene.mesh.triangles.push_back({v, v + count + 2, v + count + 1});
    }
  return scene;
}

auto turned(Ring ring, double angle, Point2 about) -> Ring {
  for (auto& p : ring) {
    const Point2 d = p - about;
    p = about + Point2{std::cos(angle) * d.x - std::sin(angle) * d.y, std::sin(angle) * d.x + std::cos(angle) * d.y};
  }
  return ring;
}

auto box(double x0, double y0, double x1, double y1) -> Ring { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }

auto level(double height) {
  return [height](Point2) { return height; };
}
auto flat(Point2) -> double { return 3; }
auto slope(Point2 p) -> double { return 10 + 0.15 * p.x - 0.1 * p.y; }

/// A round crown with leaves that stand 0.8 m out here and there: the same everywhere on every machine.
auto crown(Point2 middle, double radius) -> Thing {
  Ring ring;
  for (int k = 0; k < 24; ++k) {
    const double angle = k * std::numbers::pi / 12;
    ring.push_back(middle + radius * Point2{std::cos(angle), std::sin(angle)});
  }
  return {ring, [middle, radius](Point2 p) {
            const double d = geometry::length(p - middle);
            const auto cell = static_cast<std::uint64_t>(std::lround(p.x * 4) * 7919 + std::lround(p.y * 4) * 104729);
            base::Random random(cell);
            return 5 + std::sqrt(std::max(0.0, radius * radius - d * d)) + random.uniform(-0.8, 0.8);
          }};
}

auto common_area(const Polygon& a, const Polygon& b) -> double {
  const auto common = geometry::intersect(a, b);
  double sum = 0;
  for (const auto& piece : *common) sum += geometry::area(piece);
  return sum;
}

auto overlap(const Polygon& a, const Polygon& b) -> double {
  const double both = common_area(a, b);
  return both / (geometry::area(a) + geometry::area(b) - both);
}

auto drawn(const model::Scene& scene, const Options& options = {}) -> std::vector<model::Footprint> {
  auto result = footprints(scene, options);
  EXPECT_TRUE(result) << result.error().message;
  return result ? result->footprints : std::vector<model::Footprint>{};
}

auto number(const model::Footprint& footprint, const std::string& name) -> double {
  for (const auto& [key, value] : footprint.attributes)
    if (key == name) return std::get<double>(value);
  return NAN;
}

TEST(Footprints, of_a_box_on_level_ground_are_its_four_walls) {
  const auto wall = box(12, 10, 32, 22);
  const auto found = drawn(scan(45, flat, {{wall, level(7)}}));
  ASSERT_EQ(found.size(), 1U);
  const auto& footprint = found.front();
  EXPECT_EQ(footprint.id, "derived-1");
  EXPECT_TRUE(footprint.derived);
  EXPECT_FALSE(footprint.defect);
  ASSERT_EQ(footprint.polygons.size(), 1U);
  ASSERT_EQ(footprint.polygons[0].outer.size(), 4U);
  for (const Point2 corner : footprint.polygons[0].outer) {
    double nearest = 1e9;
    for (const Point2 p : wall) nearest = std::min(nearest, geometry::length(p - corner));
    EXPECT_LT(nearest, 0.5);
  }
  EXPECT_NEAR(number(footprint, "ms_derived_height"), 7, 0.1);
  EXPECT_GT(number(footprint, "ms_derived_planes"), 0.8);
  EXPECT_EQ(footprint.attributes.front(), (std::pair<std::string, model::Value>{"ms_derived", true}));
}

TEST(Footprints, of_houses_on_a_slope_leave_the_slope_and_the_trees_out) {
  const auto gable = [](Point2 p) { return 5 + 3 - std::abs(p.y - 16) * 0.5; };
  const auto first = box(10, 10, 26, 22), second = box(44, 34, 58, 44);
  const auto scene =
      scan(70, slope, {{first, gable}, {second, level(4)}, crown({30, 50}, 5), crown({60, 15}, 4), crown({29, 16}, 4)});
  const auto found = drawn(scene);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_GT(overlap(found[0].polygons[0], {first, {}}), 0.85);
  EXPECT_GT(overlap(found[1].polygons[0], {second, {}}), 0.9);
  Options rough;
  rough.smooth = 0;
  EXPECT_EQ(drawn(scene, rough).size(), 4U);  // the third crown touches the first house
}

TEST(Footprints, of_a_turned_l_have_six_corners_and_its_directions) {
  constexpr double angle = 17 * std::numbers::pi / 180;
  const auto wall = turned({{15, 15}, {39, 15}, {39, 25}, {26, 25}, {26, 38}, {15, 38}}, angle, {25, 25});
  const auto found = drawn(scan(55, flat, {{wall, level(6)}}));
  ASSERT_EQ(found.size(), 1U);
  const auto& outer = found[0].polygons[0].outer;
  EXPECT_EQ(outer.size(), 6U);
  EXPECT_GT(overlap(found[0].polygons[0], {wall, {}}), 0.94);
  for (std::size_t i = 0; i < outer.size(); ++i) {
    const Point2 side = outer[(i + 1) % outer.size()] - outer[i];
    const double off = std::remainder(std::atan2(side.y, side.x) - angle, std::numbers::pi / 2);
    EXPECT_LT(std::abs(off), 0.02) << "side " << i;
  }
}

TEST(Footprints, keep_a_courtyard_and_close_a_shaft) {
  const Thing house{box(10, 10, 40, 36), [](Point2 p) {
                      const bool court = p.x > 18 && p.x < 30 && p.y > 18 && p.y < 28;
                      const bool shaft = p.x > 34 && p.x < 37 && p.y > 20 && p.y < 23;
                      return court || shaft ? 0.0 : 9.0;
                    }};
  const auto found = drawn(scan(50, flat, {house}));
  ASSERT_EQ(found.size(), 1U);
  ASSERT_EQ(found[0].polygons[0].holes.size(), 1U);
  const auto& hole = found[0].polygons[0].holes[0];
  EXPECT_EQ(hole.size(), 4U);
  EXPECT_NEAR(-geometry::signed_area(hole), 120, 12);
}

TEST(Footprints, part_a_tower_from_what_it_stands_on_and_share_the_wall) {
  const auto tower = box(20, 20, 34, 34);
  const std::vector<Thing> things{{box(10, 20, 50, 34), level(5)}, {tower, level(25)}};
  const auto scene = scan(60, flat, things);
  const auto found = drawn(scene);
  ASSERT_EQ(found.size(), 3U);  // the low building goes on at both sides of the tower
  double area = 0;
  for (const auto& one : found) area += geometry::area(one.polygons[0]);
  EXPECT_NEAR(area, 40 * 14, 40);
  for (std::size_t a = 0; a < found.size(); ++a)
    for (std::size_t b = a + 1; b < found.size(); ++b)
      EXPECT_LT(common_area(found[a].polygons[0], found[b].polygons[0]), 1e-6);
  double best = 0;
  for (const auto& one : found) best = std::max(best, overlap(one.polygons[0], {tower, {}}));
  EXPECT_GT(best, 0.9);

  Options whole;
  whole.step = 0;
  EXPECT_EQ(drawn(scene, whole).size(), 1U);
}

TEST(Footprints, are_numbered_from_north_west_to_south_east) {
  const auto found = drawn(scan(60, flat, {{box(40, 8, 52, 18), level(5)}, {box(8, 40, 20, 50), level(5)}}));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].id, "derived-1");
  EXPECT_LT(found[0].polygons[0].outer[0].x, 30);
  EXPECT_EQ(found[1].id, "derived-2");
}

TEST(Footprints, stand_on_the_terrain_that_is_given) {
  // A plateau that fills the scan: no ground is to be seen anywhere.
  auto scene = scan(40, flat, {{box(-1, -1, 41, 41), level(6)}});
  EXPECT_EQ(footprints(scene, {}).error().code, "derive-nothing");
  model::HeightGrid ground;
  ground.centre = {0, 0};
  ground.cell = 40;
  ground.columns = ground.rows = 2;
  ground.values = {3, 3, 3, 3};
  scene.terrain = std::make_shared<const model::HeightGrid>(ground);
  const auto found = drawn(scene);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(geometry::area(found[0].polygons[0]), 1600, 30);
  EXPECT_NEAR(number(found[0], "ms_derived_height"), 6, 0.1);
}

TEST(Footprints, are_the_same_at_any_number_of_threads) {
  const auto scene =
      scan(70, slope, {{box(10, 10, 26, 22), level(6)}, {box(30, 34, 58, 44), level(4)}, crown({30, 50}, 5)});
  base::limit_threads(1);
  const auto one = drawn(scene);
  base::limit_threads(0);
  const auto many = drawn(scene);
  ASSERT_EQ(one.size(), many.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].polygons, many[i].polygons);
    EXPECT_EQ(one[i].attributes, many[i].attributes);
  }
}

TEST(Footprints, fail_with_a_reason) {
  EXPECT_EQ(footprints(scan(30, slope, {}), {}).error().code, "derive-nothing");
  EXPECT_EQ(footprints({}, {}).error().code, "derive-nothing");
  model::Scene wide;
  wide.mesh.vertices = {{0, 0, 0}, {1e6, 0, 0}, {0, 1e6, 0}};
  wide.mesh.triangles = {{0, 1, 2}};
  EXPECT_EQ(footprints(wide, {}).error().code, "derive-size");
  base::Cancel cancel;
  cancel.request();
  base::Run run;
  run.cancel = &cancel;
  EXPECT_EQ(footprints(scan(30, flat, {{box(5, 5, 20, 20), level(5)}}), {}, run).error().code, "cancelled");
}

/// m² of what both cover, over what one of them does, of the drawn footprint that suits it best.
auto best_overlap(const model::Footprint& known, const std::vector<model::Footprint>& found) -> double {
  double best = 0;
  for (const auto& one : found) best = std::max(best, overlap(known.polygons[0], one.polygons[0]));
  return best;
}

TEST(Footprints, of_the_hall_cover_what_was_drawn_by_hand) {
  const std::filesystem::path data = MANSARD_DATA;
  auto scene = ingest::read_scene({data / "hall"}, data / "hall" / "footprints.geojson", {});
  ASSERT_TRUE(scene) << scene.error().message;
  std::vector<Polygon> known;
  for (const auto& footprint : scene->footprints)
    known.insert(known.end(), footprint.polygons.begin(), footprint.polygons.end());
  scene->footprints.clear();
  const auto found = drawn(*scene);
  ASSERT_EQ(found.size(), 1U);
  double both = 0, either = geometry::area(found[0].polygons[0]);
  for (const auto& polygon : known) {
    both += common_area(found[0].polygons[0], polygon);
    either += geometry::area(polygon);
  }
  EXPECT_GT(both / (either - both), 0.93);
}

TEST(Footprints, of_seven_storey_slabs_are_near_those_drawn_by_hand) {
  const std::filesystem::path data = std::filesystem::path(MANSARD_SHARED_DATA) / "zhongshan";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "no shared data";
  ingest::Options options;
  options.crs = "local";
  auto scene = ingest::read_scene({data / "zhongshan_A_L19.ply"}, data / "zhongshan_A_footprints.geojson", options);
  ASSERT_TRUE(scene) << scene.error().message;
  const auto known = std::move(scene->footprints);
  scene->footprints.clear();
  const auto found = drawn(*scene);
  ASSERT_EQ(known.size(), 8U);
  double sum = 0;
  for (const auto& one : known) {
    const double overlap = best_overlap(one, found);
    EXPECT_GT(overlap, 0.8) << one.id;
    sum += overlap;
  }
  EXPECT_GT(sum / 8, 0.88);
}

TEST(Footprints, of_the_campus_are_its_building_and_its_sheds_and_no_trees) {
  const std::filesystem::path mesh = std::filesystem::path(MANSARD_SHARED_DATA) / "campus" / "campus_2tiles.ply";
  if (!std::filesystem::exists(mesh)) GTEST_SKIP() << "no shared data";
  const auto scene = ingest::read_scene({mesh}, {}, {});
  ASSERT_TRUE(scene) << scene.error().message;
  const auto found = drawn(*scene);
  EXPECT_THAT(found.size(), ::testing::AllOf(::testing::Ge(3U), ::testing::Le(6U)));
  double largest = 0;
  for (const auto& one : found) largest = std::max(largest, geometry::area(one.polygons[0]));
  EXPECT_NEAR(largest, 1170, 60);
}

}  // namespace
}  // namespace mansard::derive
