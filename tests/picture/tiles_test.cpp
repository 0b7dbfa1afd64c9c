#include "mansard/picture/tiles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "mansard/rays/rays.hpp"

namespace {

using namespace mansard;
using geometry::Mesh;
using geometry::Point3;
using picture::Tile;
using picture::TileOptions;
using picture::tiles;

/// A field of hills, n by n squares of `step` metres; low and wide enough that nothing of it vanishes.
auto hills(std::size_t n, double step) -> Mesh {
  Mesh mesh;
  base::Random random(7);
  for (std::size_t j = 0; j <= n; ++j)
    for (std::size_t i = 0; i <= n; ++i) {
      const double x = static_cast<double>(i) * step, y = static_cast<double>(j) * step;
      mesh.vertices.push_back({100 + x, -50 + y, 4 * std::sin(x / 9) * std::cos(y / 7) + random.uniform(0, 0.05)});
    }
  const auto at = [n](std::size_t i, std::size_t j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

constexpr TileOptions small{.most = 1000, .error = 0.5, .coarsest = 2000};

auto corner(const Tile& tile, std::size_t vertex) -> Point3 {
  const float* p = tile.positions.data() + 3 * vertex;
  return tile.centre + Point3{static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

auto mesh_of(const std::vector<Tile>& all, std::size_t level) -> Mesh {
  Mesh mesh;
  for (const auto& tile : all) {
    if (tile.level != level) continue;
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (std::size_t v = 0; 3 * v < tile.positions.size(); ++v) mesh.vertices.push_back(corner(tile, v));
    for (std::size_t t = 0; t < tile.triangles.size(); t += 3)
      mesh.triangles.push_back(
          {first + tile.triangles[t], first + tile.triangles[t + 1], first + tile.triangles[t + 2]});
  }
  return mesh;
}

auto levels_of(const std::vector<Tile>& all) -> std::size_t {
  std::size_t levels = 0;
  for (const auto& tile : all) levels = std::max(levels, tile.level + 1);
  return levels;
}

using Corners = std::array<std::array<std::int64_t, 3>, 3>;
/// The triangle's corners to a tenth of a millimetre.
auto rounded(const Mesh& mesh, const geometry::Triangle& t) -> Corners {
  Corners out{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Point3 p = mesh.vertices[t[k]];
    out[k] = {std::llround(1e4 * p.x), std::llround(1e4 * p.y), std::llround(1e4 * p.z)};
  }
  return out;
}

auto sorted(const Mesh& mesh) -> std::vector<Corners> {
  std::vector<Corners> all;
  for (const auto& t : mesh.triangles) all.push_back(rounded(mesh, t));
  std::ranges::sort(all);
  return all;
}

TEST(Tiles, have_every_triangle_of_the_mesh_once_at_level_0) {
  auto mesh = hills(80, 1.6);
  for (auto& v : mesh.vertices)
    v = {std::round(v.x * 128) / 128, std::round(v.y * 128) / 128, std::round(v.z * 128) / 128};
  const auto all = tiles(mesh, small);
  EXPECT_EQ(sorted(mesh_of(all, 0)), sorted(mesh));
  EXPECT_GT(std::ranges::count(all, 0U, &Tile::level), 4);
}

TEST(Tiles, make_levels_of_ever_fewer_triangles_until_one_is_small) {
  const auto mesh = hills(80, 1.6);
  const auto all = tiles(mesh, small);
  const auto levels = levels_of(all);
  ASSERT_GE(levels, 3U);
  std::size_t before = mesh.triangles.size();
  for (std::size_t level = 1; level < levels; ++level) {
    EXPECT_GT(before, small.coarsest);
    const auto count = mesh_of(all, level).triangles.size();
    EXPECT_LE(count, before / 2);
    EXPECT_GT(count, 0U);
    before = count;
  }
  EXPECT_LE(before, small.coarsest);
  EXPECT_EQ(levels_of(tiles(mesh)), 1U);  // small enough as it is
}

TEST(Tiles, stay_within_a_cells_diagonal_of_the_mesh_and_the_mesh_of_them) {
  const auto mesh = hills(80, 1.6);
  const rays::Scene exact(mesh);
  const auto all = tiles(mesh, small);
  for (std::size_t level = 1; level < levels_of(all); ++level) {
    const auto coarse = mesh_of(all, level);
    const rays::Scene surface(coarse);
    const auto cell = std::ranges::find(all, level, &Tile::level)->cell;
    const double diagonal = std::sqrt(3.0) * cell + 1e-3;
    double worst = 0;
    for (const auto& t : coarse.triangles) {
      const Point3 centre = (1.0 / 3) * (coarse.vertices[t[0]] + coarse.vertices[t[1]] + coarse.vertices[t[2]]);
      for (const Point3 p : {coarse.vertices[t[0]], coarse.vertices[t[1]], coarse.vertices[t[2]], centre})
        worst = std::max(worst, exact.nearest(p)->distance);
    }
    for (const Point3 p : mesh.vertices) worst = std::max(worst, surface.nearest(p)->distance);
    EXPECT_LE(worst, diagonal) << "level " << level;
    EXPECT_GT(worst, 0);
  }
}

TEST(Tiles, leave_no_gaps_between_them) {
  // The one surface of a level, put together from its tiles by place, has no border but the mesh's own.
  const auto mesh = hills(80, 1.6);
  const auto all = tiles(mesh, small);
  for (std::size_t level = 0; level < levels_of(all); ++level) {
    const auto surface = mesh_of(all, level);
    const double cell = std::ranges::find(all, level, &Tile::level)->cell;
    std::map<std::pair<std::array<std::int64_t, 3>, std::array<std::int64_t, 3>>, int> uses;
    std::size_t borders = 0;
    for (const auto& t : surface.triangles) {
      const auto c = rounded(surface, t);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto &a = c[k], &b = c[(k + 1) % 3];
        ++uses[{std::min(a, b), std::max(a, b)}];
      }
    }
    for (const auto& [edge, count] : uses) {
      if (count != 1) continue;
      ++borders;
      for (const auto& p : {edge.first, edge.second}) {
        const double x = static_cast<double>(p[0]) * 1e-4 - 100, y = static_cast<double>(p[1]) * 1e-4 + 50;
        EXPECT_LE(std::min({x, y, 128 - x, 128 - y}), cell + 1e-3) << "level " << level;
      }
    }
    EXPECT_GT(borders, 0U);
  }
}

TEST(Tiles, are_covered_by_the_tile_of_half_their_place_one_level_up) {
  const auto all = tiles(hills(80, 1.6), small);
  std::map<std::tuple<std::size_t, std::size_t, std::size_t>, const Tile*> at;
  for (const auto& tile : all) EXPECT_TRUE(at.emplace(std::tuple(tile.level, tile.column, tile.row), &tile).second);
  for (const auto& tile : all) {
    if (tile.level + 1 == levels_of(all)) continue;
    const auto up = at.find({tile.level + 1, tile.column / 2, tile.row / 2});
    ASSERT_NE(up, at.end());
    const double cell = up->second->cell;
    const Point3 middle = 0.5 * (tile.low + tile.high);
    EXPECT_GE(middle.x, up->second->low.x - 2 * cell);
    EXPECT_LE(middle.x, up->second->high.x + 2 * cell);
  }
}

TEST(Tiles, keep_their_promise_of_size_and_box) {
  TileOptions options = small;
  options.most = 3000;
  const auto all = tiles(hills(250, 1), options);
  std::set<std::size_t> rows;
  for (const auto& tile : all) {
    if (tile.level == 0) {
      EXPECT_LE(tile.triangles.size() / 3, options.most);
    }
    rows.insert(tile.row);
    for (std::size_t v = 0; 3 * v < tile.positions.size(); ++v) {
      const Point3 p = corner(tile, v);
      EXPECT_GE(p.x, tile.low.x - 1e-4);
      EXPECT_LE(p.z, tile.high.z + 1e-4);
    }
  }
  EXPECT_GT(rows.size(), 2U);
}

TEST(Tiles, are_the_same_at_any_thread_count) {
  const auto mesh = hills(80, 1.6);
  std::vector<std::vector<Tile>> made;
  for (const std::size_t threads : {1, 2}) {
    base::limit_threads(threads);
    made.push_back(tiles(mesh, small));
  }
  base::limit_threads(0);
  ASSERT_EQ(made[0].size(), made[1].size());
  for (std::size_t i = 0; i < made[0].size(); ++i) {
    EXPECT_EQ(made[0][i].positions, made[1][i].positions);
    EXPECT_EQ(made[0][i].triangles, made[1][i].triangles);
    EXPECT_EQ(made[0][i].centre, made[1][i].centre);
  }
}

TEST(Tiles, are_none_when_cancelled_at_any_step) {
  const auto mesh = hills(80, 1.6);
  int steps = 0;
  for (int at = 0; at < 3; ++at) {
    base::Cancel cancel;
    base::Run run;
    run.cancel = &cancel;
    int reports = 0;
    run.progress = [&](auto, auto, double) {
      if (reports++ == at) cancel.request();
    };
    EXPECT_TRUE(tiles(mesh, small, run).empty()) << "cancelled at report " << at;
    steps += cancel.requested() ? 1 : 0;
  }
  EXPECT_GE(steps, 2) << "levels were reported";
}

TEST(Tiles, of_a_tall_heap_on_one_spot_are_made_too) {
  Mesh heap;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const double z = 0.01 * i;
    for (const auto& p : {Point3{0, 0, z}, Point3{1, 0, z}, Point3{0, 1, z}}) heap.vertices.push_back(p);
    heap.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const auto all = tiles(heap, small);
  EXPECT_EQ(mesh_of(all, 0).triangles.size(), 3000U);
  EXPECT_TRUE(tiles(Mesh{}).empty());
}

}  // namespace
