// Reads meshes and footprints into one local, metric frame.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "mansard/base/options.hpp"
#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/cloud/cloud.hpp"
#include "mansard/formats/up_axis.hpp"
#include "mansard/ingest/cells.hpp"
#include "mansard/model/scene.hpp"

namespace mansard::ingest {

struct Options {
  std::array<double, 3> mesh_offset{0, 0, 0};  ///< metres, added to mesh coordinates once they are z up
  formats::UpAxis up = formats::UpAxis::automatic;
  /// The CRS to work in ("EPSG:n", or "local"); empty: the footprints', else the mesh's own, else the UTM zone.
  std::string crs;
  std::string id_attribute;  ///< empty: gml_id, id, fid … whichever the source has, else its feature number
  std::string layer;         ///< of the vector source; empty: its only or first one
  std::string where;         ///< OGR SQL attribute filter
  std::string encoding;      ///< of texts that are not UTF-8, as iconv names it; empty: what the source says
  /// xmin ymin xmax ymax in the working CRS: footprints whose box meets it, and the mesh around them; all zero:
  /// everything.
  std::array<double, 4> bbox{0, 0, 0, 0};
  double tile_error =
      0;                ///< metres; of a tileset, tiles are taken once their geometric error is no more; 0: the finest
  std::string terrain;  ///< path of a raster with the ground's heights; empty: none
  double cells_from = 400;            ///< MB of mesh files from which on read_city cuts the mesh into cells on disk
  double cell_side = 64;              ///< m
  double task_triangles = 2'000'000;  ///< of the mesh in cells, so many are in memory at a time
  double task_footprints = 2'000;     ///< without a mesh, the blocks of so many are
  cloud::Options cloud;               ///< how point clouds become a surface; a group of options of its own
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

/// Whether the mesh of these files was turned when it was read, since y is up in it: by the option, else by what their
/// formats usually are.
[[nodiscard]] auto is_read_y_up(const Options& options, const std::vector<model::InputFile>& inputs) -> bool;

/// Options::bbox; none where it is four zeros. Fails with "ingest-bbox".
[[nodiscard]] auto box_of(const Options& options) -> base::Result<std::optional<geometry::Box2>>;

/// Reads every mesh as one, corners at the same place made one, and one vector source of footprints. A mesh is a file
/// (OBJ, PLY, OFF, GLB, glTF), a point cloud (LAS, LAZ, COPC, EPT, PLY), a folder or archive of them, a tileset of 3D
/// Tiles, or a raster of heights. One that
/// says where it is – a tileset on the earth, a raster's CRS, metadata.xml beside files – is brought to the working
/// CRS; of others, with the offset, it is taken that they are in it. With an empty path for `footprints` there are
/// none, and the working CRS is the option's, else the mesh's own or its UTM zone, else none. Guarantees: 1 all
/// coordinates are finite and local · 2 every triangle has area and names existing vertices · 3 polygons are simple and
/// oriented, or the feature has a defect · 4 ids are unique · 5 the order of features is the source's. Fails with:
/// see codes().
[[nodiscard]] auto read_scene(const std::vector<std::filesystem::path>& meshes, const std::filesystem::path& footprints,
                              const Options& options, const base::Run& run = {}) -> base::Result<model::Scene>;

/// A scene whose mesh is in cells on disk where it is large; the scene has no mesh then.
struct CityScene {
  model::Scene scene;
  std::unique_ptr<MeshCells> cells;
};
/// As read_scene, for meshes that memory need not hold. The same blocks come of both.
[[nodiscard]] auto read_city(const std::vector<std::filesystem::path>& meshes, const std::filesystem::path& footprints,
                             const Options& options, const base::Run& run = {}) -> base::Result<CityScene>;

/// Footprints alone, where there is no mesh: as read_scene, with an empty mesh and z from 0. GeoJSON that says no CRS
/// is taken to be in metres where it cannot be in degrees, or where a building would be longer than a degree.
[[nodiscard]] auto read_footprints(const std::filesystem::path& footprints, const Options& options,
                                   const base::Run& run = {}) -> base::Result<model::Scene>;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::ingest
