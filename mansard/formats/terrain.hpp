// The terrain around buildings as a file.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "mansard/formats/stream.hpp"
#include "mansard/geometry/mesh.hpp"

namespace mansard::formats {

/// The formats that a terrain is written in: CityJSON and CityJSONSeq (a TINRelief), GLB, 3D Tiles; and STL, for a
/// surface that is closed with the buildings. By the file extension; none for others.
[[nodiscard]] auto terrain_format_of(const std::filesystem::path& path) -> std::optional<Format>;
/// Their file extensions: ".city.json, …".
[[nodiscard]] auto terrain_extensions() -> std::string;

/// Triangles in the local frame, on the grid of files, each corner once in `mesh.vertices`. The file is there after
/// Outputs::commit. Guarantee: corners have the coordinates that models have in a file of the same format. Returns
/// warnings. Fails with "file-write", "write-tiles-crs", "write-stl-size", "write-glb-size".
[[nodiscard]] auto write_terrain(Format format, const std::filesystem::path& path, const geometry::Mesh& mesh,
                                 const Header& header, const WriteOptions& options, base::Outputs& outputs)
    -> base::Result<std::vector<base::Diagnostic>>;

}  // namespace mansard::formats
