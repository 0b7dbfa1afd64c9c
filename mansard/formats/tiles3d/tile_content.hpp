// What a tile of 3D Tiles holds: glTF, alone, with a header (b3dm), or several in one file (cmpt).
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/formats/mesh/raw_mesh.hpp"
#include "mansard/formats/mesh/transform.hpp"
#include "mansard/model/frame.hpp"

namespace mansard::formats {

struct TileContent {
  RawMesh mesh;                           ///< in the coordinates that `place` leads to
  std::vector<model::InputFile> buffers;  ///< files beside it that were read
  std::set<std::string> skipped;          ///< kinds of content without a surface that is read: "pnts", "i3dm", …
};

/// `turn` brings glTF's axes to z up, `place` the tile's coordinates to the tileset's. Fails with
/// "ingest-mesh-format", "ingest-mesh-truncated", "ingest-mesh-empty", "file-missing", "file-read".
[[nodiscard]] auto read_tile_content(std::string_view bytes, const std::filesystem::path& path, const Transform& turn,
                                     const Transform& place) -> base::Result<TileContent>;

}  // namespace mansard::formats
