// Levels by clustering vertices: every cell of a grid over the whole mesh becomes one vertex, whichever tile asks.
#include "mansard/picture/tiles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>

namespace mansard::picture {
namespace {

using geometry::Box3;
using geometry::Mesh;
using geometry::Point3;
using geometry::Triangle;

constexpr std::size_t at_a_time = 8;  // tiles that are in memory, of about 1.5 MB each

template <class Work>
void in_pieces(std::size_t count, const Work& work) {
  constexpr std::size_t size = 65'536;
  base::parallel_for((count + size - 1) / size, [&](std::size_t piece) {
    for (std::size_t i = piece * size; i < std::min(count, (piece + 1) * size); ++i) work(i);
  });
}

auto box_of(const Mesh& mesh) -> Box3 {
  Box3 box;
  for (const auto& t : mesh.triangles)
    for (const auto v : t) box.add(mesh.vertices[v]);
  return box;
}

/// 21 bits an axis: cells of 1 cm over 20 km.
auto key_of(Point3 p, Point3 low, double cell) -> std::uint64_t {
  constexpr double most = (1 << 21) - 1;
  const auto axis = [&](double v, double from) {
    return static_cast<std::uint64_t>(std::clamp(std::floor((v - from) / cell), 0.0, most));
  };
  return axis(p.x, low.x) << 42U | axis(p.y, low.y) << 21U | axis(p.z, low.z);
}

/// Starts with the vertex of the lowest number, so that equal triangles look equal.
auto turned(Triangle t) -> Triangle {
  std::ranges::rotate(t, std::ranges::min_element(t));
  return t;
}

/// The number of the cell of each vertex, in the order of the cells; and how many cells there are.
auto cells_of(const Mesh& mesh, Point3 low, double cell, const base::Run& run)
    -> std::pair<std::vector<std::uint32_t>, std::uint32_t> {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order(mesh.vertices.size());
  in_pieces(order.size(), [&](std::size_t v) {
    order[v] = {key_of(mesh.vertices[v], low, cell), static_cast<std::uint32_t>(v)};
  });
  if (run.cancelled()) return {};
  std::ranges::sort(order);
  std::vector<std::uint32_t> cells(order.size());
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && order[i].first != order[i - 1].first) ++count;
    cells[order[i].second] = count;
  }
  return {std::move(cells), order.empty() ? 0 : count + 1};
}

/// The mesh with all vertices of one cell as their mean; triangles without three corners are gone, and repeated ones.
/// None where more than `most` triangles remain. What it needs beside the mesh is little: the mesh of a city is most of
/// what the program has in memory. Empty when cancelled: each step takes seconds for tens of millions of triangles.
auto clustered(const Mesh& mesh, Point3 low, double cell, std::size_t most, const base::Run& run)
    -> std::optional<Mesh> {
  const auto [cells, count] = cells_of(mesh, low, cell, run);
  if (run.cancelled()) return Mesh();
  Mesh out;
  // Sorted in pieces by the first corner.
  constexpr std::uint64_t pieces = 8;
  for (std::uint64_t piece = 0; piece < pieces; ++piece) {
    const std::uint64_t from = piece * count / pieces, to = (piece + 1) * count / pieces;
    std::vector<Triangle> some;
    for (const auto& t : mesh.triangles) {
      const Triangle moved{cells[t[0]], cells[t[1]], cells[t[2]]};
      if (moved[0] == moved[1] || moved[1] == moved[2] || moved[2] == moved[0]) continue;
      const auto first = std::min({moved[0], moved[1], moved[2]});
      if (from <= first && first < to) some.push_back(turned(moved));
    }
    if (run.cancelled()) return Mesh();
    std::ranges::sort(some);
    some.erase(std::ranges::unique(some).begin(), some.end());
    if (out.triangles.size() + some.size() > most) return std::nullopt;
    if (piece == 0) out.triangles.reserve(std::min(most, some.size() * (pieces + 1)));
    out.triangles.insert(out.triangles.end(), some.begin(), some.end());
  }
  out.vertices.resize(count);
  std::vector<std::uint32_t> members(count);
  for (std::size_t v = 0; v < cells.size(); ++v) {
    auto& sum = out.vertices[cells[v]];
    sum = sum + (mesh.vertices[v] - low);
    ++members[cells[v]];
  }
  for (std::size_t i = 0; i < count; ++i)
    out.vertices[i] = low + (1 / static_cast<double>(members[i])) * out.vertices[i];
  return out;
}

/// Row and column of the tile that a triangle's centre is in, as one number that sorts by rows.
using Place = std::uint64_t;
auto place(std::size_t row, std::size_t column) -> Place { return std::uint64_t{row} << 32U | column; }
auto row_of(Place p) -> std::size_t { return p >> 32U; }
auto column_of(Place p) -> std::size_t { return p & 0xffffffffU; }

auto place_of(const Mesh& mesh, const Triangle& t, Point3 low, double size) -> Place {
  const Point3 sum = mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]];
  const auto axis = [&](double v, double from) {
    return static_cast<std::size_t>(std::max(0.0, std::floor((v / 3 - from) / size)));
  };
  return place(axis(sum.y, low.y), axis(sum.x, low.x));
}

auto counts_of(const Mesh& mesh, Point3 low, double size) -> std::map<Place, std::size_t> {
  std::unordered_map<Place, std::size_t> counts;
  for (const auto& t : mesh.triangles) ++counts[place_of(mesh, t, low, size)];
  return {counts.begin(), counts.end()};
}

