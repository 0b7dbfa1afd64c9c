#include "mansard/vegetation/vegetation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mansard/vegetation/detail/surface.hpp"

namespace mansard::vegetation {
namespace {

using detail::Blob;
using detail::Grid;
using detail::Surface;
using geometry::Box2;

// The surface is looked at in tiles, so that memory does not grow with the block. A crown belongs to the tile in which
// its first cell is, and is no longer than the margin around a tile: where tiles begin does not matter.
constexpr double tile_side = 128;  // m
constexpr double halo_width = 16;  // m

struct Tile {
  Grid grid;
  std::vector<std::uint32_t> triangles;
};

struct Tiles {
  std::vector<Tile> tiles;
  std::size_t halo = 0;  ///< cells
};

/// The first begins where the region does: that of a block of a few houses is one tile.
auto tiles_of(const geometry::Mesh& mesh, const Box2& region, const Options& options) -> Tiles {
  const auto side = static_cast<std::int64_t>(std::ceil(tile_side / options.grid));
  const auto halo = static_cast<std::int64_t>(std::ceil(halo_width / options.grid));
  const auto cell_at = [&](double v) { return static_cast<std::int64_t>(std::floor(v / options.grid)); };
  const std::int64_t west = cell_at(region.least.x), east = cell_at(region.most.x) + 1;
  const std::int64_t south = cell_at(region.least.y), north = cell_at(region.most.y) + 1;
  Tiles out{{}, static_cast<std::size_t>(halo)};
  for (std::int64_t y = south; y < north; y += side)
    for (std::int64_t x = west; x < east; x += side)
      out.tiles.push_back(
          {{options.grid, x - halo, y - halo, static_cast<std::size_t>(std::min(x + side, east) - x + 2 * halo),
            static_cast<std::size_t>(std::min(y + side, north) - y + 2 * halo)},
           {}});
  const std::int64_t columns = (east - west + side - 1) / side, rows = (north - south + side - 1) / side;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    Box2 box;
    for (const auto v : mesh.triangles[t]) box.add(xy(mesh.vertices[v]));
    const Box2 reach = box.grown(static_cast<double>(halo + 1) * options.grid);
    if (!reach.overlaps(region)) continue;
    const auto tile_at = [&](double v, std::int64_t first, std::int64_t count) {
      const std::int64_t cell = cell_at(v) - first;
      return cell < 0 ? std::int64_t{0} : std::min(cell / side, count - 1);
    };
    const auto last_row = tile_at(reach.most.y, south, rows), last_column = tile_at(reach.most.x, west, columns);
    for (auto row = tile_at(reach.least.y, south, rows); row <= last_row; ++row)
      for (auto column = tile_at(reach.least.x, west, columns); column <= last_column; ++column)
        out.tiles[static_cast<std::size_t>(row * columns + column)].triangles.push_back(t);
  }
  return out;
}

/// Above which z a crown's triangles are, per cell of the surface; infinite elsewhere.
/// `over_all`: whether it covers most of a building.
void lower(std::vector<double>& floor, const Blob& blob, const Surface& surface,
           std::span<const geometry::Polygon> outline, bool over_all, const Options& options) {
  constexpr double deeper = 0.3;  // m: noise, and the sides of the outermost cells
  constexpr double below = 1.0;   // m: what is so far under a crown's lowest does not carry it
  const auto& grid = surface.grid;
  const auto reach = static_cast<std::int64_t>(std::round(options.margin / grid.spacing));
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto c : blob.cells) lowest = std::min(lowest, surface.top[c]);
  std::vector<geometry::Point2> hanging;
  for (const auto c : blob.cells)
    if (!std::isnan(surface.under[c])) hanging.push_back(grid.centre(c));
  // A roof beside a crown that is too narrow to be told from it is in one region with it, but hangs over nothing.
  const auto is_roof = [&](std::uint32_t cell) {
    if (blob.dome) return false;
    const auto at = grid.centre(cell);
    // Nor is a small building nothing but crown because one touches it.
    if (over_all) return std::isnan(surface.under[cell]);
    return geometry::contains(outline, at) &&
           std::ranges::none_of(hanging, [&](geometry::Point2 p) { return length(p - at) <= options.near_underside; });
  };
  for (const auto c : blob.cells) {
    if (is_roof(c)) continue;
    detail::each_around(grid, c, reach, [&](std::size_t cell, std::int64_t, std::int64_t) {
      const double top = surface.top[cell];
      if (!(top > lowest - below)) return;
      const double under = surface.under[cell];
      floor[cell] = std::min(floor[cell], (std::isnan(under) ? top : under) - deeper);
    });
  }
}

}  // namespace

