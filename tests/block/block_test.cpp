#include "mansard/block/block.hpp"
#include "mansard/ingest/ingest.hpp"

#include <gmock/gmock.h>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <numeric>

#include "mansard/block/detail/near.hpp"
#include "mansard/block/detail/neighbours.hpp"
#include "mansard/block/detail/walls.hpp"

namespace mansard::block {
namespace {

using geometry::Mesh;
using geometry::Point2;
using geometry::Point3;
using geometry::Polygon;
using ::testing::ElementsAre;

auto box(double x0, double y0, double x1, double y1) -> Polygon {
  return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}};
}

/// A height field of squares of that size, cut into triangles.
template <class Height>
auto field(double x0, double y0, double x1, double y1, double size, Height height) -> Mesh {
  Mesh mesh;
  const auto columns = static_cast<std::uint32_t>(std::lround((x1 - x0) / size));
  const auto rows = static_cast<std::uint32_t>(std::lround((y1 - y0) / size));
  for (std::uint32_t r = 0; r <= rows; ++r)
    for (std::uint32_t c = 0; c <= columns; ++c) {
      const double x = x0 + c * size, y = y0 + r * size;
      mesh.vertices.push_back({x, y, height(Point2{x, y})});
    }
  for (std::uint32_t r = 0; r < rows; ++r)
    for (std::uint32_t c = 0; c < columns; ++c) {
      const std::uint32_t v = r * (columns + 1) + c;
      mesh.triangles.push_back({v, v + 1, v + columns + 2});
      mesh.triangles.push_back({v, v + columns + 2, v + columns + 1});
    }
  return mesh;
}

auto scene_of(Mesh mesh, const std::vector<std::vector<Polygon>>& footprints) -> model::Scene {
  model::Scene scene;
  scene.mesh = std::move(mesh);
  for (std::size_t i = 0; i < footprints.size(); ++i)
    scene.footprints.push_back({std::to_string(i), footprints[i], {}, {}});
  return scene;
}
auto level(double z) {
  return [z](Point2) { return z; };
}

auto members(const std::vector<Block>& blocks) -> std::vector<std::vector<std::size_t>> {
  std::vector<std::vector<std::size_t>> out;
  for (const auto& block : blocks) {
    out.emplace_back();
    for (const auto& member : block.members) out.back().push_back(member.feature);
  }
  return out;
}
auto total(const std::vector<Polygon>& polygons) -> double {
  double sum = 0;
  for (const auto& polygon : polygons) sum += geometry::area(polygon);
  return sum;
}

TEST(Partition, puts_what_touches_together_and_leaves_what_is_apart) {
  const auto scene = scene_of(field(0, 0, 60, 40, 2, level(0)), {{box(30, 0, 40, 10)},
                                                                 {box(0, 0, 10, 10)},
                                                                 {box(10.05, 0, 20, 10)},  // a gap of 5 cm
                                                                 {box(20.2, 0, 25, 10)},   // of 20 cm
                                                                 {box(0, 10, 5, 15)},      // a shared wall
                                                                 {box(32, 2, 34, 4)}});    // within another
  const auto blocks = partition(scene, {});
  EXPECT_THAT(members(blocks), ElementsAre(ElementsAre(0, 5), ElementsAre(1, 2, 4), ElementsAre(3)));
  EXPECT_EQ(blocks[0].name, "block-0");
  EXPECT_EQ(blocks[1].name, "block-1");
  EXPECT_EQ(blocks[2].name, "block-3");
}

TEST(Partition, leaves_out_features_with_a_defect) {
  auto scene = scene_of(field(0, 0, 60, 40, 2, level(0)), {{box(0, 0, 10, 10)}, {}, {box(10, 0, 20, 10)}});
  scene.footprints[1].defect = base::error("ingest-footprint-empty", "x");
  EXPECT_THAT(members(partition(scene, {})), ElementsAre(ElementsAre(0, 2)));
  scene.footprints.clear();
  EXPECT_TRUE(partition(scene, {}).empty());
}

TEST(Partition, keeps_a_feature_of_several_parts_in_one_block) {
  const auto scene = scene_of(field(0, 0, 60, 40, 2, level(0)),
                              {{box(0, 0, 5, 5)}, {box(30, 0, 35, 5)}, {box(5, 0, 8, 5), box(27, 0, 30, 5)}});
  const auto blocks = partition(scene, {});
  EXPECT_THAT(members(blocks), ElementsAre(ElementsAre(0, 1, 2)));
  EXPECT_EQ(blocks[0].outline.size(), 2U);
  EXPECT_NEAR(total(blocks[0].outline), 80, 1e-9);
}

