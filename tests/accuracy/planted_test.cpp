// What was planted in simulated scans is measured: a table of all combinations.
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <random>
#include <utility>

#include "lab/simulate/points.hpp"
#include "mansard/accuracy/accuracy.hpp"
#include "simulate/houses.hpp"

namespace mansard::accuracy {
namespace {

using geometry::Point2;

/// Six large houses, gabled and flat, apart from each other.
auto town() -> simulate::Truth {
  std::vector<model::Building> houses;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 2; ++j) {
      const double x = 34 * i, y = 26 * j;
      houses.push_back(test::house("h" + std::to_string(2 * i + j), x, y, x + 24, y + 16, 7 + i, j == 0 ? 4 : 0));
    }
  return test::truth_of(std::move(houses));
}

auto outlines_of(const simulate::Truth& truth) -> std::vector<geometry::Polygon> {
  std::vector<geometry::Polygon> out;
  for (const auto& building : truth.city.buildings)
    out.insert(out.end(), building.footprint.begin(), building.footprint.end());
  return out;
}

auto exact() -> simulate::ScanOptions {
  auto options = test::clean();
  options.exact = true;
  return options;
}

auto nothing_but(double noise, double length, double resolution, double blur) -> simulate::ScanOptions {
  simulate::ScanOptions o;
  o.noise = noise, o.noise_length = length, o.resolution = resolution, o.melt = blur, o.noise_hidden = 0;
  o.bulge = o.holes = o.missing_walls = o.trees = o.cars = o.chimneys = o.ground_waves = o.seam = 0;
  o.margin = 8;
  return o;
}

/// One number as it was planted and as it was measured.
class Table {
 public:
  void compare(const char* what, double planted, double measured) {
    const bool good = std::abs(measured - planted) <= 0.2 * planted;
    std::printf(" | %s %.3f %.3f%s", what, planted, measured, good ? "" : " !");
    ++count_;
    if (!good) ++wrong_;
    EXPECT_NEAR(measured, planted, 0.4 * planted) << what;
  }
  void end() {
    std::printf("\n");
    ++rows_;
  }
  ~Table() { std::printf("%d combinations, %d numbers, %d of them off by more than a fifth\n", rows_, count_, wrong_); }
  [[nodiscard]] auto rows() const -> int { return rows_; }
  /// Of all numbers, those within a fifth.
  [[nodiscard]] auto share() const -> double { return 1 - static_cast<double>(wrong_) / count_; }