/// The side of level 0's tiles: halved until the fullest has few enough, or would be no bigger than a house.
auto tile_size(const Mesh& mesh, const Box3& box, std::size_t most) -> double {
  constexpr double least = 16;  // m
  double size = std::max({box.most.x - box.least.x, box.most.y - box.least.y, 1.0});
  size = std::nextafter(size, 2 * size);  // the far side is inside
  if (mesh.triangles.size() <= most) return size;
  while (size > 2 * least) size /= 2;
  // From the smallest up: four tiles make one, exactly, since sizes differ by powers of two.
  auto counts = counts_of(mesh, box.least, size);
  while (counts.size() > 1) {
    std::map<Place, std::size_t> larger;
    std::size_t fullest = 0;
    for (const auto& [p, count] : counts)
      fullest = std::max(fullest, larger[place(row_of(p) / 2, column_of(p) / 2)] += count);
    if (fullest > most) break;
    counts = std::move(larger);
    size *= 2;
  }
  return size;
}

auto tile_of(const Mesh& mesh, std::span<const std::uint32_t> group) -> Tile {
  Tile tile;
  std::vector<std::uint32_t> used;
  used.reserve(3 * group.size());
  for (const auto t : group) used.insert(used.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
  std::ranges::sort(used);
  used.erase(std::ranges::unique(used).begin(), used.end());
  Box3 box;
  for (const auto v : used) box.add(mesh.vertices[v]);
  tile.low = box.least;
  tile.high = box.most;
  // A whole metre: what is added back is exact.
  const Point3 middle = 0.5 * (box.least + box.most);
  tile.centre = {std::round(middle.x), std::round(middle.y), std::round(middle.z)};
  tile.positions.reserve(3 * used.size());
  for (const auto v : used) {
    const Point3 p = mesh.vertices[v] - tile.centre;
    for (const double c : {p.x, p.y, p.z}) tile.positions.push_back(static_cast<float>(c));
  }
  tile.triangles.reserve(3 * group.size());
  for (const auto t : group)
    for (const auto v : mesh.triangles[t])
      tile.triangles.push_back(static_cast<std::uint32_t>(std::ranges::lower_bound(used, v) - used.begin()));
  return tile;
}

/// Level `level` of the tiles, in the order of their rows.
void add_level(const Mesh& mesh, Point3 low, double size, std::size_t level, double cell, const base::Run& run,
               const TakeTile& take) {
  std::vector<Place> place_of_tile;
  std::vector<std::size_t> starts{0};
  std::unordered_map<Place, std::size_t> next;
  for (const auto& [p, count] : counts_of(mesh, low, size)) {
    place_of_tile.push_back(p);
    next[p] = starts.back();
    starts.push_back(starts.back() + count);
  }
  if (run.cancelled()) return;
  // The places are computed twice rather than kept: 8 bytes a triangle would be half as much as the mesh.
  std::vector<std::uint32_t> order(mesh.triangles.size());
  for (std::uint32_t t = 0; t < order.size(); ++t) order[next[place_of(mesh, mesh.triangles[t], low, size)]++] = t;
  for (std::size_t first = 0; first < place_of_tile.size(); first += at_a_time) {
    if (run.cancelled()) return;
    std::vector<Tile> made(std::min(at_a_time, place_of_tile.size() - first));
    base::parallel_for(made.size(), [&](std::size_t k) {
      if (run.cancelled()) return;
      const std::size_t i = first + k;
      Tile& tile = made[k] = tile_of(mesh, std::span(order).subspan(starts[i], starts[i + 1] - starts[i]));
      tile.level = level;
      tile.row = row_of(place_of_tile[i]);
      tile.column = column_of(place_of_tile[i]);
      tile.cell = cell;
    });
    if (run.cancelled()) return;
    for (auto& tile : made) take(std::move(tile));
  }
}

}  // namespace

void tiles(const Mesh& mesh, const TileOptions& options, const base::Run& run, const TakeTile& take) {
  if (mesh.triangles.empty()) return;
  const Box3 box = box_of(mesh);
  if (run.cancelled()) return;
  double size = tile_size(mesh, box, options.most), cell = options.error;
  run.report("tiles", "level 0", 0);
  add_level(mesh, box.least, size, 0, 0, run, take);

  std::size_t before = mesh.triangles.size();
  const double extent = std::max({box.most.x - box.least.x, box.most.y - box.least.y, box.most.z - box.least.z});
  for (std::size_t level = 1; before > options.coarsest && cell < extent; ++level) {
    // Clustering the mesh itself, not the level before: a vertex moves within one cell, errors do not add up.
    std::optional<Mesh> coarse;
    for (;; cell *= 2) {
      if (run.cancelled()) return;
      const bool last = cell >= extent;
      coarse = clustered(mesh, box.least, cell, last ? mesh.triangles.size() : before / 2, run);
      if (run.cancelled()) return;
      if (coarse) break;  // else it is hardly worth a level
    }
    size *= 2;
    run.report("tiles", "level " + std::to_string(level),
               1 - static_cast<double>(coarse->triangles.size()) / static_cast<double>(mesh.triangles.size()));
    add_level(*coarse, box.least, size, level, cell, run, take);
    before = coarse->triangles.size();
    cell *= 2;
  }
}

auto tiles(const Mesh& mesh, const TileOptions& options, const base::Run& run) -> std::vector<Tile> {
  std::vector<Tile> out;
  tiles(mesh, options, run, [&](Tile tile) { out.push_back(std::move(tile)); });
  if (run.cancelled()) return {};
  return out;
}

}  // namespace mansard::picture
