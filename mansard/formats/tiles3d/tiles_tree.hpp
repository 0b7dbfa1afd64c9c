// Which buildings share a tile.
#pragma once

#include <cstdint>
#include <vector>

#include "mansard/geometry/points.hpp"

namespace mansard::formats::detail {

/// What is kept of a building in memory until the last one is known: 88 bytes.
struct TileItem {
  geometry::Point2 centre;  ///< local frame
  double ground = 0;        ///< z, metres
  double height = 0;        ///< m, of its highest point above its lowest: the error where it is left out
  double flat_error = 0;    ///< m, the furthest that its roof is above or below that of LoD 1.2
  double volume = 0;        ///< m³, about: what is kept first where not all can be
  std::uint64_t fine = 0, coarse = 0, end = 0;  ///< where its two models stand in the spool
  std::uint32_t triangles = 0, flat_triangles = 0;
};

/// A node of the tree: buildings first … first + count − 1 of its order.
struct Tile {
  std::size_t first = 0, count = 0;
  std::vector<std::size_t> children;  ///< numbers of tiles; none of a leaf
  std::vector<std::uint8_t> path;     ///< which child of which, from the root
};

struct TileTree {
  std::vector<std::uint32_t> order;  ///< items as the tiles have them
  std::vector<Tile> tiles;           ///< parents before their children; the first is the root
};

/// Halves the buildings at the median of their triangles across the longer side of their centres, twice a level, until
/// a tile has no more than that many triangles, or one building. Without items a root alone.
[[nodiscard]] auto tile_tree(const std::vector<TileItem>& items, double triangles) -> TileTree;

}  // namespace mansard::formats::detail