TEST(Partition, closes_gaps_in_the_outline_and_else_keeps_every_point) {
  const auto gap =
      partition(scene_of(field(0, 0, 40, 40, 2, level(0)), {{box(0, 0, 10, 10)}, {box(10.05, 0, 20, 10)}}), {});
  ASSERT_EQ(gap.size(), 1U);
  ASSERT_EQ(gap[0].outline.size(), 1U);
  EXPECT_NEAR(geometry::area(gap[0].outline[0]), 200, 0.02);
  const auto shared =
      partition(scene_of(field(0, 0, 40, 40, 2, level(0)), {{box(0.1, 0.3, 10, 10)}, {box(10, 0.3, 20, 12)}}), {});
  ASSERT_EQ(shared[0].outline.size(), 1U);
  auto points = shared[0].outline[0].outer;
  for (const Point2 p :
       {Point2{0.1, 0.3}, Point2{20, 0.3}, Point2{20, 12}, Point2{10, 12}, Point2{10, 10}, Point2{0.1, 10}})
    EXPECT_THAT(points, ::testing::Contains(Point2{model::rounded(p.x), model::rounded(p.y)}));
}

TEST(Partition, keeps_courtyards_and_counts_corners_that_touch_as_touching) {
  // Four wings around a yard: with shared walls, and then meeting at their corners only.
  const auto walls =
      partition(scene_of(field(0, 0, 40, 40, 2, level(0)),
                         {{box(0, 0, 30, 10)}, {box(20, 10, 30, 30)}, {box(0, 20, 20, 30)}, {box(0, 10, 10, 20)}}),
                {});
  ASSERT_EQ(walls.size(), 1U);
  ASSERT_EQ(walls[0].outline.size(), 1U);
  EXPECT_EQ(walls[0].outline[0].holes.size(), 1U);
  EXPECT_EQ(total(walls[0].outline), 800);
  const auto corners =
      partition(scene_of(field(0, 0, 40, 40, 2, level(0)),
                         {{box(10, 0, 20, 10)}, {box(20, 10, 30, 20)}, {box(10, 20, 20, 30)}, {box(0, 10, 10, 20)}}),
                {});
  ASSERT_EQ(corners.size(), 1U);
  EXPECT_NEAR(total(corners[0].outline), 400, 0.1);
}

TEST(Partition, does_not_swallow_a_neighbour_in_the_bend_of_an_l) {
  //  ####
  //  #
  //  #  X        X stands in the bend, within the hull of the L, 8 m from it.
  const Polygon l{{{0, 0}, {5, 0}, {5, 35}, {40, 35}, {40, 40}, {0, 40}}, {}};
  const auto blocks = partition(scene_of(field(-20, -20, 60, 60, 1, level(0)), {{l}, {box(13, 10, 20, 20)}}), {});
  ASSERT_EQ(blocks.size(), 2U);
  for (const Point3 v : blocks[0].mesh.vertices)
    EXPECT_FALSE(v.x > 12 && v.x < 39 && v.y > 0 && v.y < 28) << v.x << " " << v.y;
}

