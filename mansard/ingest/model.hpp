// Reads building models of any producer, and the mesh that they are compared with, into one frame.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/ingest/ingest.hpp"
#include "mansard/model/surfaces.hpp"

namespace mansard::ingest {

struct ModelOptions {
  std::string lod;  ///< "2.2", or "2" for all that begin so; empty: the highest of each object
  std::string crs;  ///< the CRS to work in, as Options::crs; a model is never projected
};

/// Reads CityJSON 1.0 to 2.0, CityJSONSeq, or OBJ: docs/ingest.md says what is read of each. Guarantees: 1 all
/// coordinates are finite and local · 2 every building has a part, every part a face, every face an outer loop of three
/// corners or more · 3 what was left out or told by its direction is among the warnings.
/// Fails with "ingest-model-format", "ingest-model-empty", "ingest-model-lod", "ingest-model-crs", "file-…".
[[nodiscard]] auto read_model(const std::filesystem::path& path, const ModelOptions& options = {})
    -> base::Result<model::Model>;

/// The same model in another frame. Fails with "ingest-model-crs" where the frames' CRS differ (both are known).
[[nodiscard]] auto in_frame(model::Model model, const model::Frame& frame) -> base::Result<model::Model>;

/// A mesh without footprints.
struct ScannedMesh {
  geometry::Mesh mesh;                       ///< local frame
  std::vector<model::SurfaceClass> classes;  ///< per triangle, of a PLY file with the face property `class`; else empty
  model::MeshCounts counts;
  std::vector<model::InputFile> inputs;
  std::vector<base::Diagnostic> warnings;
};

/// Reads meshes as read_scene does, into a frame that is known already: what says where it is goes to its CRS, the rest
/// is taken to be in it, with `options.mesh_offset`. Guarantees 1 and 2 of read_scene. Fails with "ingest-mesh-…",
/// "ingest-crs-unknown", "ingest-raster", "file-…", "cancelled".
[[nodiscard]] auto read_mesh(const std::vector<std::filesystem::path>& paths, const model::Frame& frame,
                             const Options& options, const base::Run& run = {}) -> base::Result<ScannedMesh>;

/// Fails with "ingest-model-overlap", which names both extents in file coordinates, where two surfaces of one frame
/// lie apart, in plan or in height. `what` names them: "model", "mesh".
[[nodiscard]] auto check_overlap(const geometry::Mesh& first, const geometry::Mesh& second,
                                 const std::pair<std::string, std::string>& what, const model::Frame& frame,
                                 const std::string& subject) -> base::Result<void>;

}  // namespace mansard::ingest
