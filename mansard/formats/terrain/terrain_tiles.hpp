// A terrain as 3D Tiles 1.1 with levels of detail.
#pragma once

#include <filesystem>
#include <optional>

#include "mansard/base/result.hpp"
#include "mansard/crs/globe.hpp"
#include "mansard/formats/stream.hpp"
#include "mansard/geometry/mesh.hpp"

namespace mansard::formats::detail {

/// The terrain in tiles, and above every four of them one that replaces them from afar. Leaves have the terrain as it
/// is. A tile above has `below`, the ground under the buildings, too, and about a quarter of the triangles, at most as
/// many as a leaf, where its border leaves that. Corners on the border of a tile stay, so that tiles of different
/// levels meet without cracks. The geometric error of a tile is the largest vertical distance of its surface from the
/// corners of the tiles that it replaces, and theirs. Fails with "file-write", "write-glb-size", and as the
/// transformation does. Cost: O(n log n) for n triangles.
[[nodiscard]] auto write_terrain_tiles(const std::filesystem::path& folder, const geometry::Mesh& terrain,
                                       const geometry::Mesh& below, const Header& header, const WriteOptions& options,
                                       const std::optional<crs::Globe>& globe) -> base::Result<void>;

}  // namespace mansard::formats::detail