TEST(Partition, keeps_exactly_the_triangles_within_the_padding) {
  base::Random random(5);
  const Polygon ring{{{0, 0}, {30, 0}, {30, 30}, {0, 30}}, {{{8, 8}, {8, 22}, {22, 22}, {22, 8}}}};
  Mesh mesh;
  for (int i = 0; i < 4000; ++i) {
    const Point2 at{random.uniform(-15, 45), random.uniform(-15, 45)};
    const double size = random.index(20) == 0 ? 60 : 2;
    for (int k = 0; k < 3; ++k)
      mesh.vertices.push_back({at.x + random.uniform(-size, size), at.y + random.uniform(-size, size), 0});
    const auto v = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.triangles.push_back({v - 3, v - 2, v - 1});
  }
  const auto near = [&](const geometry::Triangle& t, double padding) {
    const auto plan = detail::plan_of(mesh, t);
    if (geometry::contains(ring, plan[0]) || geometry::contains(std::span<const Point2>(plan), ring.outer[0]))
      return true;
    for (const auto* loop : {&ring.outer, &ring.holes[0]})
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t k = 0; k < 3; ++k)
          if (detail::distance({plan[k], plan[(k + 1) % 3]}, {(*loop)[i], (*loop)[(i + 1) % 4]}) <= padding)
            return true;
    return false;
  };
  for (const double padding : {0.0, 1.0, 5.0}) {
    Options options;
    options.padding = padding;
    const auto blocks = partition(scene_of(mesh, {{ring}}), options);
    std::vector<std::array<Point3, 3>> kept, wanted;
    for (const auto& t : blocks[0].mesh.triangles)
      kept.push_back({blocks[0].mesh.vertices[t[0]], blocks[0].mesh.vertices[t[1]], blocks[0].mesh.vertices[t[2]]});
    for (const auto& t : mesh.triangles) {
      if (!near(t, padding)) continue;
      auto& corners = wanted.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const Point3 p = mesh.vertices[t[k]];
        corners[k] = {model::rounded(p.x), model::rounded(p.y), model::rounded(p.z)};
      }
      std::ranges::rotate(corners, std::ranges::min_element(corners));
    }
    std::ranges::sort(wanted);
    EXPECT_EQ(kept, wanted) << "padding " << padding;
    EXPECT_EQ(blocks[0].mesh.vertices.size(), 3 * wanted.size());
    EXPECT_GT(wanted.size(), 100U);
    EXPECT_LT(wanted.size(), mesh.triangles.size());
  }
}

TEST(Partition, keeps_exactly_the_points_within_the_padding) {
  base::Random random(5);
  Mesh mesh = field(-20, -20, 50, 50, 10, level(0));
  for (int i = 0; i < 3000; ++i) mesh.points.push_back({random.uniform(-20, 50), random.uniform(-20, 50), 3});
  const auto shape = box(0, 0, 30, 20);
  const auto blocks = partition(scene_of(mesh, {{shape}}), {});
  std::vector<Point3> wanted;
  for (const Point3 p : mesh.points)
    if (geometry::contains(shape, xy(p)) || geometry::boundary_distance(shape, xy(p)) <= Options().padding)
      wanted.push_back({model::rounded(p.x), model::rounded(p.y), model::rounded(p.z)});
  std::ranges::sort(wanted);
  EXPECT_EQ(blocks[0].mesh.points, wanted);
  EXPECT_GT(wanted.size(), 300U);
}

