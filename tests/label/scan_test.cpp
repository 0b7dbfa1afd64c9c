#include "mansard/label/scan.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mansard/base/run.hpp"

namespace {

using mansard::geometry::Mesh;
using mansard::geometry::Point3;
using mansard::label::label_by_normal;
using mansard::label::label_scan;
using mansard::model::ModelSurface;
using mansard::model::SurfaceClass;

constexpr auto wall = SurfaceClass::wall, roof = SurfaceClass::roof, ground = SurfaceClass::ground,
               other = SurfaceClass::other;

/// A scan, and what each of its triangles is.
struct Scene {
  Mesh mesh;
  std::vector<SurfaceClass> truth;

  /// The parallelogram at `corner` in pieces of at most half a metre, looking to cross(u, v).
  void add(Point3 corner, Point3 u, Point3 v, SurfaceClass kind) {
    const auto pieces = [](Point3 side) { return static_cast<std::uint32_t>(std::ceil(length(side) / 0.5)); };
    const std::uint32_t m = pieces(u), n = pieces(v), first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (std::uint32_t j = 0; j <= n; ++j)
      for (std::uint32_t i = 0; i <= m; ++i)
        mesh.vertices.push_back(corner + (static_cast<double>(i) / m) * u + (static_cast<double>(j) / n) * v);
    for (std::uint32_t j = 0; j < n; ++j)
      for (std::uint32_t i = 0; i < m; ++i) {
        const std::uint32_t at = first + j * (m + 1) + i;
        mesh.triangles.push_back({at, at + 1, at + m + 2});
        mesh.triangles.push_back({at, at + m + 2, at + m + 1});
        truth.insert(truth.end(), 2, kind);
      }
  }
  /// Sides and top of a box; they look outwards.
  void add_box(Point3 least, Point3 size, SurfaceClass sides, SurfaceClass top) {
    const Point3 x{size.x, 0, 0}, y{0, size.y, 0}, z{0, 0, size.z};
    add(least, x, z, sides);
    add(least + x, y, z, sides);
    add(least + x + y, -1 * x, z, sides);
    add(least + y, -1 * y, z, sides);
    add(least + z, x, y, top);
  }
};

/// A level field with a box of 10 × 8 × 6 on it.
auto field_with_house() -> Scene {
  Scene scene;
  for (const auto& [x, y, w, d] : {std::array{-20.0, -20.0, 50.0, 20.0},
                                   {-20.0, 8.0, 50.0, 20.0},
                                   {-20.0, 0.0, 20.0, 8.0},
                                   {10.0, 0.0, 20.0, 8.0}})
    scene.add({x, y, 0}, {w, 0, 0}, {0, d, 0}, ground);
  scene.add_box({0, 0, 0}, {10, 8, 6}, wall, roof);
  return scene;
}

auto model_of(double east = 10, double top = 6) -> ModelSurface {
  Scene box;
  box.add_box({0, 0, -1}, {east, 8, top + 1}, wall, roof);
  box.add({0, 0, -1}, {0, 8, 0}, {east, 0, 0}, ground);
  ModelSurface surface;
  surface.mesh = box.mesh;
  surface.classes = box.truth;
  surface.buildings.assign(box.truth.size(), 0);
  surface.parts = surface.faces = surface.buildings;
  return surface;
}

/// The share of the area with the right class.
auto right(const Scene& scene, const std::vector<SurfaceClass>& given) -> double {
  const auto area = mansard::label::confusion_of(scene.mesh, scene.truth, given);
  double sum = 0, all = 0;
  for (std::size_t t = 0; t < area.size(); ++t)
    for (std::size_t g = 0; g < area.size(); ++g) {
      all += area[t][g];
      sum += t == g ? area[t][g] : 0;
    }
  return sum / all;
}

TEST(Label_scan, is_right_everywhere_on_a_scan_of_the_model_itself) {
  const auto scene = field_with_house();
  EXPECT_EQ(label_scan(scene.mesh, model_of()), scene.truth);
}

TEST(Label_scan, follows_the_model_within_reach_and_no_further) {
  auto scene = field_with_house();
  EXPECT_GT(right(scene, label_scan(scene.mesh, model_of(10.6))), 0.99);  // the east wall is 0.6 m off
  const auto far = label_scan(scene.mesh, model_of(12));
  std::size_t lost = 0;
  for (std::size_t t = 0; t < far.size(); ++t) lost += scene.truth[t] == wall && far[t] == other ? 1 : 0;
  EXPECT_GT(lost, 100U);  // of the 384 triangles of the east wall, those near the other walls and the ground are near
}

TEST(Label_scan, calls_bushes_and_cars_other) {
  auto scene = field_with_house();
  const auto first = scene.truth.size();
  scene.add_box({15, 2, 0.8}, {3, 3, 2}, other, other);
  const auto given = label_scan(scene.mesh, model_of());
  for (std::size_t t = first; t < given.size(); ++t) EXPECT_EQ(given[t], other);
  // The trivial rule has no other: its sides are walls.
  EXPECT_EQ(label_by_normal(scene.mesh)[first], wall);
}

TEST(Label_scan, finds_the_ground_of_a_slope) {
  Scene scene;
  for (const double x : {-40.0, 10.0})
    scene.add({x, -20, 0.15 * x}, {x < 0 ? 40.0 : 30.0, 0, x < 0 ? 6.0 : 4.5}, {0, 40, 0}, ground);
  EXPECT_GT(right(scene, label_scan(scene.mesh, model_of(10, 20))), 0.99);
}

TEST(Label_scan, prefers_the_surface_that_looks_the_same_way) {
  // 30 cm inside the east wall and 40 cm under the roof's edge: nearer to the wall, but level like the roof.
  Scene scene;
  scene.add({9.6, 3, 5.7}, {0.2, 0, 0}, {0, 0.2, 0}, roof);
  EXPECT_EQ(label_scan(scene.mesh, model_of()).front(), roof);
  EXPECT_EQ(label_scan(scene.mesh, model_of(), {.turned = 0}).front(), wall);
}

TEST(Label_scan, takes_upright_surfaces_for_walls_where_the_model_has_a_steep_roof) {
  // A wall of which the model made a roof of 63°: its nearest face is the roof, but it is vertical.
  Scene model;
  model.add({0, 0, 0}, {8, 0, 0}, {0, 0, 3}, wall);
  model.add({0, 0, 3}, {8, 0, 0}, {0, 1, 2}, roof);
  ModelSurface surface;
  surface.mesh = model.mesh;
  surface.classes = model.truth;
  surface.buildings.assign(model.truth.size(), 0);
  surface.parts = surface.faces = surface.buildings;
  Scene scene;
  scene.add({2, 0.35, 3.6}, {2, 0, 0}, {0, 0, 0.2}, wall);
  EXPECT_EQ(right(scene, label_scan(scene.mesh, surface)), 1);
  EXPECT_EQ(right(scene, label_scan(scene.mesh, surface, {.upright = 0})), 0);
  // What is as steep as the roof of the model is that roof.
  Scene mansard;
  mansard.add({2, 0.4, 3.8}, {2, 0, 0}, {0, 0.2, 0.4}, roof);
  EXPECT_EQ(right(mansard, label_scan(mansard.mesh, surface)), 1);
}

TEST(Label_scan, judges_the_direction_without_the_noise_of_a_scan) {
  // A wall of small triangles that lean by 30° to and fro, up to the edge of a roof.
  // One sheet: scans share their vertices.
  Mesh sheet;
  for (int i = 0; i <= 40; ++i)
    for (const double x : {2.0, 2.2}) sheet.vertices.push_back({x, i % 2 == 0 ? 0.30 : 0.3115, 5.18 + 0.02 * i});
  for (std::uint32_t i = 0; i < 40; ++i) {
    sheet.triangles.push_back({2 * i, 2 * i + 1, 2 * i + 3});
    sheet.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 2});
  }
  const auto count = [&](const mansard::label::ScanOptions& options) {
    std::size_t walls = 0;
    for (const auto c : label_scan(sheet, model_of(), options)) walls += c == wall ? 1 : 0;
    return walls;
  };
  EXPECT_LT(count({.even_out = 0}), count({}));
}

