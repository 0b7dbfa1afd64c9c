// The terrain meets the ground of every building, follows the heights, and closes with the buildings.
#include "mansard/terrain/terrain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "mansard/base/run.hpp"
#include "mansard/solid/solid.hpp"
#include "mansard/terrain/detail/triangulation.hpp"

namespace mansard::terrain {
namespace {

using geometry::Box2;
using geometry::Point2;
using geometry::Point3;
using Slope = std::function<double(Point2)>;

auto heights_on(const Box2& area, double cell, const Slope& z) -> Heights {
  Heights out;
  auto& grid = out.grid;
  grid.centre = area.least;
  grid.cell = cell;
  grid.columns = static_cast<std::size_t>(std::lround((area.most.x - area.least.x) / cell)) + 1;
  grid.rows = static_cast<std::size_t>(std::lround((area.most.y - area.least.y) / cell)) + 1;
  for (std::size_t j = 0; j < grid.rows; ++j)
    for (std::size_t i = 0; i < grid.columns; ++i)
      grid.values.push_back(
          static_cast<float>(z(area.least + Point2{cell * static_cast<double>(i), cell * static_cast<double>(j)})));
  return out;
}

/// A box-shaped building over a rectangle.
auto box_building(const std::string& id, Box2 plan, double low, double high) -> model::Building {
  const auto [least, most] = plan;
  model::LabelledSolid model;
  for (const double z : {low, high})
    for (const Point2 p : {least, Point2{most.x, least.y}, most, Point2{least.x, most.y}})
      model.solid.vertices.push_back({p.x, p.y, z});
  const auto face = [&](std::vector<std::uint32_t> loop, Point3 normal, model::FaceClass kind) {
    model::Face out;
    out.loops = {std::move(loop)};
    out.normal = normal;
    model.solid.faces.push_back(std::move(out));
    model.classes.push_back(kind);
  };
  face({3, 2, 1, 0}, {0, 0, -1}, model::FaceClass::ground);
  face({4, 5, 6, 7}, {0, 0, 1}, model::FaceClass::roof);
  face({0, 1, 5, 4}, {0, -1, 0}, model::FaceClass::wall);
  face({1, 2, 6, 5}, {1, 0, 0}, model::FaceClass::wall);
  face({2, 3, 7, 6}, {0, 1, 0}, model::FaceClass::wall);
  face({3, 0, 4, 7}, {-1, 0, 0}, model::FaceClass::wall);
  model::Building building{id, {}, {}, low, {}, {}, {}};
  building.solids.push_back({{0}, std::move(model)});
  return building;
}

auto grounds_of(const std::vector<model::Building>& buildings) -> std::vector<Ground> {
  std::vector<Ground> out;
  for (const auto& building : buildings) out.push_back(ground_of(building));
  return out;
}

auto ring_area(const GroundRing& ring) -> std::int64_t {
  std::int64_t twice = 0;
  for (std::size_t i = 0; i < ring.corners.size(); ++i) {
    const auto &a = ring.corners[i], &b = ring.corners[(i + 1) % ring.corners.size()];
    twice += a[0] * b[1] - b[0] * a[1];
  }
  return twice;
}

/// Twice the area of all triangles in plan; −1 where one looks down.
auto covered(const Terrain& terrain) -> std::int64_t {
  std::int64_t twice = 0;
  for (const auto& t : terrain.triangles) {
    const auto &a = terrain.vertices[t[0]], &b = terrain.vertices[t[1]], &c = terrain.vertices[t[2]];
    const auto area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if (area < 0) return -1;
    twice += area;
  }
  return twice;
}

auto covers_the_area_once(const Terrain& terrain, const std::vector<Ground>& grounds) -> bool {
  std::int64_t twice = covered(terrain);
  if (twice < 0) return false;
  for (const auto& ground : grounds)
    for (const auto& ring : ground.rings) twice += ring_area(ring);
  const auto side = [](double from, double to) { return std::llround((to - from) * 1e4); };
  return twice == 2 * side(terrain.area.least.x, terrain.area.most.x) * side(terrain.area.least.y, terrain.area.most.y);
}

/// Whether the triangles below the buildings cover their grounds once, in plan.
auto covers_the_grounds_once(const Terrain& terrain, const std::vector<Ground>& grounds) -> bool {
  std::int64_t twice = 0;
  for (const auto& [a, b, c] : terrain.below) {
    const auto own = detail::twice_area({a[0], a[1]}, {b[0], b[1]}, {c[0], c[1]});
    if (own <= 0) return false;
    twice += own;
  }
  for (const auto& ground : grounds)
    for (const auto& ring : ground.rings) twice -= ring_area(ring);
  return twice == 0;
}

/// Houses of random sizes in rows, some of them touching, some a hair apart, each with its own ground.
auto random_town(std::uint64_t seed, const Slope& z) -> std::vector<model::Building> {
  base::Random random(seed);
  std::vector<model::Building> out;
  for (int row = 0; row < 4; ++row) {
    double x = random.uniform(0, 5);
    for (int i = 0; i < 5; ++i) {
      const auto grid = [](double v) { return std::round(v * 1e4) / 1e4; };
      const double wide = random.uniform(4, 9), deep = random.uniform(6, 10);
      const Box2 plan{{grid(x), grid(row * 15.0)}, {grid(x + wide), grid(row * 15.0 + deep)}};
      const double ground = grid(z({x + wide / 2, row * 15.0 + deep / 2}));
      out.push_back(box_building(std::to_string(row) + "-" + std::to_string(i), plan, ground,
                                 grid(ground + random.uniform(4, 12))));
      const double gap = random.uniform();
      x = plan.most.x + (gap < 0.6 ? 0.0 : gap < 0.8 ? 0.0015 : random.uniform(0.5, 6));
    }
  }
  return out;
}

const Slope hill = [](Point2 p) { return 0.2 * p.x + 2 * std::sin(p.y / 9) + std::cos(p.x / 3); };

TEST(Triangulation, is_delaunay_with_every_edge_that_was_asked_for) {
  using detail::Site;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    base::Random random(seed);
    detail::Triangulation net({0, 0}, {1000, 1000});
    std::vector<std::uint32_t> points;
    // A small grid, so that many points are on edges of others, or on the border.
    for (int i = 0; i < 150; ++i)
      points.push_back(net.insert(
          {static_cast<std::int64_t>(random.index(41)) * 25, static_cast<std::int64_t>(random.index(41)) * 25}));
    std::vector<std::pair<std::uint32_t, std::uint32_t>> fixed;
    for (int i = 0; i < 30; ++i) {
      const auto a = points[random.index(points.size())], b = points[random.index(points.size())];
      if (net.fix(a, b)) fixed.emplace_back(a, b);
    }
    std::int64_t twice = 0;
    for (std::uint32_t t = 0; t < net.triangles().size(); ++t) {
      const auto& triangle = net.triangles()[t];
      const auto area =
          twice_area(net.sites()[triangle.corner[0]], net.sites()[triangle.corner[1]], net.sites()[triangle.corner[2]]);
      EXPECT_GT(area, 0);
      twice += area;
      for (std::size_t i = 0; i < 3; ++i) {
        const auto other = triangle.beyond[i];
        if (other == detail::Triangulation::none) continue;
        EXPECT_NE(std::ranges::find(net.triangles()[other].beyond, t), net.triangles()[other].beyond.end());
      }
    }
    EXPECT_EQ(twice, 2'000'000);
    for (const auto& [a, b] : fixed) {
      // Along the segment, every step is a fixed edge.
      auto at = a;
      for (int step = 0; at != b && step < 100; ++step) {
        auto next = detail::Triangulation::none;
        for (const auto t : net.around(at))
          for (const auto v : net.triangles()[t].corner) {
            const Site p = net.sites()[at], q = net.sites()[b], s = net.sites()[v];
            if (v != at && twice_area(p, q, s) == 0 && (s.x - p.x) * (q.x - p.x) + (s.y - p.y) * (q.y - p.y) > 0)
              if (const auto edge = net.left_of(at, v);
                  edge && net.triangles()[edge->first].fixed[static_cast<std::size_t>(edge->second)])
                next = v;
          }
        ASSERT_NE(next, detail::Triangulation::none);
        at = next;
      }
      EXPECT_EQ(at, b);
    }
  }
}

TEST(Make, meets_the_ground_of_a_building_on_a_slope) {
  const std::vector<model::Building> buildings{box_building("house", {{0, 0}, {10, 8}}, 1, 9)};
  const auto grounds = grounds_of(buildings);
  const Options options;
  const auto area = area_around(grounds, options);
  const auto terrain = make(heights_on(area, 1, [](Point2 p) { return 0.2 * p.x; }), grounds, options);
  ASSERT_TRUE(terrain) << base::to_string(terrain.error());
  const auto found = joints(*terrain, grounds);
  EXPECT_EQ(found.joined, 4U);
  EXPECT_EQ(found.open + found.faults, 0U);
  EXPECT_TRUE(covers_the_area_once(*terrain, grounds));
}

TEST(Make, leaves_out_a_ground_whose_outline_only_touches_the_one_that_it_overlaps) {
  // A wedge of 1.4 cm between two houses belongs to both: its corners are on the other's edge, or at its corner.
  Ground west{"west", {{{{0, 0}, {100'000, 0}, {100'136, 30'000}, {100'000, 50'000}, {0, 50'000}}, {}}}},
      east{"east", {{{{100'000, 0}, {200'000, 0}, {200'000, 50'000}, {100'000, 50'000}}, {}}}};
  west.rings[0].heights.assign(5, 4893);
  east.rings[0].heights.assign(4, 3936);
  const std::vector<Ground> grounds{west, east};
  Options options;
  const auto area = area_around(grounds, options);
  const auto terrain = make(heights_on(area, options.cell, [](Point2) { return 0.4; }), grounds, options);
  ASSERT_TRUE(terrain) << base::to_string(terrain.error());
  ASSERT_EQ(terrain->warnings.size(), 1U);
  EXPECT_EQ(terrain->warnings[0].code, "terrain-overlap");
  EXPECT_EQ(terrain->warnings[0].subject, "east");
}

TEST(Make, is_exact_for_random_towns) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto buildings = random_town(seed, hill);
    const auto grounds = grounds_of(buildings);
    Options options;
    options.cell = 0.5;
    const auto area = area_around(grounds, options);
    const auto heights = heights_on(area, options.cell, hill);
    const auto terrain = make(heights, grounds, options);
    ASSERT_TRUE(terrain) << base::to_string(terrain.error());
    EXPECT_TRUE(terrain->warnings.empty());
    const auto found = joints(*terrain, grounds);
    EXPECT_EQ(found.open, 0U);
    EXPECT_EQ(found.faults, 0U);
    EXPECT_EQ(found.joined + found.split + found.shared, 4 * buildings.size());
    EXPECT_GT(found.joined, 2 * buildings.size());
    EXPECT_TRUE(covers_the_area_once(*terrain, grounds));
    EXPECT_TRUE(covers_the_grounds_once(*terrain, grounds));
  }
}