TEST(Partition, does_not_depend_on_the_order_of_the_features) {
  base::Random random(9);
  std::vector<std::vector<Polygon>> shapes;
  for (int i = 0; i < 60; ++i) {
    const double x = std::floor(random.uniform(0, 90)), y = std::floor(random.uniform(0, 90));
    shapes.push_back({box(x, y, x + 4 + static_cast<double>(random.index(5)), y + 4)});
  }
  const auto sets_of = [&](const std::vector<std::size_t>& order) {
    std::vector<std::vector<Polygon>> turned;
    for (const auto i : order) turned.push_back(shapes[i]);
    std::vector<std::vector<std::size_t>> sets;
    for (const auto& block : partition(scene_of(field(0, 0, 100, 100, 2, level(3)), turned), {})) {
      sets.emplace_back();
      for (const auto& member : block.members) sets.back().push_back(order[member.feature]);
      std::ranges::sort(sets.back());
    }
    std::ranges::sort(sets);
    return sets;
  };
  std::vector<std::size_t> order(shapes.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto first = sets_of(order);
  EXPECT_GT(first.size(), 3U);
  EXPECT_LT(first.size(), shapes.size());
  for (int round = 0; round < 5; ++round) {
    for (std::size_t i = order.size() - 1; i > 0; --i) std::swap(order[i], order[random.index(i + 1)]);
    EXPECT_EQ(sets_of(order), first);
  }
}

TEST(Partition, is_the_same_at_any_number_of_threads) {
  std::vector<std::vector<Polygon>> shapes;
  for (int i = 0; i < 30; ++i) shapes.push_back({box(i * 9.0, 0, i * 9.0 + (i % 3 == 0 ? 9 : 7), 8)});
  const auto scene = scene_of(field(-10, -10, 290, 30, 1, [](Point2 p) { return std::sin(p.x) + p.y / 10; }), shapes);
  base::limit_threads(1);
  const auto one = partition(scene, {});
  base::limit_threads(0);
  const auto many = partition(scene, {});
  ASSERT_EQ(one.size(), many.size());
  for (std::size_t b = 0; b < one.size(); ++b) {
    EXPECT_EQ(one[b].outline, many[b].outline);
    EXPECT_EQ(one[b].mesh.vertices, many[b].mesh.vertices);
    EXPECT_EQ(one[b].mesh.triangles, many[b].mesh.triangles);
    EXPECT_EQ(one[b].ground, many[b].ground);
  }
}

TEST(Partition, knows_surroundings_but_makes_no_block_of_them_alone) {
  auto scene = scene_of(field(0, 0, 60, 40, 2, level(0)), {{box(0, 0, 10, 10)}});
  scene.surroundings = {{"x", {box(10, 0, 20, 10)}, {}, {}}, {"y", {box(40, 0, 50, 10)}, {}, {}}};
  const auto blocks = partition(scene, {});
  EXPECT_THAT(members(blocks), ElementsAre(ElementsAre(0, 1)));
  EXPECT_EQ(scene.feature(1).id, "x");
}

TEST(Groups, are_those_that_all_pairs_give) {
  constexpr std::uint64_t seed = 20;
  base::Random random(seed);
  for (int round = 0; round < 20; ++round) {
    // Boxes on a grid of 1/32 m: gaps of 0.094 m touch, those of 0.125 m do not. Some have a second part far away.
    std::vector<std::vector<Polygon>> shapes;
    const double side = round % 2 == 0 ? 60 : 150;
    for (int i = 0; i < 120; ++i) {
      const auto place = [&] { return std::round(random.uniform(0, side) * 32) / 32; };
      const double x = place(), y = place();
      shapes.push_back({box(x, y, x + 1 + std::round(random.uniform(0, 6)), y + 1 + std::round(random.uniform(0, 6)))});
      if (i % 9 == 0) shapes.back().push_back(box(x + 500, y, x + 502, y + 2));
    }
    const Options options;
    std::vector<std::size_t> of(shapes.size());
    std::iota(of.begin(), of.end(), std::size_t{0});
    const auto root = [&](std::size_t i) {
      while (of[i] != i) i = of[i];
      return i;
    };
    for (std::size_t i = 0; i < shapes.size(); ++i)
      for (std::size_t j = i + 1; j < shapes.size(); ++j)
        if (detail::are_near(shapes[i], shapes[j], options.touch))
          of[std::max(root(i), root(j))] = std::min(root(i), root(j));
    std::map<std::size_t, std::vector<std::size_t>> expected;
    for (std::size_t i = 0; i < shapes.size(); ++i) expected[root(i)].push_back(i);
    std::vector<std::vector<std::size_t>> of_all_pairs, found;
    for (auto& [first, group] : expected) of_all_pairs.push_back(std::move(group));
    const auto scene = scene_of({}, shapes);
    for (const auto& group : groups(scene, options)) found.push_back(group.features);
    EXPECT_EQ(found, of_all_pairs) << "seed " << seed << ", round " << round;
    EXPECT_EQ(members(partition(scene, options)), of_all_pairs) << "seed " << seed << ", round " << round;
    EXPECT_LT(found.size(), shapes.size());
  }
}

TEST(Partition, names_a_block_after_the_first_id_whatever_else_is_there) {
  auto scene = scene_of(field(0, 0, 60, 40, 2, level(0)), {{box(0, 0, 10, 10)}, {box(10, 0, 20, 10)}});
  scene.footprints[0].id = "way/20";
  scene.footprints[1].id = "way/3";
  EXPECT_EQ(partition(scene, {})[0].name, "block-way~2f3");
  std::ranges::reverse(scene.footprints);
  EXPECT_EQ(partition(scene, {})[0].name, "block-way~2f3");
}

TEST(Partition, gives_the_same_block_in_its_own_frame_anywhere_and_in_any_order) {
  base::Random random(11);
  Mesh mesh = field(-20, -20, 60, 40, 1.3, [&](Point2 p) { return std::sin(p.x) + p.y / 7; });
  for (int i = 0; i < 500; ++i)
    mesh.points.push_back({random.uniform(-20, 60), random.uniform(-20, 40), random.uniform(0, 9)});
  std::vector<std::vector<Polygon>> shapes{{box(0.1, 0.2, 10.3, 9.7)}, {box(10.3, 0.2, 19, 11)}, {box(30, 3, 34, 9)}};
  const auto first = partition(scene_of(mesh, shapes), {});
  ASSERT_EQ(first.size(), 2U);
  for (const Point3 by : {Point3{84800, 447400, -3}, Point3{-512, 1, 1000}}) {
    Mesh moved = mesh;
    auto other = shapes;
    for (Point3& v : moved.vertices) v = v + by;
    for (Point3& p : moved.points) p = p + by;
    for (auto& shape : other)
      for (Point2& p : shape[0].outer) p = p + xy(by);
    std::ranges::reverse(moved.triangles);
    std::ranges::reverse(moved.points);
    std::ranges::reverse(other);
    const auto again = partition(scene_of(moved, other), {});
    ASSERT_EQ(again.size(), 2U);
    const auto a = in_own_frame(first[0]), b = in_own_frame(again[1]);
    EXPECT_EQ(a.block.mesh.vertices, b.block.mesh.vertices);
    EXPECT_EQ(a.block.mesh.triangles, b.block.mesh.triangles);
    EXPECT_EQ(a.block.mesh.points, b.block.mesh.points);
    EXPECT_GT(a.block.mesh.points.size(), 30U);
    EXPECT_EQ(a.block.outline, b.block.outline);
    EXPECT_EQ(a.block.ground, b.block.ground);
    ASSERT_EQ(b.features.size(), 2U);
    EXPECT_THAT(a.features, ElementsAre(0, 1));
    EXPECT_THAT(b.features, ElementsAre(2, 1));
    for (std::size_t m = 0; m < 2; ++m) {
      EXPECT_EQ(a.block.members[m].polygons, b.block.members[m].polygons);
      EXPECT_EQ(a.block.members[m].ground, b.block.members[m].ground);
    }
  }
}

TEST(Ground, of_houses_on_a_slope_follows_the_slope) {
  // Rises 1 m in 10.
  std::vector<std::vector<Polygon>> shapes;
  for (const double x : {20.0, 60.0, 100.0}) shapes.push_back({box(x, 20, x + 10, 30)});
  const auto roofs = [&](Point2 p) {
    for (const auto& shape : shapes)
      if (p.x > shape[0].outer[0].x - 0.1 && p.x < shape[0].outer[1].x + 0.1 && p.y > 19.9 && p.y < 30.1) return 30.0;
    return p.x / 10;
  };
  const auto blocks = partition(scene_of(field(0, 0, 140, 50, 0.5, roofs), shapes), {});
  ASSERT_EQ(blocks.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(blocks[i].members[0].ground, shapes[i][0].outer[0].x / 10, 0.005);
    EXPECT_LT(blocks[i].ground, blocks[i].members[0].ground) << "where sections begin: what is around";
  }
}

/// A house of 10 m by 10 m on a terrain, and its member of the block.
template <class Terrain>
auto house_on(Terrain terrain) -> Member {
  const auto surface = [&](Point2 p) {
    return p.x > 19.9 && p.x < 30.1 && p.y > 19.9 && p.y < 30.1 ? 30.0 : terrain(p);
  };
  return partition(scene_of(field(0, 0, 50, 50, 0.5, surface), {{box(20, 20, 30, 30)}}), {}).at(0).members.at(0);
}
auto from_house(Point2 p) -> double {
  const double x = std::max({20 - p.x, p.x - 30, 0.0}), y = std::max({20 - p.y, p.y - 30, 0.0});
  return std::hypot(x, y);
}

TEST(Ground, is_the_terrain_at_the_walls_on_slopes_mounds_banks_and_quays) {
  struct Case {
    const char* name;
    std::function<double(Point2)> terrain;
    double lowest, mean, highest;
  };
  const std::vector<Case> cases{
      {"a slope of 16 %", [](Point2 p) { return 0.16 * p.x; }, 3.2, 4.0, 4.8},
      {"a slope of 40 %", [](Point2 p) { return -0.4 * p.y; }, -12, -10, -8},
      {"a slope of 40 % across", [](Point2 p) { return 0.28 * (p.x + p.y); }, 11.2, 14, 16.8},
      {"a mound", [](Point2 p) { return 5 - 0.3 * from_house(p); }, 5, 5, 5},
      {"a hollow", [](Point2 p) { return 0.25 * from_house(p); }, 0, 0, 0},
      {"a bank along one side", [](Point2 p) { return 0.4 * std::max(0.0, p.x - 30); }, 0, 0, 0},
      {"a quay 3 m in front", [](Point2 p) { return p.y < 17 ? -6.0 : 0.0; }, 0, 0, 0},
      {"a retaining wall 3 m behind", [](Point2 p) { return p.x > 33 ? 7.0 : 0.0; }, 0, 0, 0},
      {"a retaining wall 3 m below", [](Point2 p) { return p.x < 17 ? -7.0 : 0.1 * p.y; }, 2, 2.5, 3},
      {"a wall of the house in the water", [](Point2 p) { return p.y < 20 ? -2.0 : 0.0; }, -2, -0.5, 0},
      {"two levels, one in front and one behind", [](Point2 p) { return p.x < 25 ? 0.0 : 3.0; }, 0, 1.5, 3},
  };
  for (const auto& [name, terrain, lowest, mean, highest] : cases) {
    const auto member = house_on(terrain);
    ASSERT_TRUE(member.at_walls) << name;
    EXPECT_NEAR(member.ground, lowest, 0.15) << name;
    EXPECT_NEAR(member.at_walls->mean, mean, 0.15) << name;
    EXPECT_NEAR(member.at_walls->highest, highest, 0.25) << name;
  }
}

TEST(Ground, has_a_standard_error_that_is_right) {
  // Slopes with bumps that reach over a few metres, and noise: of 400 lowest places 68 % are to be within one standard
  // error, and 95 % within two.
  std::size_t one = 0, two = 0;
  constexpr std::size_t houses = 400;
  for (std::size_t seed = 0; seed < houses; ++seed) {
    base::Random random(seed);
    const Point2 slope{random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05)};
    std::array<std::array<double, 8>, 8> bumps{};
    for (auto& row : bumps)
      for (double& bump : row) bump = random.uniform(-0.1, 0.1);
    std::vector<detail::Sample> samples;
    for (double x = 15; x < 35; x += 0.5)
      for (double y = 15; y < 35; y += 0.5) {
        if (from_house({x, y}) == 0) continue;
        const auto c = static_cast<std::size_t>((x - 15) / 3), r = static_cast<std::size_t>((y - 15) / 3);
        const double u = (x - 15) / 3 - static_cast<double>(c), v = (y - 15) / 3 - static_cast<double>(r);
        const double waves = (1 - v) * ((1 - u) * bumps[r][c] + u * bumps[r][c + 1]) +
                             v * ((1 - u) * bumps[r + 1][c] + u * bumps[r + 1][c + 1]);
        samples.push_back({{x, y}, dot(slope, Point2{x, y}) + waves + random.uniform(-0.1, 0.1), 0.25});
      }
    const double truth = 25 * (slope.x + slope.y) - 5 * (std::abs(slope.x) + std::abs(slope.y));
    const auto found = detail::terrain_at_walls({box(20, 20, 30, 30)}, samples, {});
    ASSERT_TRUE(found);
    const double off = std::abs(found->lowest - truth) / found->walls.error;
    one += off <= 1, two += off <= 2;
  }
  EXPECT_NEAR(static_cast<double>(one) / houses, 0.68, 0.08);
  EXPECT_NEAR(static_cast<double>(two) / houses, 0.95, 0.04);
}

