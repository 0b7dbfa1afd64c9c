// Meshes in, with footprints or without: what reconstruct and segment begin with.
#pragma once

#include <filesystem>
#include <vector>

#include "mansard/pipeline/pipeline.hpp"

namespace mansard::pipeline {

struct InputPaths {
  std::vector<std::filesystem::path> meshes;
  std::filesystem::path footprints;  ///< empty: none
  bool derive_footprints = false;    ///< draw them from the mesh: only where none are given
};

/// Inputs as somebody typed them, sorted by what their names say.
struct TypedInputs {
  InputPaths paths;          ///< the meshes, then the footprints
  bool wrong_order = false;  ///< the footprints were typed before a mesh
};

/// Whether the name says that the file has footprints and no mesh, by its extension.
[[nodiscard]] auto is_footprints_name(const std::filesystem::path& path) -> bool;
/// Whether the name says that this is a mesh, points, a raster of heights, or a folder of them.
[[nodiscard]] auto is_mesh_name(const std::filesystem::path& path) -> bool;

/// Meshes and then footprints, two names or more. In another order only where the names leave no doubt: one is of
/// footprints, and the last one is of a mesh. This is the one place that knows the order.
[[nodiscard]] auto in_order(const std::vector<std::filesystem::path>& typed) -> TypedInputs;

/// The scene of these files; its footprints are those of the file, or derive::footprints of the mesh: then all of the
/// mesh is read, whatever the box, and derived footprints that do not meet the box are surroundings. Fails as
/// ingest::read_scene and derive::footprints do, and with "pipeline-footprints" where footprints are neither given nor
/// to be derived, or both.
[[nodiscard]] auto read_inputs(const InputPaths& paths, const Options& options, const base::Run& run = {})
    -> base::Result<model::Scene>;

/// The same with the mesh in cells on disk where it is large (ingest::read_city) and the footprints are not derived
/// from it.
[[nodiscard]] auto read_city_inputs(const InputPaths& paths, const Options& options, const base::Run& run = {})
    -> base::Result<ingest::CityScene>;

}  // namespace mansard::pipeline