TEST(Make, is_within_the_tolerance_of_the_heights) {
  const std::vector<model::Building> buildings{box_building("house", {{0, 0}, {10, 8}}, 1, 9)};
  const auto grounds = grounds_of(buildings);
  for (const double tolerance : {0.5, 0.1, 0.02}) {
    Options options;
    options.tolerance = tolerance;
    const auto area = area_around(grounds, options);
    const auto heights = heights_on(area, 1, hill);
    const auto terrain = make(heights, grounds, options);
    ASSERT_TRUE(terrain);
    double worst = 0;
    std::size_t asked = 0;
    for (double y = area.least.y; y <= area.most.y; ++y)
      for (double x = area.least.x; x <= area.most.x; ++x) {
        if (x > -0.5 && x < 10.5 && y > -0.5 && y < 8.5) continue;
        for (const auto& t : terrain->triangles) {
          const auto at = [&](std::size_t i) {
            const auto& v = terrain->vertices[t[i]];
            return Point3{static_cast<double>(v[0]) / 1e4, static_cast<double>(v[1]) / 1e4,
                          static_cast<double>(v[2]) / 1e4};
          };
          const auto a = at(0), b = at(1), c = at(2);
          const double u = cross(xy(c) - xy(b), Point2{x, y} - xy(b)), v = cross(xy(a) - xy(c), Point2{x, y} - xy(c)),
                       w = cross(xy(b) - xy(a), Point2{x, y} - xy(a));
          if (u < 0 || v < 0 || w < 0 || u + v + w <= 0) continue;
          worst = std::max(worst, std::abs((u * a.z + v * b.z + w * c.z) / (u + v + w) - hill({x, y})));
          ++asked;
          break;
        }
      }
    EXPECT_GT(asked, 1000U);
    EXPECT_LE(worst, tolerance + 1e-3);  // heights are single precision, corners on a grid of 0.1 mm
  }
}