auto find(const geometry::Mesh& mesh, std::span<const geometry::Polygon> outline,
          std::span<const std::vector<geometry::Polygon>> footprints, const Options& options, const base::Run& run)
    -> Found {
  Found out;
  Box2 region = geometry::bounds(outline);
  if (!options.mask || region.empty() || mesh.triangles.empty()) return out;
  region = region.grown(options.reach);
  const auto [tiles, halo] = tiles_of(mesh, region, options);
  std::vector<Found> each(tiles.size());
  base::parallel_for(tiles.size(), [&](std::size_t i) {
    if (run.cancelled()) return;
    const auto surface = detail::surface_of(mesh, tiles[i].triangles, tiles[i].grid);
    auto blobs = detail::blobs_of(surface, halo, outline, options);
    std::erase_if(blobs, [&](const Blob& blob) { return !detail::is_crown(blob, options); });
    if (blobs.empty()) return;
    const auto& grid = surface.grid;
    std::vector<double> floor(grid.size(), std::numeric_limits<double>::infinity());
    for (const auto& blob : blobs) {
      const bool over_all = detail::covers_any(blob, grid, footprints);
      // A scan rounds a shed until it has the shape of a crown; but a tree is not just as large as what it stands over.
      if (over_all && blob.seen.inside > blob.seen.area / 2) continue;
      if (detail::is_annex(blob, surface, outline)) continue;
      each[i].crowns.push_back(blob.seen);
      lower(floor, blob, surface, outline, over_all, options);
    }
    // The sides of a crown are steep: what is next to a cell counts with it.
    floor = detail::least_around(grid, floor, 1);
    for (const auto t : tiles[i].triangles) {
      const auto& [a, b, c] = mesh.triangles[t];
      const auto middle = (1.0 / 3) * (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]);
      const auto column = static_cast<std::int64_t>(std::floor(middle.x / grid.spacing)) - grid.column;
      const auto row = static_cast<std::int64_t>(std::floor(middle.y / grid.spacing)) - grid.row;
      if (column < 0 || row < 0 || column >= static_cast<std::int64_t>(grid.columns) ||
          row >= static_cast<std::int64_t>(grid.rows))
        continue;
      const double lowest = floor[static_cast<std::size_t>(row) * grid.columns + static_cast<std::size_t>(column)];
      if (middle.z >= lowest) each[i].triangles.push_back(t);
      if (lowest < std::numeric_limits<double>::infinity()) each[i].below.push_back(t);
    }
  });
  for (auto& one : each) {
    out.crowns.insert(out.crowns.end(), one.crowns.begin(), one.crowns.end());
    out.triangles.insert(out.triangles.end(), one.triangles.begin(), one.triangles.end());
    out.below.insert(out.below.end(), one.below.begin(), one.below.end());
  }
  std::ranges::stable_sort(out.crowns, {},
                           [](const Crown& crown) { return std::pair(crown.centre.y, crown.centre.x); });
  for (auto* list : {&out.triangles, &out.below}) {
    std::ranges::sort(*list);
    list->erase(std::ranges::unique(*list).begin(), list->end());
  }
  return out;
}

}  // namespace mansard::vegetation
