// OSGB: the binary files of OpenSceneGraph, as photogrammetry programs write them, in trees of levels.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "mansard/formats/mesh/raw_mesh.hpp"
#include "mansard/formats/textured_mesh.hpp"
#include "mansard/model/frame.hpp"

namespace mansard::formats {

struct Osgb {
  TexturedMesh mesh;                     ///< z up; pictures and colours only where they were asked for
  std::uint64_t short_faces = 0;         ///< as of RawMesh
  std::vector<model::InputFile> inputs;  ///< the files below it that were read, in the order of the tree
};

/// Of a file and, through its levels of detail, the finest of the files below it that are there: what a level refers to
/// and is not there is a warning ("ingest-mesh-level"), and the coarser level takes its place. Files outside the folder
/// of `path` are not read. Fails with "ingest-mesh-format". Cost: linear in triangles; pictures stay compressed.
[[nodiscard]] auto read_osgb(std::string_view bytes, const std::filesystem::path& path, bool textured)
    -> base::Result<Osgb>;

/// The name that the file of the tile has, of which a file is a level by its name; empty for none.
[[nodiscard]] auto tile_of_level(const std::filesystem::path& path) -> std::filesystem::path;

}  // namespace mansard::formats