TEST(Make, has_few_triangles_where_the_ground_is_flat) {
  const std::vector<model::Building> buildings{box_building("house", {{0, 0}, {10, 8}}, 1, 9)};
  const auto grounds = grounds_of(buildings);
  const Options options;
  const auto terrain = make(heights_on(area_around(grounds, options), 1, [](Point2) { return 1.0; }), grounds, options);
  ASSERT_TRUE(terrain);
  EXPECT_EQ(terrain->triangles.size(), 8U);
}

TEST(Make, leaves_out_a_ground_that_overlaps_another_one) {
  const std::vector<model::Building> buildings{box_building("first", {{0, 0}, {10, 8}}, 1, 9),
                                               box_building("second", {{5, 4}, {15, 12}}, 1, 9)};
  const auto grounds = grounds_of(buildings);
  const Options options;
  const auto terrain = make(heights_on(area_around(grounds, options), 1, [](Point2) { return 1.0; }), grounds, options);
  ASSERT_TRUE(terrain);
  ASSERT_EQ(terrain->warnings.size(), 1U);
  EXPECT_EQ(terrain->warnings.front().code, "terrain-overlap");
  EXPECT_EQ(terrain->warnings.front().subject, "second");
  EXPECT_TRUE(covers_the_area_once(*terrain, {grounds.front()}));
}

