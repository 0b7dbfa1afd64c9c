// One mesh file of any format.
#pragma once

#include <filesystem>
#include <string>

#include <optional>
#include <set>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/formats/mesh/mesh_formats.hpp"
#include "mansard/formats/mesh/raw_mesh.hpp"
#include "mansard/formats/tiles3d/tileset.hpp"
#include "mansard/model/frame.hpp"

namespace mansard::formats {

/// A mesh, with what was read of it.
struct MeshPiece {
  RawMesh mesh;
  std::size_t vertices = 0, triangles = 0;  ///< what was of the mesh, where it has been put aside since
  std::vector<model::InputFile> inputs;
  std::vector<base::Diagnostic> warnings;
  std::set<std::string> skipped;  ///< kinds of tiles that were not read
  std::optional<base::Diagnostic> failure;
};

/// Whether it is one of the formats that a folder is searched for, by its name.
[[nodiscard]] auto is_mesh_name(const std::filesystem::path& path) -> bool;

/// By what the file starts with, where formats say so themselves, else by its name; z up. `failure` has
/// "ingest-mesh-empty", "ingest-mesh-format", "ingest-mesh-truncated", "ingest-memory", "file-missing", "file-read".
[[nodiscard]] auto read_mesh_file(const std::filesystem::path& path, UpAxis up) -> MeshPiece;
[[nodiscard]] auto read_tile_file(const TileFile& tile) -> MeshPiece;

}  // namespace mansard::formats
