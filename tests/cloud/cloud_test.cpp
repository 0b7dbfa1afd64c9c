// Surfaces of synthetic points whose shape is known, and of Delft.
#include "mansard/cloud/cloud.hpp"
#include "mansard/cloud/density.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "mansard/base/run.hpp"
#include "mansard/ingest/ingest.hpp"
#include "mansard/ingest/model.hpp"

namespace {

using namespace mansard;
using cloud::Sample;
using geometry::Point3;

constexpr std::uint8_t ground = 2, building = 6, other = 1;

/// `density` points/m² over a rectangle, at random places, with the height and class of `what(x, y)`.
template <class What>
auto scatter(double x0, double y0, double x1, double y1, double density, std::uint64_t seed, const What& what)
    -> std::vector<Sample> {
  base::Random random(seed);
  std::vector<Sample> out;
  const auto count = static_cast<std::size_t>((x1 - x0) * (y1 - y0) * density);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = random.uniform(x0, x1), y = random.uniform(y0, y1);
    const std::pair<double, std::uint8_t> at = what(x, y);
    if (!std::isnan(at.first)) out.push_back({{x, y, at.first}, at.second, 1, 1});
  }
  return out;
}

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// A gabled house of 12 × 8 m, with eaves at 5 m and its ridge at 8 m, on ground at 1 m.
auto house(double x, double y) -> std::pair<double, std::uint8_t> {
  if (x < 20 || x > 32 || y < 20 || y > 28) return {1, ground};
  return {8 - 0.75 * std::abs(y - 24), building};
}

struct Made {
  geometry::Mesh mesh;
  cloud::Counts counts;
  std::optional<cloud::Ground> ground;
  std::vector<std::vector<float>> density;  ///< tile by tile
  cloud::StripOverlaps strips;
};

auto surface_of(const std::vector<Sample>& samples, double cell, const cloud::Options& options = {},
                const std::optional<geometry::Box2>& within = {}) -> Made {
  auto surface = cloud::Surface::open(cell, options);
  EXPECT_TRUE(surface);
  (*surface)->add(samples, within);
  Made out;
  std::vector<cloud::GroundTile> grounds;
  for (const auto& tile : (*surface)->tiles()) {
    auto made = (*surface)->make(tile);
    EXPECT_TRUE(made);
    const auto first = static_cast<std::uint32_t>(out.mesh.vertices.size());
    out.mesh.vertices.insert(out.mesh.vertices.end(), made->mesh.vertices.begin(), made->mesh.vertices.end());
    out.mesh.points.insert(out.mesh.points.end(), made->mesh.points.begin(), made->mesh.points.end());
    for (auto t : made->mesh.triangles) out.mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    out.counts.include(made->counts);
    out.density.push_back(made->ground.points);
    out.strips.include(made->strips);
    grounds.push_back(std::move(made->ground));
  }
  out.ground = cloud::join(grounds, options.ground_reach);
  return out;
}

/// z of the highest triangle above or below a place; NaN for none.
auto top(const geometry::Mesh& mesh, double x, double y) -> double {
  double best = none;
  for (const auto& t : mesh.triangles) {
    const auto &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double det = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    if (std::abs(det) < 1e-12) continue;
    const double u = ((x - a.x) * (c.y - a.y) - (c.x - a.x) * (y - a.y)) / det,
                 v = ((b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y)) / det;
    if (u < 0 || v < 0 || u + v > 1) continue;
    const double z = a.z + u * (b.z - a.z) + v * (c.z - a.z);
    if (std::isnan(best) || z > best) best = z;
  }
  return best;
}