TEST(Make, gives_the_same_triangles_again) {
  const auto grounds = grounds_of(random_town(3, hill));
  const Options options;
  const auto heights = heights_on(area_around(grounds, options), 1, hill);
  const auto first = make(heights, grounds, options), second = make(heights, grounds, options);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->vertices, second->vertices);
  EXPECT_EQ(first->triangles, second->triangles);
}

TEST(Make, refuses_an_area_that_its_arithmetic_cannot_hold) {
  std::vector<Ground> grounds{ground_of(box_building("a", {{0, 0}, {10, 8}}, 1, 9)),
                              ground_of(box_building("b", {{60000, 0}, {60010, 8}}, 1, 9))};
  Options options;
  options.cell = 100;
  const auto terrain =
      make(heights_on(area_around(grounds, options), 100, [](Point2) { return 0.0; }), grounds, options);
  ASSERT_FALSE(terrain);
  EXPECT_EQ(terrain.error().code, "terrain-extent");
}

/// Every edge once in each direction.
auto is_closed(const geometry::Mesh& mesh) -> bool {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
  return std::ranges::all_of(edges, [&](const auto& e) {
    const auto back = edges.find({e.first.second, e.first.first});
    return e.second == 1 && back != edges.end();
  });
}

auto volume_of(const geometry::Mesh& mesh) -> double {
  double six = 0;
  for (const auto& t : mesh.triangles) six += dot(mesh.vertices[t[0]], cross(mesh.vertices[t[1]], mesh.vertices[t[2]]));
  return six / 6;
}

TEST(Closed, is_closed_and_holds_ground_and_building) {
  const std::vector<model::Building> buildings{box_building("house", {{0, 0}, {10, 8}}, 1, 9)};
  const Options options;
  const auto area = area_around(grounds_of(buildings), options);
  const auto closed_surface = closed(heights_on(area, 1, [](Point2) { return 1.0; }), buildings, options);
  ASSERT_TRUE(closed_surface) << base::to_string(closed_surface.error());
  EXPECT_TRUE(is_closed(closed_surface->mesh));
  EXPECT_NEAR(volume_of(closed_surface->mesh),
              (area.most.x - area.least.x) * (area.most.y - area.least.y) * options.depth + 10 * 8 * 8, 1e-2);
}