TEST(Ground, is_below_trees_and_above_a_few_pits) {
  const auto bumpy = [](Point2 p) {
    const auto cell = static_cast<int>(std::floor(p.x / 3)) + 7 * static_cast<int>(std::floor(p.y / 3));
    return cell % 2 == 0 ? 8.0 : cell % 25 == 1 ? -6.0 : 1.0;
  };
  const auto blocks = partition(scene_of(field(0, 0, 60, 60, 0.5, bumpy), {{box(25, 25, 35, 35)}}), {});
  EXPECT_NEAR(blocks[0].ground, 1, 0.01);
}

TEST(Ground, of_one_big_triangle_is_found_too) {
  Mesh mesh;
  mesh.vertices = {{-1e5, -1e5, 4}, {2e5, -1e5, 4}, {-1e5, 2e5, 4}};
  mesh.triangles = {{0, 2, 1}};  // upside down
  const auto blocks = partition(scene_of(mesh, {{box(0, 0, 10, 10)}}), {});
  EXPECT_NEAR(blocks[0].ground, 4, 1e-9);
  EXPECT_EQ(blocks[0].mesh.triangles.size(), 1U);
}

TEST(Ground, of_a_house_without_a_street_is_its_neighbours_or_the_foot_of_the_mesh) {
  // The middle one of 9 houses of 12 m has no street within 10 m; its ground is that of the block.
  std::vector<std::vector<Polygon>> shapes;
  for (int i = 0; i < 9; ++i) shapes.push_back({box(i % 3 * 12, i / 3 * 12, i % 3 * 12 + 12, i / 3 * 12 + 12)});
  const auto roofs = [](Point2 p) { return p.x > -0.1 && p.x < 36.1 && p.y > -0.1 && p.y < 36.1 ? 9.0 : 2.0; };
  const auto blocks = partition(scene_of(field(-20, -20, 56, 56, 1, roofs), shapes), {});
  ASSERT_EQ(blocks.size(), 1U);
  EXPECT_NEAR(blocks[0].members[4].ground, 2, 1e-9);
  // A house cut out of its mesh: walls down to 1, a roof at 7, no ground at all.
  Mesh cut = field(0, 0, 10, 10, 5, level(7));
  for (const auto& [a, b] : {std::pair{Point2{0, 0}, Point2{10, 0}}, std::pair{Point2{10, 0}, Point2{10, 10}}}) {
    const auto v = static_cast<std::uint32_t>(cut.vertices.size());
    for (const Point3 p : {Point3{a.x, a.y, 1}, Point3{b.x, b.y, 1}, Point3{b.x, b.y, 7}, Point3{a.x, a.y, 7}})
      cut.vertices.push_back(p);
    cut.triangles.push_back({v, v + 1, v + 2});
    cut.triangles.push_back({v, v + 2, v + 3});
  }
  EXPECT_EQ(partition(scene_of(cut, {{box(0, 0, 10, 10)}}), {})[0].ground, 1);
  // No mesh beside it, but within reach: the foot of that. None within reach: it is not known.
  const auto near = partition(scene_of(field(50, 0, 60, 10, 1, level(12)), {{box(0, 0, 10, 10)}}), {});
  EXPECT_EQ(near[0].ground, 12);
  EXPECT_TRUE(near[0].ground_known);
  EXPECT_TRUE(near[0].mesh.triangles.empty());
  EXPECT_FALSE(partition(scene_of(field(500, 500, 510, 510, 1, level(12)), {{box(0, 0, 10, 10)}}), {})[0].ground_known);
  EXPECT_FALSE(partition(scene_of({}, {{box(0, 0, 10, 10)}}), {})[0].ground_known);
}

