// Every file format in one table: its name, its file extensions, what is read from it and what is written to it. Help,
// error messages, the server's file chooser, the page and the docs take their lists from here.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/formats/up_axis.hpp"

namespace mansard::formats {

struct MeshPiece;
struct RawMesh;

/// What can be written: a city of building models.
enum class Format : std::uint8_t {
  cityjson,     ///< one document, ".city.json"
  cityjsonseq,  ///< a feature a line, ".city.jsonl"
  obj,          ///< with its library ".mtl" beside it
  glb,
  tiles,  ///< a folder with a tileset.json and its GLB: 3D Tiles 1.1
  geopackage,
  stl,
  geojson,     ///< the footprints alone
  plans,       ///< plan + profiles, ".json"
  citygml,     ///< CityGML 3.0 or 2.0, ".gml"
  dxf,         ///< a 3DFACE a triangle, a layer a class
  flatgeobuf,  ///< the footprints with the attributes of the buildings
};

/// What is read from a format.
struct Reads {
  bool mesh = false;        ///< triangles of a scan, or points that a surface is made of
  bool raster = false;      ///< heights of a scan or of the terrain
  bool footprints = false;  ///< polygons with attributes
  bool models = false;      ///< building models of any producer
  bool results = false;     ///< building models that mansard wrote, with their plans
  bool points = false;      ///< points of a scan
};

/// The bytes of one mesh file, and where they are from.
struct MeshBytes {
  std::string_view bytes;
  std::filesystem::path path;
  UpAxis up = UpAxis::automatic;
};

/// How a mesh of a format is recognised and parsed.
struct MeshParser {
  std::vector<std::string_view> signatures;  ///< what the bytes start with; none: the format has no signature
  bool by_extension = false;                 ///< whether the file extension is enough where no signature matches
  /// z up. Files that were read beside this one go to `piece.inputs`. None: the format is no mesh in one file.
  base::Result<RawMesh> (*parse)(const MeshBytes& source, MeshPiece& piece) = nullptr;
};

struct Driver {
  std::string_view name;   ///< on the command line: "cityjson"
  std::string_view title;  ///< in a sentence: "CityJSON"
  /// In lower case, with the dot: the first is that of written files. A tileset, a folder, has none that must be there.
  std::vector<std::string_view> extensions;
  Reads reads;
  std::optional<Format> writes;
  std::string_view description;  ///< a sentence
  MeshParser mesh;
};

/// All of them: first those that are written, in the order of Format.
[[nodiscard]] auto drivers() -> const std::vector<Driver>&;

/// "OBJ, PLY, OFF": the titles of the drivers of which that is read.
[[nodiscard]] auto titles(bool Reads::*what) -> std::string;
/// Their file extensions, in the order of the table.
[[nodiscard]] auto extensions(bool Reads::*what) -> std::vector<std::string_view>;
/// ".obj, .ply or .off"
[[nodiscard]] auto extensions_in_words(bool Reads::*what) -> std::string;

/// Of a name, in lower case, with its dot and without ".gz"; empty for none.
[[nodiscard]] auto extension_of(const std::filesystem::path& path) -> std::string;
/// Whether the file extension is one of a driver of which that is read.
[[nodiscard]] auto has_extension(const std::filesystem::path& path, bool Reads::*what) -> bool;

}  // namespace mansard::formats
