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
/// Outputs::commit. `below`: the ground under the buildings, which only 3D Tiles have, in tiles that are seen from
/// afar. Guarantee: corners have the coordinates that models have in a file of the same format. Returns warnings. Fails
/// with "file-write", "write-tiles-crs", "write-stl-size", "write-glb-size".
[[nodiscard]] auto write_terrain(Format format, const std::filesystem::path& path, const geometry::Mesh& mesh,
                                 const Header& header, const WriteOptions& options, base::Outputs& outputs,
                                 const geometry::Mesh& below = {}) -> base::Result<std::vector<base::Diagnostic>>;

/// What a CityJSON or CityJSONSeq has of terrain.
struct TerrainInfo {
  std::size_t others = 0;                                 ///< objects of other types: buildings
  std::size_t surfaces = 0, triangles = 0, vertices = 0;  ///< objects of the type TINRelief, and what they are made of
  geometry::Box3 box;                                     ///< in the coordinates of the file
  std::string crs, lod;                                   ///< "EPSG:n", "1"; empty where the file does not say
  std::optional<model::MadeBy> made_by;                   ///< of a file that mansard wrote
};

/// None where the file has no TINRelief, or cannot be read. A file without the word is not parsed.
[[nodiscard]] auto terrain_info(const std::filesystem::path& path) -> std::optional<TerrainInfo>;

}  // namespace mansard::formats
