// Tilesets of OGC 3D Tiles 1.0 and 1.1: which of their files hold the mesh, at the level and in the place asked for.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/formats/mesh/mesh_formats.hpp"
#include "mansard/formats/tiles3d/tile_volume.hpp"
#include "mansard/model/frame.hpp"

namespace mansard::formats {

/// A tile's file, and how its content gets to the tileset's coordinates.
struct TileFile {
  std::filesystem::path path;
  Transform turn;   ///< glTF's axes to z up
  Transform place;  ///< from the tile's coordinates to the tileset's
};

struct TileList {
  std::vector<TileFile> files;           ///< in the order of the tree
  std::vector<model::InputFile> inputs;  ///< tilesets and subtrees that were read
  std::size_t beside = 0;  ///< tiles that were left out with all below them, since they do not reach into the box
};

class Tileset {
 public:
  /// Reads the tree's own file, not those it names. Fails with "ingest-mesh-format", "file-missing", "file-read".
  [[nodiscard]] static auto open(const std::filesystem::path& path) -> base::Result<Tileset>;

  /// Whether coordinates are geocentric (EPSG:4978), as the standard has it, rather than those of a local or projected
  /// frame, as some programs write them: so for a region, and where the root's middle is near the ellipsoid.
  [[nodiscard]] auto is_geocentric() const -> bool { return geocentric_; }
  /// The middle of the root's volume.
  [[nodiscard]] auto middle() const -> geometry::Point3 { return middle_; }
  /// Box in plan of the root's volume; empty where it is geocentric.
  [[nodiscard]] auto plan() const -> const geometry::Box2& { return plan_; }

  /// Descends while a tile's geometric error exceeds `error` (m), or it is empty. `up` as in Options. Reads tilesets
  /// inside the tileset, but no tile. Fails with "ingest-mesh-format", "file-missing", "file-read", "cancelled".
  [[nodiscard]] auto tiles(double error, UpAxis up, const TileFilter& filter, const base::Run& run) const
      -> base::Result<TileList>;

 private:
  std::filesystem::path path_;
  bool geocentric_ = false;
  geometry::Point3 middle_;
  geometry::Box2 plan_;
};

/// The file that a URI in `file` names: beside it on disk, in its archive or on its server, or on another server.
[[nodiscard]] auto address_beside(const std::filesystem::path& file, const std::string& uri) -> std::filesystem::path;

}  // namespace mansard::formats