TEST(Label_scan, never_takes_the_models_ground_for_a_wall_or_a_roof) {
  auto model = model_of();
  model.classes.assign(model.classes.size(), ground);
  Scene scene;
  scene.add({2, 2, 5.9}, {3, 0, 0}, {0, 3, 0}, roof);
  scene.add({-9, 2, 0}, {3, 0, 0}, {0, 3, 0}, ground);
  const auto given = label_scan(scene.mesh, model);
  EXPECT_EQ(given.front(), other);
  EXPECT_EQ(given.back(), ground);
}

TEST(Label_scan, is_the_same_at_one_and_two_threads) {
  const auto scene = field_with_house();
  mansard::base::limit_threads(1);
  const auto one = label_scan(scene.mesh, model_of(10.3, 6.2));
  mansard::base::limit_threads(2);
  const auto two = label_scan(scene.mesh, model_of(10.3, 6.2));
  mansard::base::limit_threads(0);
  EXPECT_EQ(one, two);
}

TEST(Label_by_normal, knows_walls_by_their_slope_and_roofs_by_their_height) {
  const auto scene = field_with_house();
  EXPECT_EQ(label_by_normal(scene.mesh), scene.truth);
  Scene low;
  low.add({-20, -20, 0}, {60, 0, 0}, {0, 60, 0}, ground);
  low.add_box({0, 0, 0}, {10, 8, 2}, wall, roof);
  EXPECT_LT(right(low, label_by_normal(low.mesh)), 1);  // a shed of two metres is too low for it
}