 private:
  int rows_ = 0, count_ = 0, wrong_ = 0;
};

TEST(Accuracy, of_planted_scans_is_measured_within_a_fifth) {  // guarantee 3
  const auto truth = town();
  const auto surface = simulate::surface_of(truth.city);
  ASSERT_TRUE(surface);
  const auto outline = outlines_of(truth);
  Table table;
  std::uint64_t seed = 1;
  for (const double noise : {0.03, 0.06, 0.1})
    for (const double length : {1.25, 1.75, 2.25})
      for (const double blur : {0.4, 0.5})
        for (const double resolution : {0.25, 0.3}) {
          auto scan = simulate::scan(*surface, nothing_but(noise, length, resolution, blur), seed);
          ASSERT_TRUE(scan);
          const double angle = 0.7 * static_cast<double>(seed++);
          const Point2 offset = 0.3 * Point2{std::cos(angle), std::sin(angle)};
          for (auto& v : scan->mesh.vertices) v.x += offset.x, v.y += offset.y;
          const auto found = measure(scan->mesh, rays::Scene(scan->mesh), outline);
          table.compare("noise", noise, found.noise);
          table.compare("area", simulate::correlated_area(length, resolution), found.correlated_area);
          table.compare("spacing", resolution, found.spacing);
          table.compare("blur", blur, found.blur);
          table.compare("offset", 0.3, geometry::dot(found.offset, offset) / 0.3);
          EXPECT_LT(geometry::length(found.offset - offset), 0.06);
          table.end();
        }
  // Points: independent noise, on an exact surface.
  const auto exact = simulate::scan(*surface, accuracy::exact(), 1);
  ASSERT_TRUE(exact);
  for (const double noise : {0.02, 0.03, 0.05, 0.1})
    for (const double density : {3.0, 5.0, 8.0, 14.0, 20.0, 40.0}) {
      const auto cloud = simulate::airborne_points(*exact, {density, noise, 0}, seed++);
      std::vector<geometry::Point3> roofs;
      for (const auto& p : cloud.points)
        if (p.classification == 6) roofs.push_back(p.position);
      const auto found = noise_of(std::move(roofs));
      table.compare("noise", noise, found.noise);
      table.compare("area", 1 / density, found.correlated_area);
      table.compare("spacing", 1 / std::sqrt(density), found.spacing);
      table.end();
    }
  // Coarse meshes: the noise of a vertex is its own.
  for (const double noise : {0.03, 0.06, 0.1})
    for (const double resolution : {0.8, 1.0, 1.3, 1.6}) {
      const auto scan = simulate::scan(*surface, nothing_but(noise, 0, resolution, 0), seed++);
      ASSERT_TRUE(scan);
      const auto found = measure(scan->mesh, rays::Scene(scan->mesh), outline);
      table.compare("noise", noise, found.noise);
      table.compare("spacing", resolution, found.spacing);
      table.end();
    }
  EXPECT_GE(table.rows(), 72);
  EXPECT_GE(table.share(), 0.98);
}

TEST(Accuracy, of_a_cloud_with_a_stray_at_the_origin_of_its_crs_is_that_without) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.03);
  std::vector<geometry::Point3> roof;
  for (int x = 0; x < 40; ++x)
    for (int y = 0; y < 40; ++y) roof.push_back({84800 + 0.4 * x, 447400 + 0.4 * y, 10 + noise(random)});
  const auto without = noise_of(roof);
  EXPECT_NEAR(without.noise, 0.03, 0.006);
  roof.push_back({0, 0, 0});
  EXPECT_EQ(noise_of(roof).noise, without.noise);
}

TEST(Accuracy, what_a_plane_leaves_of_noise_is_that_of_the_quadrature) {
  // docs/accuracy.md: radius over correlation length, share of the variance.
  constexpr std::pair<double, double> known[]{{0.25, 0.0005}, {0.5, 0.0067}, {1, 0.073},
                                              {2, 0.373},     {4, 0.745},    {8, 0.921}};
  model::Accuracy scan;
  scan.noise = 1, scan.correlated_area = 2 * std::numbers::pi * 1.7 * 1.7;
  for (const auto& [ratio, share] : known)
    EXPECT_NEAR(scan.off_plane(1.7 * ratio), std::sqrt(share), 0.08 * std::sqrt(share)) << ratio;
}

TEST(Accuracy, of_exact_models_is_none) {  // guarantee 2
  const auto truth = town();
  const auto scan = test::scanned(truth, exact());
  const auto found = measure(scan.mesh, rays::Scene(scan.mesh), outlines_of(truth));
  EXPECT_EQ(found.noise, 0);
  EXPECT_EQ(found.blur, 0);
  EXPECT_LT(found.edge_noise, 0.005);
  EXPECT_LT(found.offset_spread, 0.005);
  EXPECT_LT(geometry::length(found.offset), 0.005);
  EXPECT_GT(found.walls, 0.95);
  EXPECT_GT(found.windows, 0U);
}

/// A house with a steep foot below a flatter roof, and little ground, as city models have them: a disc anywhere on it
/// holds several faces.
auto house_of_few_triangles() -> geometry::Mesh {
  geometry::Mesh mesh;
  const auto quad = [&](geometry::Point3 a, geometry::Point3 b, geometry::Point3 c, geometry::Point3 d) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {a, b, c, d});
    mesh.triangles.insert(mesh.triangles.end(), {{first, first + 1, first + 2}, {first, first + 2, first + 3}});
  };
  const auto ring = [](double inset, double z) {
    return std::array<geometry::Point3, 4>{
        {{inset, inset, z}, {9 - inset, inset, z}, {9 - inset, 12 - inset, z}, {inset, 12 - inset, z}}};
  };
  const std::array rings{ring(-3, 0), ring(0, 0), ring(0, 6), ring(1.2, 7.4), ring(2.4, 7.9), ring(3.6, 9.3)};
  for (std::size_t k = 0; k + 1 < rings.size(); ++k)
    for (std::size_t i = 0; i < 4; ++i)
      quad(rings[k][i], rings[k][(i + 1) % 4], rings[k + 1][(i + 1) % 4], rings[k + 1][i]);
  return mesh;
}