TEST(Closed, is_one_shell_for_rows_of_houses_on_a_slope) {
  std::size_t simplified = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto buildings = random_town(seed, hill);
    Options options;
    const auto area = area_around(grounds_of(buildings), options);
    const auto closed_surface = closed(heights_on(area, 1, hill), buildings, options);
    ASSERT_TRUE(closed_surface) << base::to_string(closed_surface.error());
    EXPECT_TRUE(is_closed(closed_surface->mesh));
    for (const auto& warning : closed_surface->warnings) simplified += warning.code == "terrain-simplified" ? 1 : 0;
  }
  EXPECT_LE(simplified, 4U);  // of about 90 rows
}

/// A union cuts a corner of some millimetres off one of them, which no building has, with a wall too narrow for a
/// plane.
TEST(Closed, keeps_the_roofs_of_houses_that_touch_in_a_corner) {
  for (const double base : {1.0, 1.4})
    for (const double angle : {0.0, 0.3, 1.1}) {
      SCOPED_TRACE(testing::Message() << "ground " << base << ", turned by " << angle);
      std::vector<model::Building> buildings{box_building("a", {{0, 0}, {10, 8}}, 1, 9),
                                             box_building("b", {{10, 8}, {19, 15}}, base, 8),
                                             box_building("c", {{0, 8}, {4, 12}}, base, 7)};
      for (auto& building : buildings)
        for (auto& v : building.solids.front().model.solid.vertices) {
          const double x = v.x * std::cos(angle) - v.y * std::sin(angle),
                       y = v.x * std::sin(angle) + v.y * std::cos(angle);
          v.x = std::round(x * 1e4) / 1e4, v.y = std::round(y * 1e4) / 1e4;
        }
      for (auto& building : buildings)
        for (auto& face : building.solids.front().model.solid.faces)
          face.normal =
              geometry::Point3{face.normal.x * std::cos(angle) - face.normal.y * std::sin(angle),
                               face.normal.x * std::sin(angle) + face.normal.y * std::cos(angle), face.normal.z};
      const Options options;
      const auto area = area_around(grounds_of(buildings), options);
      const auto surface = closed(heights_on(area, 1, [](Point2) { return 1.0; }), buildings, options);
      ASSERT_TRUE(surface) << base::to_string(surface.error());
      EXPECT_TRUE(is_closed(surface->mesh));
      for (const auto& warning : surface->warnings) ADD_FAILURE() << warning.message;
      const auto highest = std::ranges::max_element(surface->mesh.vertices, {}, &geometry::Point3::z);
      EXPECT_NEAR(highest->z, 9, 1e-5);
    }
}

TEST(Closed, gives_a_flat_roof_to_the_solid_that_no_union_can_have_and_keeps_the_others) {
  std::vector<model::Building> buildings;
  const std::vector<double> heights{9, 7, 11, 6, 8};
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double x = 8 * static_cast<double>(i);
    buildings.push_back(box_building(std::to_string(i), {{x, 0}, {x + 8, 8}}, 1, 1 + heights[i]));
  }
  auto& leaning = buildings[2].solids.front().model.solid;  // its front leans out, as no height field does
  for (const std::size_t v : {4U, 5U}) leaning.vertices[v].y -= 1;
  leaning.faces[2].normal = geometry::normalised(Point3{0, -11, -1});
  const Options options;
  const auto area = area_around(grounds_of(buildings), options);
  const auto surface = closed(heights_on(area, 1, [](Point2) { return 1.0; }), buildings, options);
  ASSERT_TRUE(surface) << base::to_string(surface.error());
  EXPECT_TRUE(is_closed(surface->mesh));
  double above = 0;
  for (const double height : heights) above += 8 * 8 * height;
  EXPECT_NEAR(volume_of(surface->mesh),
              (area.most.x - area.least.x) * (area.most.y - area.least.y) * options.depth + above, 1e-2);
  ASSERT_EQ(surface->warnings.size(), 1U);
  EXPECT_EQ(surface->warnings[0].code, "terrain-simplified");
  EXPECT_NE(surface->warnings[0].message.find("1 of 5 solids have flat roofs"), std::string::npos)
      << surface->warnings[0].message;
}

