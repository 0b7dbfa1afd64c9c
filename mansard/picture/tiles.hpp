// A big mesh as tiles of several levels, for views that must stay fluid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "mansard/base/run.hpp"
#include "mansard/geometry/mesh.hpp"

namespace mansard::picture {

/// A piece of a mesh at one level: single precision, about its centre.
struct Tile {
  std::size_t level = 0;            ///< 0: as it is; each further one about a quarter of the triangles
  std::size_t column = 0, row = 0;  ///< in the grid of its level's tiles; (column / 2, row / 2) covers it a level up
  double cell = 0;                  ///< m; of the vertices that its level makes one; 0 at level 0
  geometry::Point3 low, high;       ///< box, metres
  geometry::Point3 centre;          ///< what positions are relative to
  std::vector<float> positions;     ///< x y z
  std::vector<std::uint32_t> triangles;
};

struct TileOptions {
  std::size_t most = 60'000;       ///< triangles that a tile of level 0 has at most, but for tiles of 16 to 32 m
  double error = 0.25;             ///< m; cell of the vertices that level 1 makes one
  std::size_t coarsest = 300'000;  ///< triangles; levels are made until one is this small
};

/// Level 0 is the mesh; each further level has the vertices of every cell of a grid as their mean. Cells double with
/// every level, more than once where that would leave more than half of the triangles. Tiles of one level have the same
/// size, those of level n + 1 twice that of level n; a triangle belongs to the tile that its centre is in.
/// Guarantees: 1 every triangle of the mesh is in one tile of level 0, as it is · 2 no point of a level lies farther
/// from the mesh than its cell's diagonal · 3 a vertex is at the same place in every tile of its level, to single
/// precision: there are no gaps between tiles · 4 the same mesh gives the same tiles at any thread count. What is
/// smaller than a cell vanishes. Empty when cancelled. Cost: O(n log n) for n triangles.
[[nodiscard]] auto tiles(const geometry::Mesh& mesh, const TileOptions& options = {}, const base::Run& run = {})
    -> std::vector<Tile>;

using TakeTile = std::function<void(Tile)>;
/// The same, given one after the other in the same order and on this thread: a few are in memory at a time. When
/// cancelled, some are missing.
void tiles(const geometry::Mesh& mesh, const TileOptions& options, const base::Run& run, const TakeTile& take);

}  // namespace mansard::picture