TEST(Accuracy, of_a_house_of_few_triangles_is_none) {  // guarantee 2
  const auto mesh = house_of_few_triangles();
  const std::vector<geometry::Polygon> outline{{{{0, 0}, {9, 0}, {9, 12}, {0, 12}}, {}}};
  const auto found = measure(mesh, rays::Scene(mesh), outline);
  EXPECT_GT(found.windows, 0U);
  EXPECT_LT(found.noise, 1e-6);
  EXPECT_GT(found.transects, 0U);
  EXPECT_EQ(found.blur, 0);
  EXPECT_LT(found.edge_noise, 1e-3);
}

TEST(Accuracy, does_not_depend_on_order_or_frame) {  // guarantee 1
  const auto truth = town();
  const auto scan = test::scanned(truth, nothing_but(0.06, 2, 0.3, 0.3));
  const auto outline = outlines_of(truth);
  const auto found = measure(scan.mesh, rays::Scene(scan.mesh), outline);
  auto turned = scan.mesh;
  std::ranges::reverse(turned.triangles);
  const auto same = measure(turned, rays::Scene(turned), outline);
  auto moved = scan.mesh;
  for (auto& v : moved.vertices) v.x += 1024, v.y -= 512, v.z += 64;
  auto there = outline;
  for (auto& polygon : there)
    for (auto& p : polygon.outer) p.x += 1024, p.y -= 512;
  const auto shifted = measure(moved, rays::Scene(moved), there);
  for (const auto& other : {same, shifted}) {
    EXPECT_EQ(other.noise, found.noise);
    EXPECT_EQ(other.correlated_area, found.correlated_area);
    EXPECT_EQ(other.spacing, found.spacing);
    EXPECT_EQ(other.blur, found.blur);
    EXPECT_EQ(other.edge_noise, found.edge_noise);
    EXPECT_EQ(other.walls, found.walls);
  }
}

/// Every height the mean of those around it, three times, with an error of its own after that.
auto rounded(geometry::Mesh mesh, double noise) -> geometry::Mesh {
  for (int round = 0; round < 3; ++round) {
    std::vector<double> sum(mesh.vertices.size(), 0), count(mesh.vertices.size(), 0);
    for (const auto& t : mesh.triangles)
      for (const auto v : t)
        for (const auto w : t) sum[v] += mesh.vertices[w].z, count[v] += 1;
    for (std::size_t v = 0; v < sum.size(); ++v) mesh.vertices[v].z = sum[v] / std::max(1.0, count[v]);
  }
  std::mt19937 random(7);
  std::normal_distribution<double> error(0, noise);
  for (auto& v : mesh.vertices) v.z += error(random);
  return mesh;
}

