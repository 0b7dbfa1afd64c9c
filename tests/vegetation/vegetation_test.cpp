// Crowns are found where they are, and nothing that is built passes for one.
#include "mansard/vegetation/vegetation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "mansard/base/run.hpp"
#include "mansard/geometry/mesh_part.hpp"
#include "mansard/vegetation/law.hpp"

namespace mansard::vegetation {
namespace {

using geometry::Mesh;
using geometry::Point2;
using geometry::Point3;
using geometry::Polygon;

/// A sheet of two triangles per cell over the box, and the same everywhere on every machine.
auto sheet(geometry::Box2 box, double spacing, const std::function<double(Point2)>& z) -> Mesh {
  Mesh mesh;
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

/// A ball with lumps of `rough` m, with its underside, outwards.
auto ball(Point3 middle, double radius, double rough) -> Mesh {
  constexpr std::uint32_t around = 32, up = 16;
  Mesh mesh;
  for (std::uint32_t j = 0; j <= up; ++j)
    for (std::uint32_t i = 0; i < around; ++i) {
      const double a = 2 * std::numbers::pi * i / around, e = std::numbers::pi * (j / double{up} - 0.5);
      const double r = radius + rough * std::sin(5 * a + 3 * e) * std::cos(4 * e + a);
      mesh.vertices.push_back(middle + r * Point3{std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)});
    }
  for (std::uint32_t j = 0; j < up; ++j)
    for (std::uint32_t i = 0; i < around; ++i) {
      const std::uint32_t a = j * around + i, b = j * around + (i + 1) % around, c = a + around, d = b + around;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  return mesh;
}

auto both(Mesh a, const Mesh& b) -> Mesh {
  const auto first = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& [i, j, k] : b.triangles) a.triangles.push_back({first + i, first + j, first + k});
  return a;
}

const Polygon outline{{{0, 0}, {12, 0}, {12, 10}, {0, 10}}, {}};
const geometry::Box2 ground{{-10, -10}, {22, 20}};

auto in_outline(Point2 p) -> bool { return p.x >= 0 && p.x <= 12 && p.y >= 0 && p.y <= 10; }
/// A gabled house on level ground; its walls are the steep triangles of the sheet.
auto gable(Point2 p) -> double { return in_outline(p) ? 6 + 0.7 * (5 - std::abs(p.y - 5)) : 0; }

auto found(const Mesh& mesh) -> Found { return find(mesh, std::vector{outline}, {}, {}); }

/// Whether a triangle has its middle within a distance of a place, in plan.
auto any_near(const Mesh& mesh, std::span<const std::uint32_t> triangles, Point2 place, double within) -> bool {
  return std::ranges::any_of(triangles, [&](std::uint32_t t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const auto middle = (1.0 / 3) * (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]);
    return length(xy(middle) - place) < within;
  });
}

TEST(Vegetation, finds_the_crown_of_a_tree_beside_the_house_and_leaves_the_roof) {
  const auto house = sheet(ground, 0.25, gable), tree = ball({6, -1, 7}, 2.6, 0.25), all = both(house, tree);
  const auto crowns = found(all);
  ASSERT_EQ(crowns.crowns.size(), 1U);
  EXPECT_LT(length(crowns.crowns[0].centre - Point2{6, -1}), 0.6);
  EXPECT_GT(crowns.crowns[0].overhang, 0.5);
  // Nearly all of the crown's upper half goes, and nothing of the roof at some distance.
  const auto of_tree =
      std::ranges::count_if(crowns.triangles, [&](std::uint32_t t) { return t >= house.triangles.size(); });
  EXPECT_GT(of_tree, 0.45 * static_cast<double>(tree.triangles.size()));
  for (const Point2 place : {Point2{2, 2}, {10, 2}, {6, 7}}) EXPECT_FALSE(any_near(all, crowns.below, place, 1));
  EXPECT_EQ(geometry::without(all, crowns.triangles).triangles.size(), all.triangles.size() - crowns.triangles.size());
}

TEST(Vegetation, finds_a_crown_over_the_roof) {
  const auto crowns = found(both(sheet(ground, 0.25, gable), ball({6, 5, 11}, 3.4, 0.3)));
  ASSERT_EQ(crowns.crowns.size(), 1U);
  EXPECT_LT(length(crowns.crowns[0].centre - Point2{6, 5}), 0.6);
}

TEST(Vegetation, takes_over_the_footprints_what_is_near_a_visible_underside_only) {
  // The crown is half in the roof: there it hangs over nothing, and a scan has nothing of it below the roof.
  auto tree = ball({6, 0.4, 7}, 3, 0.25);
  std::erase_if(tree.triangles, [&](const auto& corners) {
    return std::ranges::any_of(corners,
                               [&](std::uint32_t v) { return tree.vertices[v].z < gable(xy(tree.vertices[v])); });
  });
  const auto all = both(sheet(ground, 0.25, gable), tree);
  const auto cells = [&](double near_underside) {
    Options options;
    options.near_underside = near_underside;
    return find(all, std::vector{outline}, {}, options).below.size();
  };
  EXPECT_GT(cells(0.25), 0U);
  EXPECT_LT(cells(0.25), cells(1));
  EXPECT_LT(cells(1), cells(50));
}

TEST(Vegetation, leaves_trees_that_are_not_over_the_footprints) {
  EXPECT_TRUE(found(both(sheet(ground, 0.25, gable), ball({6, -5, 4}, 2.6, 0.25))).crowns.empty());
}

/// The top of a crown of 2 m radius with lumps, over its middle.
auto crown_over(Point2 p, Point2 middle) -> double {
  const Point2 d = p - middle;
  const double a = std::atan2(d.y, d.x), r = length(d) / (2 + 0.15 * std::sin(5 * a));
  return r < 1 ? 2.4 * std::sqrt(1 - r * r) + 0.12 * std::sin(4 * d.x) * std::cos(4 * d.y) : -100;
}

TEST(Vegetation, finds_a_crown_that_grows_out_of_a_roof_and_hangs_over_nothing) {
  for (const Point2 middle : {Point2{6, 3}, Point2{4, 5}}) {
    const auto tree =
        sheet(ground, 0.25, [&](Point2 p) { return std::max(gable(p), gable(middle) + 0.8 + crown_over(p, middle)); });
    const auto crowns = found(tree);
    ASSERT_EQ(crowns.crowns.size(), 1U) << middle.x;
    EXPECT_LT(crowns.crowns[0].overhang, 0.05);
    EXPECT_LT(length(crowns.crowns[0].centre - middle), 0.6);
    for (const Point2 place : {Point2{10, 3}, {10, 7}}) EXPECT_FALSE(any_near(tree, crowns.below, place, 1));
  }
}

TEST(Vegetation, finds_a_small_crown_that_is_clearly_a_dome) {
  const auto small = [](Point2 p, Point2 middle) {
    return 0.55 * crown_over(middle + (1 / 0.62) * (p - middle), middle);
  };
  for (const Point2 middle : {Point2{6, 3}, Point2{4, 7}}) {
    const auto tree =
        sheet(ground, 0.25, [&](Point2 p) { return std::max(gable(p), gable(middle) + 0.6 + small(p, middle)); });
    const auto crowns = found(tree);
    ASSERT_EQ(crowns.crowns.size(), 1U) << middle.x;
    EXPECT_LT(crowns.crowns[0].area, 5.8);
    EXPECT_LT(length(crowns.crowns[0].centre - middle), 0.6);
  }
}

/// What is built over the house, of a height above its level roof at 6 m.
auto built(const std::function<double(Point2)>& height) -> Found {
  return found(sheet(ground, 0.25, [&](Point2 p) { return in_outline(p) ? 6 + height(p) : 0.0; }));
}

TEST(Vegetation, takes_nothing_built_for_a_crown) {
  const auto square = [](Point2 p, Point2 middle, double half) {
    return std::max(std::abs(p.x - middle.x), std::abs(p.y - middle.y)) < half;
  };
  const auto nothing = [](const Found& f) { return f.crowns.empty() && f.triangles.empty() && f.below.empty(); };
  EXPECT_TRUE(nothing(found(sheet(ground, 0.25, gable)))) << "gable";
  EXPECT_TRUE(nothing(built([](Point2) { return 0.0; }))) << "level";
  EXPECT_TRUE(nothing(built([&](Point2 p) { return square(p, {4, 4}, 1.25) ? 2.5 : 0.0; }))) << "plant room";
  EXPECT_TRUE(nothing(built([&](Point2 p) { return square(p, {4, 4}, 0.5) ? 1.5 : 0.0; }))) << "chimney";
  EXPECT_TRUE(nothing(built([](Point2 p) { return std::min({p.x, 12 - p.x, p.y, 10 - p.y}); }))) << "hipped";
  EXPECT_TRUE(nothing(built([](Point2 p) {  // a drum with a dome of 4 m
    const double r = length(p - Point2{6, 5});
    return r < 4 ? 2 + std::sqrt(16 - r * r) : 0.0;
  }))) << "dome";
  EXPECT_TRUE(nothing(built([](Point2 p) {  // a spire of 2 m radius
    const double r = length(p - Point2{6, 5});
    return r < 2 ? 3 * (2 - r) : 0.0;
  }))) << "spire";
  EXPECT_TRUE(nothing(built([](Point2 p) {  // a turret of 2.4 m with a cone on it
    const double r = length(p - Point2{6, 5});
    return r < 1.2 ? 1.5 + 1.5 * (1.2 - r) : 0.0;
  }))) << "turret";
  EXPECT_TRUE(nothing(built([&](Point2 p) {  // a pavilion of 2.5 m
    return square(p, {4, 4}, 1.25) ? 1 + 1.25 - std::max(std::abs(p.x - 4), std::abs(p.y - 4)) : 0.0;
  }))) << "pavilion";
  EXPECT_TRUE(nothing(found(sheet(ground, 0.25,
                                  [&](Point2 p) {  // dormers on the gable
                                    const bool dormer = p.y > 1 && p.y < 3.5 &&
                                                        std::abs(std::remainder(p.x, 4.0)) < 0.8 && in_outline(p);
                                    return dormer ? std::max(gable(p), 8.6) : gable(p);
                                  }))))
      << "dormers";
}

/// A flat roof, and above it what is seen from above and, 0.4 m lower, from below wherever `z` is a number.
auto above_a_flat_roof(const std::function<double(Point2)>& z) -> Mesh {
  auto all = sheet(ground, 0.25, [](Point2 p) { return in_outline(p) ? 6.0 : 0.0; });
  for (const bool below : {false, true}) {
    auto part = sheet(ground, 0.25, [&](Point2 p) { return z(p) - (below ? 0.4 : 0.0); });
    std::erase_if(part.triangles, [&](const auto& corners) {
      return std::ranges::any_of(corners, [&](std::uint32_t v) { return std::isnan(part.vertices[v].z); });
    });
    for (auto& vertex : part.vertices)
      if (std::isnan(vertex.z)) vertex.z = 0;  // of no triangle
    if (below)
      for (auto& corners : part.triangles) std::swap(corners[1], corners[2]);
    all = both(std::move(all), part);
  }
  return all;
}
constexpr double none = std::numeric_limits<double>::quiet_NaN();

TEST(Vegetation, leaves_what_hangs_over_a_roof_but_is_lower_in_its_middle) {
  const auto cup = [](double bend) {
    return above_a_flat_roof([bend](Point2 p) {
      const double r = length(p - Point2{6, 5});
      return r < 1.95 ? 10 + bend * r * r + 0.05 * std::sin(5 * p.x) * std::cos(4 * p.y) : none;
    });
  };
  EXPECT_EQ(found(cup(-0.9)).crowns.size(), 1U);  // the other way up it has the shape of a crown
  EXPECT_TRUE(found(cup(1.05)).crowns.empty());
}

/// A shed that a scan has rounded until it is a crown's shape.
const Polygon shed{{{4.3, 3.3}, {7.7, 3.3}, {7.7, 6.7}, {4.3, 6.7}}, {}};
auto rounded_shed(Point2 p) -> double { return std::max(0.0, 0.8 + crown_over(p, {6, 5})); }

auto buildings(const std::vector<Polygon>& one) -> std::vector<std::vector<Polygon>> { return {one}; }

TEST(Vegetation, takes_no_shed_for_the_crown_of_a_tree) {
  const auto mesh = sheet(ground, 0.25, rounded_shed);
  const std::vector<Polygon> plan{shed};
  EXPECT_EQ(find(mesh, plan, {}, {}).crowns.size(), 1U) << "it has the shape of one";
  EXPECT_TRUE(find(mesh, plan, buildings(plan), {}).crowns.empty());
  // A footprint that is hardly covered says nothing of what is on it.
  const std::vector<Polygon> large{{{{-2, -2}, {12, -2}, {12, 12}, {-2, 12}}, {}}};
  EXPECT_EQ(find(mesh, large, buildings(large), {}).crowns.size(), 1U);
}

TEST(Vegetation, leaves_of_a_shed_below_a_tree_what_has_no_visible_underside) {
  // The crown is beside the shed, joins it, and with it is one region.
  const auto mesh = both(sheet(ground, 0.25, rounded_shed), ball({3.4, 5, 3.2}, 2.2, 0.2));
  const std::vector<Polygon> plan{shed};
  const auto all = find(mesh, plan, {}, {}), known = find(mesh, plan, buildings(plan), {});
  ASSERT_EQ(all.crowns.size(), 1U);
  ASSERT_EQ(known.crowns.size(), 1U);
  const Point2 east{7.2, 5};  // of the shed, beyond the crown
  EXPECT_TRUE(any_near(mesh, all.below, east, 0.3));
  EXPECT_FALSE(any_near(mesh, known.below, east, 0.3));
  EXPECT_TRUE(any_near(mesh, known.triangles, {3.4, 5}, 0.5));
}

TEST(Vegetation, takes_no_annex_for_the_crown_of_a_tree) {
  // It leans on the higher house in the north, and ends where its outline does.
  const Polygon house{{{-2, 6.6}, {14, 6.6}, {14, 16}, {4.3, 16}, {-2, 16}}, {}};
  const auto height = [&](bool leans) {
    return [leans, house](Point2 p) { return geometry::contains(house, p) ? (leans ? 9.0 : 1.0) : rounded_shed(p); };
  };
  const std::vector<Polygon> plan{
      {{{4.3, 3.3}, {7.7, 3.3}, {7.7, 6.6}, {14, 6.6}, {14, 16}, {-2, 16}, {-2, 6.6}, {4.3, 6.6}}, {}}};
  EXPECT_TRUE(find(sheet(ground, 0.25, height(true)), plan, buildings(plan), {}).crowns.empty());
  EXPECT_EQ(find(sheet(ground, 0.25, height(false)), plan, buildings(plan), {}).crowns.size(), 1U)
      << "of a low terrace, a crown";
  // The same shape over open ground and roof alike is that of a tree.
  const std::vector<Polygon> narrow{
      {{{6, 3.3}, {7.7, 3.3}, {7.7, 6.6}, {14, 6.6}, {14, 16}, {-2, 16}, {-2, 6.6}, {6, 6.6}}, {}}};
  EXPECT_EQ(find(sheet(ground, 0.25, height(true)), narrow, buildings(narrow), {}).crowns.size(), 1U);
}

TEST(Vegetation, leaves_a_canopy_whose_underside_is_seen) {
  auto canopy = sheet({{3, -3}, {9, 0.5}}, 0.25, [](Point2) { return 4.0; });
  auto underside = sheet({{3, -3}, {9, 0.5}}, 0.25, [](Point2) { return 3.7; });
  for (auto& [a, b, c] : underside.triangles) std::swap(b, c);
  EXPECT_TRUE(found(both(both(sheet(ground, 0.25, gable), canopy), underside)).crowns.empty());
}

TEST(Vegetation, is_found_the_same_at_any_number_of_threads_and_far_from_the_origin) {
  auto mesh = both(sheet(ground, 0.25, gable), ball({6, -1, 7}, 2.6, 0.25));
  const auto many = found(mesh);
  base::limit_threads(1);
  const auto one = found(mesh);
  base::limit_threads(0);
  EXPECT_EQ(many.triangles, one.triangles);
  EXPECT_EQ(many.below, one.below);
  // Tiles begin elsewhere there.
  for (auto& v : mesh.vertices) v = v + Point3{1024, -4096, 0};
  auto moved = outline;
  for (auto& p : moved.outer) p = p + Point2{1024, -4096};
  const auto elsewhere = find(mesh, std::vector{moved}, {}, {});
  ASSERT_EQ(elsewhere.crowns.size(), many.crowns.size());
  for (std::size_t i = 0; i < many.crowns.size(); ++i) EXPECT_NEAR(elsewhere.crowns[i].area, many.crowns[i].area, 0.25);
}

TEST(Vegetation, is_not_looked_for_without_a_mesh_without_an_outline_and_when_switched_off) {
  const auto mesh = both(sheet(ground, 0.25, gable), ball({6, -1, 7}, 2.6, 0.25));
  Options off;
  off.mask = false;
  EXPECT_TRUE(find(mesh, std::vector{outline}, {}, off).triangles.empty());
  EXPECT_TRUE(find({}, std::vector{outline}, {}, {}).triangles.empty());
  EXPECT_TRUE(find(mesh, {}, {}, {}).triangles.empty());
}

/// Independent noise with standard deviation 1, the same on every machine.
auto noise_at(Point2 p) -> double {
  const auto hash = [](std::uint64_t v) {  // SplitMix64 (Steele, Lea, Flood 2014)
    v += 0x9e3779b97f4a7c15U;
    v = (v ^ (v >> 30U)) * 0xbf58476d1ce4e5b9U;
    v = (v ^ (v >> 27U)) * 0x94d049bb133111ebU;
    return v ^ (v >> 31U);
  };
  const auto seed = static_cast<std::uint64_t>(std::llround(1000 * (p.x + 500)) * 1'000'003 + std::llround(1000 * p.y));
  double sum = -6;
  for (std::uint64_t k = 0; k < 12; ++k) sum += static_cast<double>(hash(12 * seed + k) >> 11U) / 9007199254740992.0;
  return sum;
}

auto scan_of(double noise, double area) -> model::Accuracy {
  model::Accuracy out;
  out.noise = noise, out.correlated_area = area;
  return out;
}

TEST(VegetationLaw, the_noise_of_a_scan_is_no_crown) {
  // A tree is beside the house in both; only the roof is noisy, over squares of a metre.
  const auto noisy = [](Point2 p) {
    return gable(p) + (in_outline(p) ? 0.15 * noise_at({std::floor(p.x), std::floor(p.y)}) : 0);
  };
  const auto mesh = both(sheet(ground, 0.25, noisy), ball({6, 10.5, 8}, 2.5, 0.6));
  const auto crowns_by = [&](const Options& options) { return find(mesh, std::vector{outline}, {}, options).crowns; };
  const double with_roof = crowns_by({}).front().area;
  const auto crowns = crowns_by(decided_by({}, scan_of(0.15, 1.0)));
  ASSERT_EQ(crowns.size(), 1U);
  EXPECT_NEAR(crowns.front().centre.y, 10.5, 1.0);
  EXPECT_GT(with_roof, 1.4 * crowns.front().area);
}

TEST(VegetationLaw, an_accurate_scan_is_compared_as_before) {
  const auto options = decided_by({}, scan_of(0.02, 0.05));
  EXPECT_EQ(options.roughness, Options{}.roughness);
  EXPECT_EQ(options.even, Options{}.even);
  EXPECT_EQ(options.plane_distance, Options{}.plane_distance);
}

}  // namespace
}  // namespace mansard::vegetation