/// Triangles in an order of their own, as numbers that can be compared.
auto soup(const geometry::Mesh& mesh) -> std::vector<std::array<double, 9>> {
  std::vector<std::array<double, 9>> all;
  for (const auto& t : mesh.triangles) {
    std::array<Point3, 3> p{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    std::ranges::rotate(p, std::ranges::min_element(p));
    all.push_back({p[0].x, p[0].y, p[0].z, p[1].x, p[1].y, p[1].z, p[2].x, p[2].y, p[2].z});
  }
  std::ranges::sort(all);
  return all;
}

auto square(double x0, double y0, double x1, double y1) -> std::vector<geometry::Polygon> {
  return {{{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}}};
}

TEST(Density, counts_every_point_but_noise_once_whatever_the_tiles) {
  auto samples = scatter(-40, 0, 60, 60, 16, 1, house);
  const auto points = samples.size();
  for (int i = 0; i < 100; ++i) samples.push_back({{1.5, 1.5, 3}, 7, 1, 1});  // noise
  samples.push_back({{5e6, -5e6, 3}, 2, 1, 1});                               // far away: no reason for a large grid
  const auto in_cell = static_cast<double>(std::ranges::count_if(samples, [](const Sample& s) {
    return std::floor(s.position.x) == 3 && std::floor(s.position.y) == 4 && s.classification != 7;
  }));
  for (const double cell : {0.25, 0.5}) {
    auto surface = cloud::Surface::open(cell, {});
    ASSERT_TRUE(surface);
    (*surface)->add(samples, std::nullopt);
    std::vector<cloud::GroundTile> tiles;
    for (const auto& tile : (*surface)->tiles()) tiles.push_back((*surface)->make(tile)->ground);
    const cloud::Density density(std::move(tiles));
    EXPECT_NEAR(*density.over(square(-40, 0, 60, 60), {}) * 6000, static_cast<double>(points), 1e-6);
    EXPECT_EQ(density.over(square(3, 4, 4, 5), {}), in_cell);
    EXPECT_EQ(density.over(square(3 - 1000, 4 + 2000, 4 - 1000, 5 + 2000), {1000, -2000}), in_cell) << "in any frame";
    EXPECT_EQ(density.over(square(3.5, 4, 4, 5), {}), in_cell) << "of the cells that it is in";
    EXPECT_EQ(density.over(square(200, 0, 210, 10), {}), 0) << "no tile";
    EXPECT_EQ(density.over(square(3, 4, 3.01, 4.01), {}), std::nullopt);
    EXPECT_EQ(density.over({}, {}), std::nullopt);
  }
}

TEST(Density, of_several_cells_is_their_mean_by_area) {
  cloud::GroundTile tile;
  tile.x = 8, tile.y = -4, tile.columns = tile.rows = 4;
  tile.points = {4, 8, 0, 0, 4, 8, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  const cloud::Density density({tile});
  EXPECT_EQ(density.over(square(8, -4, 10, -2), {}), 6);
  EXPECT_EQ(density.over(square(8.5, -4, 10, -3), {}), (0.5 * 4 + 8) / 1.5);
  EXPECT_EQ(density.over(square(6, -4, 10, -3), {}), 3) << "nothing west of the tile";
}

TEST(Surface, has_every_point_of_the_classes_once_whatever_the_tiles) {
  auto samples = scatter(0, 0, 150, 60, 4, 3, house);  // more than two tiles of 64 m
  const auto all = samples.size();
  samples.push_back({{25, 24, 30}, 7, 1, 1});      // noise
  samples.push_back({{26, 24, 12}, 5, 1, 1});      // a tree
  samples.push_back({{27, 24, 12}, other, 1, 1});  // unclassified, where classes say what is building
  cloud::Options by_class;
  by_class.buildings = cloud::Buildings::by_class;
  for (const double cell : {0.25, 0.5, 1.0}) {
    auto points = surface_of(samples, cell, by_class).mesh.points;
    ASSERT_EQ(points.size(), all) << cell;
    std::ranges::sort(points);
    std::vector<Point3> expected;
    const auto rounded = [](double v) { return std::floor(v * 4096 + 0.5) / 4096; };
    for (std::size_t i = 0; i < all; ++i) {
      const Point3 p = samples[i].position;
      expected.push_back({rounded(p.x), rounded(p.y), rounded(p.z)});
    }
    std::ranges::sort(expected);
    for (std::size_t i = 0; i < all; ++i) EXPECT_LT(length(points[i] - expected[i]), 0.0005) << i;
  }
}

TEST(Surface, by_shape_has_all_points_but_those_with_another_return_below_them) {
  auto samples = scatter(0, 0, 40, 40, 16, 5, [](double x, double y) {
    return std::pair<double, std::uint8_t>(x > 15 && x < 25 && y > 15 && y < 25 ? 6.0 : 0.0, 0);
  });
  for (double z = 2; z < 4.5; z += 0.1) samples.push_back({{15, 20, z}, 0, 1, 1});  // on a facade
  const auto all = samples.size();
  for (double x = 5; x < 10; x += 0.5) samples.push_back({{x, 20, 4}, 0, 1, 2});  // in a crown
  EXPECT_EQ(surface_of(samples, 0.5).mesh.points.size(), all);
}

TEST(Surface, of_a_gabled_house_has_its_heights_without_bias) {
  const auto made = surface_of(scatter(0, 0, 60, 60, 16, 1, house), 0.5);
  double sum = 0, squares = 0, count = 0;
  for (double x = 21; x < 31; x += 0.37)
    for (double y = 21; y < 27; y += 0.29) {
      const double error = top(made.mesh, x, y) - house(x, y).first;
      sum += error;
      squares += error * error;
      ++count;
    }
  EXPECT_LT(std::abs(sum / count), 0.02);
  EXPECT_LT(std::sqrt(squares / count), 0.06);
  EXPECT_NEAR(top(made.mesh, 10, 10), 1, 1e-9);
}

TEST(Surface, has_vertical_walls_within_a_quarter_of_a_metre_that_face_outward) {
  const auto made = surface_of(scatter(0, 0, 60, 60, 16, 2, house), 0.5);
  double sides = 0, beside = 0;
  for (const auto& t : made.mesh.triangles) {
    const auto &a = made.mesh.vertices[t[0]], &b = made.mesh.vertices[t[1]], &c = made.mesh.vertices[t[2]];
    const auto normal = cross(b - a, c - a);
    const double area = length(normal) / 2;
    if (area < 0.01 || std::abs(normal.z) > 1e-6 * length(normal)) continue;
    const Point3 middle = (1.0 / 3) * (a + b + c);
    const double dx = std::max({20 - middle.x, middle.x - 32, -1e9}), dy = std::max(20 - middle.y, middle.y - 28);
    if (std::abs(std::max(dx, dy)) > 0.35) beside += area;
    // Away from the middle of the house.
    EXPECT_GT(normal.x * (middle.x - 26) / 6 + normal.y * (middle.y - 24) / 4, 0);
    sides += area;
  }
  EXPECT_NEAR(sides, 2 * 12 * 4 + 2 * 8 * 5.5, 30);  // in steps, so longer than the outline
  EXPECT_LT(beside, 0.05 * sides);
}

TEST(Surface, does_not_depend_on_the_order_of_points_nor_on_what_is_far_away) {
  auto samples = scatter(-100, -50, 300, 200, 6, 3, house);
  const auto whole = surface_of(samples, 0.5);
  std::ranges::reverse(samples);
  EXPECT_EQ(soup(surface_of(samples, 0.5).mesh), soup(whole.mesh));
  const geometry::Box2 box{{15, 15}, {40, 40}};
  const auto part = soup(surface_of(samples, 0.5, {}, box).mesh), all = soup(whole.mesh);
  ASSERT_FALSE(part.empty());
  EXPECT_LT(part.size(), all.size());
  EXPECT_TRUE(std::ranges::includes(all, part));
}

TEST(Surface, counts_a_point_that_is_given_twice_once) {
  const auto once = scatter(-20, -20, 150, 80, 8, 12, house);
  auto twice = once;
  twice.insert(twice.end(), once.rbegin(), once.rend());
  twice.insert(twice.end(), once.begin(), once.begin() + 100);
  for (const double cell : {0.0625, 0.5, 1.0}) {
    const auto expected = surface_of(once, cell), made = surface_of(twice, cell);
    EXPECT_LT(expected.counts.repeated, 3U) << "at one place by accident";
    EXPECT_EQ(made.counts.points + made.counts.repeated, twice.size());
    EXPECT_EQ(made.counts.points, expected.counts.points);
    EXPECT_EQ(made.counts.classes, expected.counts.classes);
    EXPECT_EQ(made.mesh.vertices, expected.mesh.vertices);
    EXPECT_EQ(made.mesh.triangles, expected.mesh.triangles);
    EXPECT_EQ(made.mesh.points, expected.mesh.points);
    EXPECT_EQ(made.ground->heights.size(), expected.ground->heights.size());
    EXPECT_EQ(made.density, expected.density);
  }
}

TEST(Surface, counts_points_of_different_classes_or_returns_or_heights_at_one_place_each) {
  std::vector<Sample> samples = scatter(0, 0, 20, 20, 8, 12, house);
  const auto before = samples.size();
  samples.push_back({{5, 5, 1}, ground, 1, 1});
  samples.push_back({{5, 5, 1}, building, 1, 1});
  samples.push_back({{5, 5, 1}, ground, 1, 2});
  samples.push_back({{5, 5, 1.001}, ground, 1, 1});
  samples.push_back({{5, 5, 1}, 7, 1, 1});  // noise counts nowhere
  const auto made = surface_of(samples, 0.5);
  EXPECT_EQ(made.counts.points, before + 4);
  EXPECT_EQ(made.counts.repeated, 0U);
}

TEST(Surface, keeps_of_points_that_are_given_twice_the_strip_with_the_lowest_number) {
  auto samples = scatter(0, 0, 40, 40, 8, 12, house);
  const auto once = samples.size();
  for (auto& s : samples) s.strip = 7;
  for (std::size_t i = 0; i < once; ++i) {
    samples.push_back(samples[i]);
    samples.back().strip = 3;
  }
  const auto made = surface_of(samples, 0.5);
  EXPECT_EQ(made.counts.points, once);
  EXPECT_TRUE(made.strips.pairs().empty());
}

TEST(Surface, of_adjacent_tiles_has_no_gap_and_no_overlap) {
  // Tiles of 128 m: the house is moved onto a corner of four.
  const auto moved = [](double x, double y) { return house(x - 102, y - 104); };
  const auto made = surface_of(scatter(60, 60, 200, 200, 12, 4, moved), 0.5);
  std::map<std::pair<Point3, Point3>, int> edges;
  for (const auto& t : made.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto &a = made.mesh.vertices[t[k]], &b = made.mesh.vertices[t[(k + 1) % 3]];
      if (std::abs(a.x - 128) < 8 && std::abs(a.y - 128) < 8) ++edges[a < b ? std::pair(a, b) : std::pair(b, a)];
    }
  EXPECT_GT(edges.size(), 1000U);
  std::size_t odd = 0;
  for (const auto& [edge, count] : edges)
    odd += count != 2 && std::abs(edge.second.x - 128) < 7 && std::abs(edge.second.y - 128) < 7 ? 1 : 0;
  EXPECT_EQ(odd, 0U) << "of " << edges.size();
}

TEST(Surface, leaves_areas_without_points_open_and_fills_small_gaps_of_one_height) {
  const auto holed = [](double x, double y) -> std::pair<double, std::uint8_t> {
    if (std::hypot(x - 26, y - 22) < 1) return {none, 0};  // in a roof
    if (std::hypot(x - 45, y - 45) < 8) return {none, 0};  // a pond
    return house(x, y);
  };
  const auto made = surface_of(scatter(0, 0, 60, 60, 16, 5, holed), 0.5);
  EXPECT_NEAR(top(made.mesh, 26, 22), house(26, 22).first, 0.15);
  EXPECT_TRUE(std::isnan(top(made.mesh, 45, 45)));
  EXPECT_GT(made.counts.filled, 0U);
}

TEST(Surface, is_without_masts_birds_and_noise) {
  auto samples = scatter(0, 0, 60, 60, 16, 6, house);
  for (double z = 2; z < 30; z += 0.2) samples.push_back({{26, 24, z}, building, 1, 1});
  samples.push_back({{10, 10, 400}, 18, 1, 1});
  samples.push_back({{11, 11, -80}, 7, 1, 1});
  samples.push_back({{none, 0, 0}, building, 1, 1});
  const auto made = surface_of(samples, 0.5);
  for (const auto& v : made.mesh.vertices) {
    EXPECT_LT(v.z, 8.3);
    EXPECT_GT(v.z, 0.9);
  }
}

TEST(Surface, by_class_is_without_trees_and_by_shape_keeps_the_house_beside_them) {
  base::Random random(7);
  for (const bool classified : {true, false}) {
    auto samples = scatter(0, 0, 60, 60, 12, 8, house);
    if (!classified)
      for (auto& s : samples) s.classification = other;
    for (int i = 0; i < 2000; ++i) {  // a crown of 4 m radius, half of whose points have more returns below them
      const double r = 4 * std::sqrt(random.uniform()), angle = random.uniform(0, 6.28);
      const auto returns = static_cast<std::uint8_t>(1 + random.index(3));
      samples.push_back({{45 + r * std::cos(angle), 15 + r * std::sin(angle), random.uniform(5, 12)},
                         other,
                         static_cast<std::uint8_t>(1 + random.index(returns)),
                         returns});
    }
    const auto made = surface_of(samples, 0.5);
    EXPECT_EQ(made.counts.tiles_by_class > 0, classified);
    double high = 0;
    for (const auto& v : made.mesh.vertices)
      if (std::hypot(v.x - 45, v.y - 15) < 5 && v.z > 2) ++high;
    if (classified) {
      EXPECT_EQ(high, 0);
    }
    EXPECT_NEAR(top(made.mesh, 26, 24.5), house(26, 24.5).first, 0.2) << "the house stays";
  }
}

TEST(Surface, puts_a_wall_where_points_are_on_it) {
  // Mobile mapping: a facade at x = 30.1 between cells, and roof and ground beside it.
  auto samples = scatter(0, 0, 60, 60, 30, 9, [](double x, double) -> std::pair<double, std::uint8_t> {
    return x < 30.1 ? std::pair{9.0, building} : std::pair{0.0, ground};
  });
  base::Random random(10);
  for (int i = 0; i < 40000; ++i)
    samples.push_back(
        {{30.1 + 0.01 * random.uniform(), random.uniform(0, 60), random.uniform(0.2, 8.8)}, building, 1, 1});
  const auto made = surface_of(samples, 0.5);
  std::vector<double> places;
  for (const auto& t : made.mesh.triangles) {
    const auto &a = made.mesh.vertices[t[0]], &b = made.mesh.vertices[t[1]], &c = made.mesh.vertices[t[2]];
    if (std::max({a.z, b.z, c.z}) - std::min({a.z, b.z, c.z}) > 5)
      for (const auto& p : {a, b, c}) places.push_back(p.x);
  }
  ASSERT_GT(places.size(), 100U);
  std::ranges::sort(places);
  EXPECT_NEAR(places[places.size() / 2], 30.1, 0.1);
}

TEST(Surface, gives_the_ground_of_class_2_and_continues_it_below_buildings) {
  const auto slope = [](double x, double y) -> std::pair<double, std::uint8_t> {
    const auto at = house(x, y);
    return {at.second == ground ? 1 + 0.05 * x : at.first, at.second};
  };
  const auto made = surface_of(scatter(0, 0, 60, 60, 8, 11, slope), 0.5);
  ASSERT_TRUE(made.ground);
  const auto& g = *made.ground;
  const auto at = [&](double x, double y) {
    return static_cast<double>(
        g.heights[static_cast<std::size_t>(std::floor(y) - static_cast<double>(g.y)) * g.columns +
                  static_cast<std::size_t>(std::floor(x) - static_cast<double>(g.x))]);
  };
  EXPECT_NEAR(at(10.5, 40.5), 1 + 0.05 * 10.5, 0.05);
  EXPECT_NEAR(at(20.5, 24.5), 1 + 0.05 * 20.5, 0.15);  // inside the house, beside its wall
  auto none_of_class_2 = scatter(0, 0, 60, 60, 8, 11, slope);
  for (auto& s : none_of_class_2) s.classification = s.classification == ground ? other : s.classification;
  EXPECT_FALSE(surface_of(none_of_class_2, 0.5).ground);
}

TEST(CellFor, a_density_is_a_power_of_two_with_enough_points) {
  const cloud::Options options;
  EXPECT_EQ(cloud::cell_for(1000, options), 0.25);
  EXPECT_EQ(cloud::cell_for(16, options), 0.5);
  EXPECT_EQ(cloud::cell_for(8, options), 0.5);
  EXPECT_EQ(cloud::cell_for(2, options), 1);  // fewer a cell, rather than cells of 2 m
  EXPECT_EQ(cloud::cell_for(1, options), 2);
  EXPECT_EQ(cloud::cell_for(0.01, options), 2);
  cloud::Options own;
  own.cell = 0.7;
  EXPECT_EQ(cloud::cell_for(16, own), 0.5);
}

namespace fs = std::filesystem;
const fs::path delft = fs::path(MANSARD_DATA) / "delft";

TEST(Clouds, and_footprints_are_a_scene_in_the_crs_of_both) {
  const auto scene = ingest::read_scene({delft / "points.laz"}, delft / "footprints.geojson", {});
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_EQ(scene->frame.crs, "EPSG:28992");
  EXPECT_GT(scene->mesh.triangles.size(), 200'000U);
  EXPECT_TRUE(scene->terrain);
  EXPECT_EQ(scene->inputs.front().sha256.size(), 64U);
  std::size_t told = 0;
  for (const auto& warning : scene->warnings) told += warning.code == "ingest-points-surface" ? 1 : 0;
  EXPECT_EQ(told, 1U);
  for (const auto& footprint : scene->footprints) EXPECT_FALSE(footprint.defect) << footprint.id;
}

TEST(Clouds, in_cells_on_disk_are_the_same_surface) {
  ingest::Options options;
  options.cells_from = 0;
  const auto city = ingest::read_city({delft / "points.laz"}, delft / "footprints.geojson", options);
  ASSERT_TRUE(city) << base::to_string(city.error());
  ASSERT_TRUE(city->cells);
  const auto scene = ingest::read_scene({delft / "points.laz"}, delft / "footprints.geojson", {});
  ASSERT_TRUE(scene);
  EXPECT_EQ(city->scene.mesh_counts.triangles, scene->mesh_counts.triangles);
  EXPECT_EQ(city->scene.frame.origin, scene->frame.origin);
  constexpr double far = 1e6;
  std::vector<Point3> on_disk, in_memory = scene->mesh.points;
  for (const auto& cell : city->cells->cells_in({{-far, -far}, {far, far}})) {
    const auto own = city->cells->load_own(cell);
    ASSERT_TRUE(own);
    on_disk.insert(on_disk.end(), own->points.begin(), own->points.end());
  }
  std::ranges::sort(on_disk);
  std::ranges::sort(in_memory);
  EXPECT_EQ(on_disk, in_memory);
  EXPECT_GT(in_memory.size(), 10'000U);
}

TEST(Clouds, in_degrees_or_feet_become_metres) {
  const fs::path shared = fs::path(MANSARD_SHARED_DATA) / "points/variety";
  if (!fs::exists(shared)) GTEST_SKIP() << "needs " << shared;
  const auto width = [&](const std::string& name, const std::string& crs) {
    ingest::Options options;
    options.crs = crs;
    const auto scene = ingest::read_scene({shared / name}, {}, options);
    EXPECT_TRUE(scene) << name << ": " << base::to_string(scene.error());
    geometry::Box3 box;
    if (scene)
      for (const auto& v : scene->mesh.vertices) box.add(v);
    return box.most - box.least;
  };
  // Nebraska: 60 × 40 US survey feet. EPSG:32104 in the keys, in metres, would make it 60 × 40 m.
  const auto nebraska = width("file_with_both_wkt_and_geotiff_vlrs.las", "EPSG:32614");
  EXPECT_NEAR(nebraska.x * nebraska.y, 60 * 40 * 0.0929, 150);
  const auto degrees = width("epsg_4326.las", "");
  EXPECT_GT(degrees.x, 10);
  EXPECT_LT(degrees.x, 10'000);
}

TEST(Clouds, without_a_point_in_the_box_are_an_error_of_one_line) {
  ingest::Options options;
  options.bbox = {1000, 1000, 1100, 1100};
  const auto scene = ingest::read_scene({delft / "points.laz"}, {}, options);
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().code, "ingest-points-empty");
}

}  // namespace
