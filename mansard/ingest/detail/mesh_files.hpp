// From the paths on the command line to one raw mesh in the working CRS.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/cloud/cloud.hpp"
#include "mansard/crs/mesh_crs.hpp"
#include "mansard/formats/mesh/mesh_file.hpp"
#include "mansard/formats/points.hpp"
#include "mansard/formats/tiles3d/tileset.hpp"
#include "mansard/ingest/cells.hpp"
#include "mansard/ingest/detail/spooled_mesh.hpp"
#include "mansard/ingest/ingest.hpp"
#include "mansard/ingest/textured.hpp"

namespace mansard::ingest::detail {

struct MeshFiles {
  formats::RawMesh mesh;            ///< of all files, z up, in the working CRS but for the offset
  std::uint64_t vertices_read = 0;  ///< of all files, also of those that are in the cells
  std::vector<model::InputFile> inputs;
  std::vector<base::Diagnostic> warnings;
  std::optional<cloud::Ground>
      ground;               ///< of point clouds with classified ground, in the working CRS but for the offset
  bool roofs_only = false;  ///< all are clouds in which no point can be ground
  std::vector<cloud::GroundTile> counted;  ///< the points of point clouds, likewise
};

/// Reading in two steps, since the working CRS is chosen between them: files that say where they are only by their
/// numbers are read first, tilesets and rasters once it is known where to.
class MeshReading {
 public:
  /// Lists folders, reads mesh files, opens tilesets and rasters. Fails with "ingest-mesh-empty",
  /// "ingest-mesh-format", "ingest-mesh-truncated", "ingest-mesh-metadata", "ingest-memory", "file-missing",
  /// "file-read", "cancelled".
  /// With `cells`, the meshes go there instead of into memory: those of files that no other CRS can be meant by at
  /// once.
  [[nodiscard]] static auto open(const std::vector<std::filesystem::path>& paths, const Options& options,
                                 const base::Run& run, MeshCells* cells = nullptr) -> base::Result<MeshReading>;

  /// Box in plan, with the offset, of what is not placed on the earth, as its files have it; empty for none.
  [[nodiscard]] auto plan() const -> geometry::Box2;
  /// The first projected CRS in metres that a mesh says it is in; empty for none.
  [[nodiscard]] auto own_crs() const -> std::string;
  /// The same, or else the UTM zone of the first mesh that is placed on the earth.
  [[nodiscard]] auto own_crs_or_zone() const -> std::string;

  /// `working` names the CRS, empty for a local frame; `within` is a box in it: what lies beside it need not be read.
  /// With cells, the mesh that is returned is empty. Fails as `open` does, and with "ingest-mesh-unusable",
  /// "ingest-no-overlap", "ingest-crs-unknown", "ingest-raster". Can be called once.
  [[nodiscard]] auto finish(const std::string& working, const std::optional<geometry::Box2>& within,
                            const base::Run& run) -> base::Result<MeshFiles>;

  /// The meshes with their textures, in the working CRS but for the offset, piece by piece. Returns warnings.
  [[nodiscard]] static auto each_textured(const std::vector<std::filesystem::path>& paths, const Options& options,
                                          const std::string& working, const geometry::Box2& within,
                                          const TakeColours& take, const base::Run& run)
      -> base::Result<std::vector<base::Diagnostic>>;

 private:
  enum class Kind { file, tileset, raster, cloud };
  struct Source {
    Kind kind = Kind::file;
    std::filesystem::path path;
    std::optional<crs::MeshCrs> crs;          ///< what it says of itself, or metadata.xml says for it
    bool by_metadata = false;                 ///< … the latter
    std::optional<formats::Tileset> tileset;  ///< of a tileset
    formats::MeshPiece piece;                 ///< of a file; without its mesh where that is in the cells
    geometry::Box2 plan;                      ///< of a file or a raster
    bool in_cells = false;
    std::shared_ptr<SpooledMesh> spooled;  ///< of a file of any size that goes to the cells when it is known where to
    std::vector<formats::TileFile> tiles;  ///< of a tileset
    std::shared_ptr<const formats::PointCloud> cloud;
    std::optional<crs::WayOfMesh> way;  ///< to the working CRS; none where coordinates stay
  };

  MeshReading(const Options& options, MeshCells* cells) : options_(options), cells_(cells) {}
  [[nodiscard]] auto list(const std::vector<std::filesystem::path>& paths) -> base::Result<void>;
  [[nodiscard]] auto list_folder(const std::filesystem::path& folder) -> base::Result<void>;
  [[nodiscard]] auto find_places(const base::Run& run) -> base::Result<void>;
  [[nodiscard]] auto moved_by_option() const -> bool;
  [[nodiscard]] auto place_of(const Source& source) const -> std::optional<geometry::Point3>;
  [[nodiscard]] auto choose_ways(const std::string& working) -> base::Result<void>;
  [[nodiscard]] auto list_tiles(const std::optional<geometry::Box2>& within, const base::Run& run)
      -> base::Result<void>;
  [[nodiscard]] auto read_placed(Source& source, const std::optional<geometry::Box2>& within, const base::Run& run)
      -> std::vector<formats::MeshPiece>;
  void into_cells(formats::MeshPiece& piece);
  [[nodiscard]] auto streamed(Source& source, const base::Run& run) -> base::Result<bool>;
  [[nodiscard]] auto into_cells(SpooledMesh& mesh, Source& source, const base::Run& run) -> base::Result<void>;
  [[nodiscard]] auto colours_of_clouds(const geometry::Box2& within, const TakePoints& take, const base::Run& run) const
      -> base::Result<void>;
  [[nodiscard]] auto surface_of_clouds(const std::optional<geometry::Box2>& within, const base::Run& run,
                                       MeshFiles& out) -> base::Result<std::vector<formats::MeshPiece>>;

  Options options_;
  MeshCells* cells_ = nullptr;
  std::vector<Source> sources_;
  std::map<std::filesystem::path, model::InputFile> metadata_;  ///< by folder
  std::vector<model::InputFile> inputs_;
  std::vector<base::Diagnostic> warnings_;
  std::size_t tiles_beside_ = 0;
};

}  // namespace mansard::ingest::detail
