// Reads building models of any maker, and the mesh that they are held against, into one frame.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/ingest/ingest.hpp"

namespace mansard::ingest {

/// What a surface is. The numbers are those of the face property `class` in PLY files.
enum class SurfaceClass : std::uint8_t { wall, roof, ground, other };
inline constexpr std::size_t surface_class_count = 4;
[[nodiscard]] auto to_string(SurfaceClass kind) -> std::string_view;

/// A plane polygon of a model.
struct ModelFace {
  std::vector<std::vector<geometry::Point3>> loops;  ///< metres, local frame; outer loop first, then holes; open
  SurfaceClass kind = SurfaceClass::other;
  bool by_normal = false;  ///< the file does not say what it is: told by its direction
};

struct ModelPart {
  std::string id;
  std::vector<ModelFace> faces;
};

struct ModelBuilding {
  std::string id;
  std::vector<ModelPart> parts;
};

struct Model {
  std::vector<ModelBuilding> buildings;  ///< in the file's order; none without a face
  Frame frame;                           ///< `crs` without a vertical part
  std::string lod;                       ///< "2.2", or several: "1.2, 2.2"; empty where the format has none
  std::vector<InputFile> inputs;
  std::vector<base::Diagnostic> warnings;
};

struct ModelOptions {
  std::string lod;  ///< "2.2", or "2" for all that begin so; empty: the highest of each object
  std::string crs;  ///< the CRS to work in, as Options::crs; a model is never projected
};

/// Reads CityJSON 1.0 to 2.0, CityJSONSeq, or OBJ: docs/ingest.md says what is read of each. Guarantees: 1 all
/// coordinates are finite and local · 2 every building has a part, every part a face, every face an outer loop of three
/// corners or more · 3 what was left out or told by its direction is among the warnings.
/// Gives up with "ingest-model-format", "ingest-model-empty", "ingest-model-lod", "ingest-model-crs", "file-…".
[[nodiscard]] auto read_model(const std::filesystem::path& path, const ModelOptions& options = {})
    -> base::Result<Model>;

/// The same model in another frame. Gives up with "ingest-model-crs" where the frames' CRS differ (both are known).
[[nodiscard]] auto in_frame(Model model, const Frame& frame) -> base::Result<Model>;

/// A model as triangles; what belongs to which is kept per triangle.
struct ModelSurface {
  geometry::Mesh mesh;
  std::vector<SurfaceClass> classes;
  std::vector<std::uint32_t> buildings;  ///< index into Model::buildings
  std::vector<std::uint32_t> parts;      ///< counted through all buildings
  std::vector<std::uint32_t> faces;      ///< counted through all parts
  std::size_t lost = 0;                  ///< faces that cannot be cut into triangles, left out
};
[[nodiscard]] auto surface_of(const Model& model) -> ModelSurface;
/// The triangles of those buildings that are true in `buildings`, which has one entry for each.
[[nodiscard]] auto part_of(const ModelSurface& surface, const std::vector<bool>& buildings) -> ModelSurface;

/// A mesh without footprints.
struct ScannedMesh {
  geometry::Mesh mesh;                ///< local frame
  std::vector<SurfaceClass> classes;  ///< per triangle, of a PLY file with the face property `class`; else empty
  MeshCounts counts;
  std::vector<InputFile> inputs;
  std::vector<base::Diagnostic> warnings;
};

/// Reads meshes as read_scene does, into a frame that is known already: what says where it is goes to its CRS, the rest
/// is taken to be in it, with `options.mesh_offset`. Guarantees 1 and 2 of read_scene. Gives up with "ingest-mesh-…",
/// "ingest-crs-unknown", "ingest-raster", "file-…", "cancelled".
[[nodiscard]] auto read_mesh(const std::vector<std::filesystem::path>& paths, const Frame& frame,
                             const Options& options, const base::Run& run = {}) -> base::Result<ScannedMesh>;

/// Gives up with "ingest-model-overlap", which names both extents in file coordinates, where two surfaces of one frame
/// lie apart, in plan or in height. `what` names them: "model", "mesh".
[[nodiscard]] auto check_overlap(const geometry::Mesh& first, const geometry::Mesh& second,
                                 const std::pair<std::string, std::string>& what, const Frame& frame,
                                 const std::string& subject) -> base::Result<void>;

}  // namespace mansard::ingest