TEST(Ground, that_no_scan_shows_is_assumed_below_the_roofs_or_what_somebody_says) {
  const std::vector<std::vector<Polygon>> two{{box(0, 0, 10, 10)}, {box(10, 0, 20, 10)}};
  const auto member_of = [](const model::Scene& scene, const Options& options = {}) {
    const auto blocks = partition(scene, options);
    EXPECT_EQ(blocks.size(), 1U);
    return blocks.at(0).members.at(0);
  };
  // As delivered: roofs only, with eaves that overhang by 0.6 m.
  auto scene = scene_of(field(-0.6, -0.6, 20.6, 10.6, 0.2, level(9)), two);
  const auto assumed = member_of(scene);
  EXPECT_EQ(assumed.ground_source, GroundSource::assumed);
  EXPECT_NEAR(assumed.ground, 6, 1e-3);
  // A z of the outline counts where it is not at the eaves.
  scene.footprints[0].outline_z = 8.9;
  EXPECT_EQ(member_of(scene).ground_source, GroundSource::assumed);
  scene.footprints[0].outline_z = 1.2;
  EXPECT_EQ(member_of(scene).ground_source, GroundSource::outline);
  EXPECT_NEAR(member_of(scene).ground, 1.2, 1e-3);
  Options options;
  options.ground_height = 2.5;
  EXPECT_EQ(member_of(scene, options).ground_source, GroundSource::option);
  EXPECT_NEAR(member_of(scene, options).ground, 2.5, 1e-3);
  scene.footprints[0].ground = -3;
  EXPECT_EQ(member_of(scene, options).ground_source, GroundSource::attribute);
  EXPECT_NEAR(member_of(scene, options).ground, -3, 1e-3);
  // With a street, that is the ground; not where the scan is known to have roofs only.
  const auto house = [](Point2 p) { return p.x > 0 && p.x < 20 && p.y > 0 && p.y < 10 ? 9.0 : 0.0; };
  auto street = scene_of(field(-8, -8, 28, 18, 1, house), two);
  EXPECT_EQ(member_of(street, options).ground_source, GroundSource::scan);
  street.roofs_only = true;
  EXPECT_EQ(member_of(street, options).ground_source, GroundSource::option);
}