/// In one half, one vertex of many.
auto without_some(geometry::Mesh mesh, double from) -> geometry::Mesh {
  constexpr double wide = 4;  // m
  std::map<std::pair<double, double>, std::uint32_t> kept;
  std::vector<std::uint32_t> now(mesh.vertices.size());
  for (std::uint32_t v = 0; v < now.size(); ++v) {
    const auto p = mesh.vertices[v];
    now[v] = p.x < from ? v : kept.try_emplace({std::floor(p.x / wide), std::floor(p.y / wide)}, v).first->second;
  }
  for (auto& t : mesh.triangles)
    for (auto& v : t) v = now[v];
  std::erase_if(mesh.triangles, [](const auto& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  return mesh;
}

TEST(Accuracy, takes_the_vertices_of_a_height_field_for_points_where_each_has_an_error_of_its_own) {
  const auto truth = town();
  const auto outline = outlines_of(truth);
  const auto point_area = [&](const geometry::Mesh& mesh) {
    return measure(mesh, rays::Scene(mesh), outline).point_area;
  };
  for (const double spacing : {0.3, 0.5, 1.0}) {
    auto field = nothing_but(0.03, 0, spacing, 0);
    field.height_field = true;
    const auto scan = test::scanned(truth, field);
    EXPECT_NEAR(point_area(scan.mesh), spacing * spacing, 0.5 * spacing * spacing) << spacing;
    if (spacing < 1) {  // what is rounded over more than two metres is not seen as an edge
      EXPECT_EQ(point_area(rounded(scan.mesh, 0.03)), 0) << spacing;
    }
    EXPECT_EQ(point_area(without_some(scan.mesh, 40)), 0) << spacing;  // placed where it bends
  }
  auto correlated = nothing_but(0.03, 3, 0.3, 0);
  correlated.height_field = true;
  EXPECT_EQ(point_area(test::scanned(truth, correlated).mesh), 0);
  EXPECT_EQ(point_area(test::scanned(truth, nothing_but(0.03, 0, 0.3, 0)).mesh), 0);  // with walls
  EXPECT_EQ(point_area(test::scanned(truth, exact()).mesh), 0);
}

/// A box whose footprint is drawn 0.2 m too far on one side: an offset and a common distance suit three walls of four.
TEST(Accuracy, of_few_walls_has_the_error_of_few_walls) {
  const auto truth = test::truth_of({test::house("a", 0, 0, 10, 12, 6)});
  const auto scan = test::scanned(truth, exact());
  const std::vector<geometry::Polygon> outline{{{{-0.2, 0}, {10, 0}, {10, 12}, {-0.2, 12}}, {}}};
  const auto found = measure(scan.mesh, rays::Scene(scan.mesh), outline);
  ASSERT_EQ(found.edges, 4U);
  EXPECT_GT(found.offset_spread, 0.03);
  EXPECT_LT(found.offset_spread, 0.2);
  EXPECT_GT(found.offset_error, 0.03);
}

TEST(Accuracy, takes_what_is_given_instead_of_measuring_it) {
  const auto truth = town();
  const auto scan = test::scanned(truth, exact());
  Options options;
  options.noise = 0.07, options.correlated_area = 3, options.blur = 0.2, options.offset_x = 0.5,
  options.edge_noise = 0.03;
  const auto found = measure(scan.mesh, rays::Scene(scan.mesh), outlines_of(truth), options);
  EXPECT_EQ(found.noise, 0.07);
  EXPECT_EQ(found.correlated_area, 3);
  EXPECT_EQ(found.blur, 0.2);
  EXPECT_EQ(found.edge_noise, 0.03);
  EXPECT_EQ(found.offset.x, 0.5);
  EXPECT_LT(std::abs(found.offset.y), 0.005);
}

TEST(Accuracy, of_blocks_is_combined_by_what_each_was_measured_from) {
  model::Accuracy a, b, none;
  a.noise = 0.02, a.windows = 500, a.transects = 200, a.blur = 0, a.edges = 10, a.offset = {0.1, 0},
  a.offset_error = 0.01;
  b.noise = 0.5, b.windows = 20, b.transects = 10, b.blur = 0.7, b.edges = 4, b.offset = {2, 0}, b.offset_error = 1;
  none.noise = 9;
  const std::vector all{b, none, a};
  const auto found = combined(all);
  EXPECT_EQ(found.noise, 0.02);
  EXPECT_EQ(found.blur, 0);
  EXPECT_EQ(found.windows, 520U);
  EXPECT_NEAR(found.offset.x, 0.1, 0.01);
}

TEST(Accuracy, is_told_in_the_terms_of_the_field) {
  model::Accuracy scan;
  EXPECT_EQ(in_a_sentence(scan), "nothing could be measured");
  scan.noise = 0.031, scan.correlated_area = 0.05, scan.spacing = 0.22, scan.windows = 400;
  EXPECT_EQ(
      in_a_sentence(scan),
      "noise 0.031 m (RMSE in height on level surfaces; within the ASPRS vertical accuracy class of 5 cm, apart from "
      "an offset in height); correlated area 0.05 m²; nominal point spacing 0.22 m");
}

}  // namespace
}  // namespace mansard::accuracy
