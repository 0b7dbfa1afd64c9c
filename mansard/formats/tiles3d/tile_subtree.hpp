// Implicit tiling of 3D Tiles: which tiles of a regular tree there are, a bit each, in files of a few levels.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/formats/tiles3d/tile_volume.hpp"
#include "mansard/model/frame.hpp"

namespace mansard::formats {

/// Place of a tile in its tree.
struct TileIndex {
  std::uint32_t level = 0;
  std::array<std::uint64_t, 3> at{0, 0, 0};  ///< the third is 0 in a quadtree
};

/// The part of the root's volume that is a tile's; nothing where the root's is not known.
[[nodiscard]] auto part_of(const Volume& root, const TileIndex& index, bool octree) -> Volume;

/// "{level}", "{x}", "{y}", "{z}" of a template filled in.
[[nodiscard]] auto filled_in(std::string address, const TileIndex& index) -> std::string;

class Subtree {
 public:
  /// Fails with "ingest-mesh-format", "ingest-mesh-truncated", "file-missing", "file-read". The files that were read
  /// go to `inputs`.
  [[nodiscard]] static auto read(const std::filesystem::path& path, std::uint32_t levels, bool octree,
                                 std::vector<model::InputFile>& inputs) -> base::Result<Subtree>;
  /// `local` counts from the root of this subtree; at the level after its last it is the root of another subtree.
  [[nodiscard]] auto has_tile(const TileIndex& local) const -> bool;
  [[nodiscard]] auto has_content(std::size_t which, const TileIndex& local) const -> bool;

 private:
  struct Bits {
    bool all = false;
    std::vector<bool> each;
    [[nodiscard]] auto at(std::uint64_t i) const -> bool { return each.empty() ? all : i < each.size() && each[i]; }
  };
  friend class SubtreeReader;
  std::uint32_t levels_ = 0;
  bool octree_ = false;
  Bits tiles_, children_;
  std::vector<Bits> contents_;
};

}  // namespace mansard::formats
