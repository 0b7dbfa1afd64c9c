// Reads meshes and footprints into one local, metric frame.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "mansard/base/options.hpp"
#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/geometry/mesh.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::ingest {

/// A value of a feature's attribute, as the vector source has it.
using Value = std::variant<std::monostate, bool, std::int64_t, double, std::string>;
/// In the order of the source's fields.
using Attributes = std::vector<std::pair<std::string, Value>>;

/// One GIS feature. A feature that cannot be used keeps its place, with `defect` set and no polygons.
struct Footprint {
  std::string id;                           ///< the id attribute, else the feature id of the source; unique in a scene
  std::vector<geometry::Polygon> polygons;  ///< local frame, simple, oriented, one per part of a MultiPolygon
  Attributes attributes;
  std::optional<base::Diagnostic> defect;
  bool derived = false;  ///< drawn from the mesh, by no surveyor
};

/// From local to file coordinates: add the origin. The origin is whole metres, so that adding and taking off is exact
/// for coordinates that are multiples of 2^-20 m, and for every coordinate at least as far from zero as from the
/// origin.
struct Frame {
  std::array<std::int64_t, 3> origin{0, 0, 0};
  std::string crs;  ///< "EPSG:n" where known, WKT otherwise, empty for a local frame
};

struct InputFile {
  std::string path;
  std::uint64_t bytes = 0;
  std::string sha256;
};

/// What was read and what was left out.
struct MeshCounts {
  std::uint64_t vertices = 0, triangles = 0;            ///< kept
  std::uint64_t not_finite = 0;                         ///< triangles dropped for NaN or infinite corners
  std::uint64_t out_of_range = 0;                       ///< … for indices that name no vertex
  std::uint64_t degenerate = 0;                         ///< … without area
  std::uint64_t duplicate = 0;                          ///< … that repeat another one's corners
  std::uint64_t non_manifold_edges = 0;                 ///< kept, counted
  std::uint64_t boundary_edges = 0;                     ///< kept, counted
  std::uint64_t flipped_edges = 0;                      ///< kept: neighbours that disagree about the outside
  std::uint64_t vertices_read = 0, triangles_read = 0;  ///< what the files hold; more than kept where things repeat
};

/// Heights at the centres of square cells.
struct HeightGrid {
  geometry::Point2 centre;  ///< of cell (0, 0), the south-west one; local frame, metres
  double cell = 1;          ///< m
  std::size_t columns = 0, rows = 0;
  std::vector<float> values;  ///< z, metres, local frame; row by row from the south; NaN for none
  /// Between the four nearest centres; none beyond them, or where one of them has no value.
  [[nodiscard]] auto at(geometry::Point2 p) const -> std::optional<double>;
};

struct Scene {
  geometry::Mesh mesh;  ///< local frame
  std::vector<Footprint> footprints;
  std::optional<HeightGrid> terrain;  ///< the ground, where it was given; else blocks look for it in the mesh
  Frame frame;
  std::vector<InputFile> inputs;
  MeshCounts mesh_counts;
  std::vector<base::Diagnostic> warnings;
};

enum class UpAxis { automatic, z, y };  ///< automatic: y for glTF, z for the rest; y up: (x, y, z) becomes (x, −z, y)

struct Options {
  std::array<double, 3> mesh_offset{0, 0, 0};  ///< metres, added to mesh coordinates once they are z up
  UpAxis up = UpAxis::automatic;
  /// The CRS to work in ("EPSG:n", or "local"); empty: the footprints', else the mesh's own, else the UTM zone.
  std::string crs;
  std::string id_attribute;  ///< empty: gml_id, id, fid … whichever the source has, else its feature number
  std::string layer;         ///< of the vector source; empty: its only or first one
  std::string where;         ///< OGR SQL attribute filter
  /// xmin ymin xmax ymax in the working CRS: footprints whose box meets it, and the mesh around them; all zero:
  /// everything.
  std::array<double, 4> bbox{0, 0, 0, 0};
  double tile_error =
      0;                ///< metres; of a tileset, tiles are taken once their geometric error is no more; 0: the finest
  std::string terrain;  ///< path of a raster with the ground's heights; empty: none
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

/// Reads every mesh as one, corners at the same place made one, and one vector source of footprints. A mesh is a file
/// (OBJ, PLY, OFF, GLB, glTF), a folder or archive of them, a tileset of 3D Tiles, or a raster of heights. One that
/// says where it is – a tileset on the earth, a raster's CRS, metadata.xml beside files – is brought to the working
/// CRS; of others, with the offset, it is taken that they are in it. With an empty path for `footprints` there are
/// none, and the working CRS is the option's, else the mesh's own or its UTM zone, else none. Guarantees: 1 all
/// coordinates are finite and local · 2 every triangle has area and names existing vertices · 3 polygons are simple and
/// oriented, or the feature has a defect · 4 ids are unique · 5 the order of features is the source's. Gives up with:
/// see codes().
[[nodiscard]] auto read_scene(const std::vector<std::filesystem::path>& meshes, const std::filesystem::path& footprints,
                              const Options& options, const base::Run& run = {}) -> base::Result<Scene>;

/// Footprints alone, where there is no mesh: as read_scene, with an empty mesh and z from 0. GeoJSON that says no CRS
/// is taken to be in metres where it cannot be in degrees, or where a building would be longer than a degree.
[[nodiscard]] auto read_footprints(const std::filesystem::path& footprints, const Options& options,
                                   const base::Run& run = {}) -> base::Result<Scene>;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::ingest