/// Two triangles a cell.
auto sheet(Box2 box, double spacing, const Slope& z) -> geometry::Mesh {
  geometry::Mesh mesh;
  const auto columns = static_cast<std::uint32_t>(std::lround((box.most.x - box.least.x) / spacing)) + 1;
  const auto rows = static_cast<std::uint32_t>(std::lround((box.most.y - box.least.y) / spacing)) + 1;
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const Point2 p = box.least + Point2{spacing * i, spacing * j};
      mesh.vertices.push_back({p.x, p.y, z(p)});
    }
  for (std::uint32_t j = 0; j + 1 < rows; ++j)
    for (std::uint32_t i = 0; i + 1 < columns; ++i) {
      const std::uint32_t a = j * columns + i, b = a + 1, c = a + columns, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  return mesh;
}

TEST(MeshGround, takes_buildings_cars_and_crowns_off) {
  const Slope ground = [](Point2 p) { return 0.1 * p.x + 0.5 * std::sin(p.y / 20); };
  const auto in = [](Point2 p, double x, double y, double wide, double deep) {
    return p.x >= x && p.x <= x + wide && p.y >= y && p.y <= y + deep;
  };
  const auto mesh = sheet({{0, 0}, {80, 80}}, 0.5, [&](Point2 p) {
    double z = ground(p);
    if (in(p, 10, 10, 12, 9)) z += 8;                                                        // with a footprint
    if (in(p, 40, 40, 15, 10)) z += 6;                                                       // without one
    if (in(p, 30, 15, 4.5, 2)) z += 1.5;                                                     // a car
    if (const double r = length(p - Point2{60, 20}); r < 4) z += 3 + std::sqrt(16 - r * r);  // a crown
    return z;
  });
  Options options;
  const Box2 area{{0, 0}, {80, 80}};
  MeshGround finder(area, options);
  finder.add(mesh);
  const std::vector<geometry::Polygon> footprints{{{{10, 10}, {22, 10}, {22, 19}, {10, 19}}, {}}};
  const auto heights = finder.heights(footprints);
  ASSERT_TRUE(heights);
  double worst = 0, worst_open = 0;
  for (double y = 0; y <= 80; ++y)
    for (double x = 0; x <= 80; ++x) {
      const Point2 p{x, y};
      const double off = std::abs(*heights->grid.at(p) - ground(p));
      worst = std::max(worst, off);
      const bool open =
          !in(p, 8, 8, 16, 13) && !in(p, 38, 38, 19, 14) && !in(p, 28, 13, 8, 6) && length(p - Point2{60, 20}) > 6;
      if (open && x > 2 && x < 78 && y > 2 && y < 78) worst_open = std::max(worst_open, off);
    }
  EXPECT_LT(worst_open, 0.01);
  EXPECT_LT(worst, 1.0);  // below objects it is continued from around them
}

TEST(MeshGround, says_that_there_is_no_ground) {
  const MeshGround finder({{0, 0}, {10, 10}}, {});
  const auto heights = finder.heights({});
  ASSERT_FALSE(heights);
  EXPECT_EQ(heights.error().code, "terrain-no-ground");
}

TEST(Heights, are_continued_over_gaps_of_the_terrain_model) {
  model::Scene scene;
  model::HeightGrid grid;
  grid.centre = {-0.5, -0.5};
  grid.columns = grid.rows = 42;
  for (std::size_t j = 0; j < 42; ++j)
    for (std::size_t i = 0; i < 42; ++i)
      grid.values.push_back(i > 15 && i < 22 && j > 15 && j < 22 ? std::nanf("") : 3.0F);
  scene.terrain = std::make_shared<const model::HeightGrid>(grid);
  const auto heights = heights_of(scene, {{0, 0}, {40, 40}}, {});
  ASSERT_TRUE(heights);
  EXPECT_GT(std::ranges::count(heights->known, false), 20);
  for (const float z : heights->grid.values) EXPECT_FLOAT_EQ(z, 3);
}

}  // namespace
}  // namespace mansard::terrain