TEST(Confusion, sums_areas_by_true_and_given_class) {
  const Mesh mesh{{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const auto area = mansard::label::confusion_of(mesh, std::vector{wall, roof}, std::vector{wall, ground});
  EXPECT_DOUBLE_EQ(area[0][0], 2);
  EXPECT_DOUBLE_EQ(area[1][2], 2);
  EXPECT_DOUBLE_EQ(area[1][1], 0);
}

TEST(Classes_from, are_those_of_the_nearest_triangle) {
  const auto scene = field_with_house();
  EXPECT_EQ(mansard::label::classes_from(scene.mesh, scene.mesh, scene.truth), scene.truth);
  Scene above;
  above.add({0, 0, 9}, {2, 0, 0}, {0, 2, 0}, roof);
  EXPECT_EQ(mansard::label::classes_from(above.mesh, scene.mesh, scene.truth).front(), other);  // 3 m off
}

/// z of a triangle's centre, m.
auto height(const Scene& scene, std::size_t t) -> double {
  double z = 0;
  for (const auto v : scene.mesh.triangles[t]) z += scene.mesh.vertices[v].z / 3;
  return z;
}

TEST(Walls_and_roofs, are_those_of_the_nearest_face_of_a_model) {
  const auto scene = field_with_house();
  const auto given = mansard::label::nearest_wall_or_roof(scene.mesh, model_of());
  const auto above = mansard::label::above_ground(scene.mesh, model_of());
  const auto by_normal = mansard::label::wall_or_roof_by_normal(scene.mesh);
  std::size_t high = 0;
  for (std::size_t t = 0; t < scene.truth.size(); ++t) {
    const double z = height(scene, t);
    EXPECT_EQ(above[t], z > 0.5) << z;
    EXPECT_NE(given[t], ground);
    if (!above[t]) continue;
    EXPECT_EQ(given[t], scene.truth[t]) << z;
    EXPECT_EQ(by_normal[t], scene.truth[t]) << z;
    ++high;
  }
  EXPECT_GT(high, 1000U);
  auto nothing = model_of();
  nothing.classes.assign(nothing.classes.size(), ground);
  EXPECT_EQ(mansard::label::nearest_wall_or_roof(scene.mesh, nothing).front(), other);
}

TEST(Walls_and_roofs, by_the_normal_part_at_fifty_degrees) {
  const auto slope = [](double degrees) {
    Scene one;
    const double angle = degrees * 3.14159265358979 / 180;
    one.add({0, 0, 0}, {1, 0, 0}, {0, std::cos(angle), std::sin(angle)}, roof);
    return mansard::label::wall_or_roof_by_normal(one.mesh).front();
  };
  EXPECT_EQ(slope(49), roof);
  EXPECT_EQ(slope(51), wall);
}

}  // namespace