TEST(Ground, is_the_terrain_where_that_is_known_along_the_outline) {
  // The mesh says 3, the terrain rises by 1 m in 10 to the east and ends in the middle of the third house.
  std::vector<std::vector<Polygon>> shapes;
  for (const double x : {10.0, 40.0, 65.0}) shapes.push_back({box(x, 10, x + 10, 20)});
  shapes.push_back({{box(10, 40, 50, 80).outer, {{{12, 42}, {12, 78}, {48, 78}, {48, 42}}}}});
  auto scene = scene_of(field(0, 0, 100, 100, 1, level(3)), shapes);
  model::HeightGrid grid{{0, 0}, 0.5, 141, 201, {}};
  for (std::size_t r = 0; r < grid.rows; ++r)
    for (std::size_t c = 0; c < grid.columns; ++c) grid.values.push_back(0.05F * static_cast<float>(c));
  // A mistake of the terrain beside the first house that its outline only touches.
  for (std::size_t c = 20; c < 26; ++c) grid.values[20 * grid.columns + c] = -50;
  scene.terrain = std::make_shared<const model::HeightGrid>(grid);
  const auto blocks = partition(scene, {});
  ASSERT_EQ(blocks.size(), 4U);
  EXPECT_NEAR(blocks[0].members[0].ground, 1, 0.06);
  EXPECT_NEAR(blocks[0].members[0].at_walls->mean, 1.5, 0.06);
  EXPECT_NEAR(blocks[0].members[0].at_walls->highest, 2, 0.06);
  EXPECT_NEAR(blocks[1].members[0].ground, 4, 0.06);
  EXPECT_EQ(blocks[2].ground, 3);  // half of its outline has no terrain
  EXPECT_NEAR(blocks[3].members[0].ground, 1, 0.06);
  EXPECT_NEAR(blocks[3].members[0].at_walls->highest, 5, 0.06);
  grid.values.assign(grid.values.size(), std::numeric_limits<float>::quiet_NaN());
  scene.terrain = std::make_shared<const model::HeightGrid>(grid);
  EXPECT_EQ(partition(scene, {})[0].ground, 3);
}

TEST(Blocks, of_delft_cover_all_footprints_and_stay_above_the_sea) {
  ingest::Options reading;
  reading.mesh_offset = {84800, 447400, 0};
  const std::filesystem::path data = MANSARD_SHARED_DATA;
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "no shared data";
  const auto scene =
      ingest::read_scene({data / "delft/delft_west_mesh.ply"}, data / "delft/delft_west_footprints.geojson", reading);
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  const auto blocks = partition(*scene, {});
  EXPECT_EQ(blocks.size(), 13U);
  std::vector<std::size_t> seen;
  for (const auto& block : blocks) {
    double sum = 0;
    for (const auto& member : block.members) {
      seen.push_back(member.feature);
      sum += total(member.polygons);
      EXPECT_GT(member.ground, -1.5);
      EXPECT_LT(member.ground, 2);
    }
    EXPECT_NEAR(total(block.outline), sum, 0.005 * sum) << block.name;
    EXPECT_GT(block.mesh.triangles.size(), 1000U);
  }
  std::ranges::sort(seen);
  EXPECT_EQ(seen.size(), 87U);
  EXPECT_EQ(std::ranges::adjacent_find(seen), seen.end());
}

TEST(Options, name_their_ranges) {
  Options options;
  auto list = option_list(options);
  EXPECT_TRUE(list.find("touch")->set("0.5"));
  EXPECT_EQ(options.touch, 0.5);
  EXPECT_FALSE(list.find("padding")->set("-1"));
  EXPECT_FALSE(list.find("ground_percentile")->set("101"));
}

TEST(Outline, is_the_footprints_and_a_warning_where_their_union_cannot_be_computed) {
  std::vector<base::Diagnostic> warnings;
  const std::vector<Polygon> shapes{box(0, 0, 1, 1), box(1e200, 0, 2e200, 1)};
  EXPECT_EQ(detail::outline_of(shapes, 0.1, 0.01, warnings), shapes);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].code, "block-outline");
  EXPECT_EQ(warnings[0].severity, base::Severity::warning);
  warnings.clear();
  EXPECT_EQ(detail::outline_of({box(0, 0, 1, 1), box(1, 0, 2, 1)}, 0.1, 0.01, warnings).size(), 1U);
  EXPECT_TRUE(warnings.empty());
}

}  // namespace
}  // namespace mansard::block
