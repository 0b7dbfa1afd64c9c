#include "mansard/formats/drivers.hpp"

#include <algorithm>

#include "mansard/base/text.hpp"
#include "mansard/formats/files/virtual_files.hpp"
#include "mansard/formats/mesh/mesh_file.hpp"
#include "mansard/formats/mesh/mesh_formats.hpp"
#include "mansard/formats/osgb/osgb_file.hpp"

namespace mansard::formats {
namespace {

using Text = base::Result<RawMesh> (*)(std::string_view, const std::string&);

/// A format whose coordinates are z up, unless the user says y.
template <Text read>
auto z_up(const MeshBytes& source, MeshPiece& /*piece*/) -> base::Result<RawMesh> {
  auto mesh = read(source.bytes, source.path.string());
  if (mesh && source.up == UpAxis::y)
    for (auto& v : mesh->vertices) v = {v.x, -v.z, v.y};
  return mesh;
}

/// glTF is y up, unless the user says z.
auto gltf(const MeshBytes& source, MeshPiece& piece) -> base::Result<RawMesh> {
  auto read = read_gltf(source.bytes, source.path);
  if (!read) return read.failure();
  piece.inputs.insert(piece.inputs.end(), read->buffers.begin(), read->buffers.end());
  if (source.up != UpAxis::z)
    for (auto& v : read->mesh.vertices) v = {v.x, -v.z, v.y};
  if (const auto centre = read->centre)
    for (auto& v : read->mesh.vertices) v = v + *centre;
  return std::move(read->mesh);
}

/// By its file extension; the axis that the user says is stronger than that of the file.
auto assimp(const MeshBytes& source, MeshPiece& piece) -> base::Result<RawMesh> {
  auto read = read_by_assimp(source.bytes, source.path.string(), extension_of(source.path).substr(1));
  if (!read) return read.failure();
  piece.warnings = std::move(read->warnings);
  if ((source.up == UpAxis::automatic ? read->up : source.up) == UpAxis::y)
    for (auto& v : read->mesh.vertices) v = {v.x, -v.z, v.y};
  return std::move(read->mesh);
}

auto osgb(const MeshBytes& source, MeshPiece& piece) -> base::Result<RawMesh> {
  auto read = read_osgb(source.bytes, source.path, false);
  if (!read) return read.failure();
  piece.inputs.insert(piece.inputs.end(), read->inputs.begin(), read->inputs.end());
  piece.warnings = std::move(read->mesh.warnings);
  auto& mesh = read->mesh.mesh;
  if (source.up == UpAxis::y)
    for (auto& v : mesh.vertices) v = {v.x, -v.z, v.y};
  return RawMesh{std::move(mesh.vertices), std::move(mesh.triangles), read->short_faces, {}, {}};
}

constexpr Reads mesh{.mesh = true}, points{.mesh = true, .points = true}, raster{.raster = true},
    footprints{.footprints = true};
constexpr Reads city{.footprints = true, .models = true, .results = true};

auto table() -> std::vector<Driver> {
  return {
      {"cityjson",
       "CityJSON",
       {".city.json", ".cityjson"},
       city,
       Format::cityjson,
       "CityJSON 2.0: footprints and solids at several levels of detail, attributes, plans.",
       {}},
      {"cityjsonseq",
       "CityJSONSeq",
       {".city.jsonl", ".jsonl", ".cityjsonl"},
       city,
       Format::cityjsonseq,
       "CityJSONSeq: the same as CityJSON, one building a line.",
       {}},
      {"obj",
       "OBJ",
       {".obj"},
       {.mesh = true, .models = true, .results = true},
       Format::obj,
       "Wavefront OBJ, with its material library beside it.",
       {{}, true, z_up<read_obj>}},
      {"glb",
       "GLB",
       {".glb"},
       {.mesh = true, .results = true},
       Format::glb,
       "Binary glTF 2.0 with attributes per building and a class per face.",
       {{"glTF"}, false, gltf}},
      {"tiles",
       "3D Tiles",
       {".3dtiles", ".3tz"},
       {.mesh = true, .results = true},
       Format::tiles,
       "3D Tiles 1.1: a folder with a tileset.json.",
       {}},
      {"geopackage",
       "GeoPackage",
       {".gpkg"},
       {.footprints = true, .results = true},
       Format::geopackage,
       "GeoPackage: footprints, solids, edges and roof planes as layers.",
       {}},
      {"stl", "STL", {".stl"}, mesh, Format::stl, "Binary STL of closed shells; read as text too.", {{}, true, assimp}},
      {"geojson",
       "GeoJSON",
       {".geojson"},
       {.footprints = true, .results = true},
       Format::geojson,
       "GeoJSON: footprints with attributes.",
       {}},
      {"plans",
       "plans",
       {".json"},
       {.results = true},
       Format::plans,
       "Plan + profiles, the source of every model.",
       {}},
      {"citygml",
       "CityGML",
       {".gml", ".citygml"},
       {.footprints = true, .models = true},
       Format::citygml,
       "CityGML 3.0 or 2.0: solids with semantic surfaces, attributes.",
       {}},
      {"dxf", "DXF", {".dxf"}, {}, Format::dxf, "AutoCAD DXF: 3D faces in a layer per class.", {}},
      {"flatgeobuf",
       "FlatGeobuf",
       {".fgb"},
       footprints,
       Format::flatgeobuf,
       "FlatGeobuf: footprints with attributes.",
       {}},
      {"ply", "PLY", {".ply"}, mesh, {}, "Stanford PLY, text or binary.", {{"ply\n", "ply\r"}, false, z_up<read_ply>}},
      {"off", "OFF", {".off"}, mesh, {}, "Object File Format, text.", {{"OFF"}, true, z_up<read_off>}},
      {"gltf", "glTF", {".gltf"}, mesh, {}, "glTF 2.0 with its buffers beside it.", {{}, true, gltf}},
      {"osgb",
       "OSGB",
       {".osgb"},
       mesh,
       {},
       "OpenSceneGraph's binary format, with the levels of detail beside it.",
       {{"\xA1\x0E\x91\x6C\x45\x45\xFB\x1A"}, false, osgb}},
      {"fbx", "FBX", {".fbx"}, mesh, {}, "Autodesk's FBX, binary or text.", {{}, true, assimp}},
      {"collada", "COLLADA", {".dae"}, mesh, {}, "COLLADA.", {{}, true, assimp}},
      {"las", "LAS", {".las"}, points, {}, "LAS 1.0 to 1.4: a point cloud.", {}},
      {"laz", "LAZ", {".laz"}, points, {}, "Compressed LAS: a file, COPC, or EPT, a folder with an ept.json.", {}},
      {"xyz", "XYZ", {".xyz", ".pts"}, points, {}, "Text, a point a line: columns by a header, or x y z.", {}},
      {"geotiff", "GeoTIFF", {".tif", ".tiff"}, raster, {}, "A raster of heights.", {}},
      {"vrt", "VRT", {".vrt"}, raster, {}, "GDAL's virtual raster: several rasters as one.", {}},
      {"asc", "ASCII grid", {".asc"}, raster, {}, "Esri's ASCII grid of heights.", {}},
      {"img", "ERDAS IMAGINE", {".img"}, raster, {}, "A raster of heights.", {}},
      {"shapefile", "Shapefile", {".shp"}, footprints, {}, "Esri Shapefile, with its .dbf and .prj beside it.", {}},
      {"gml", "GML", {".gml"}, footprints, {}, "Geography Markup Language.", {}},
      {"kml", "KML", {".kml"}, footprints, {}, "Keyhole Markup Language.", {}},
      {"osm", "OpenStreetMap", {".osm.pbf", ".osm", ".pbf"}, footprints, {}, "OpenStreetMap extract.", {}},
  };
}

}  // namespace

auto drivers() -> const std::vector<Driver>& {
  static const std::vector<Driver> all = table();
  return all;
}

auto titles(bool Reads::*what) -> std::string {
  std::string all;
  for (const auto& driver : drivers())
    if (driver.reads.*what) all += (all.empty() ? "" : ", ") + std::string(driver.title);
  return all;
}

auto extensions(bool Reads::*what) -> std::vector<std::string_view> {
  std::vector<std::string_view> all;
  for (const auto& driver : drivers())
    if (driver.reads.*what) all.insert(all.end(), driver.extensions.begin(), driver.extensions.end());
  return all;
}

auto extensions_in_words(bool Reads::*what) -> std::string {
  const auto all = extensions(what);
  std::string words;
  for (std::size_t i = 0; i < all.size(); ++i)
    words += (i == 0 ? "" : i + 1 == all.size() ? " or " : ", ") + std::string(all[i]);
  return words;
}

auto extension_of(const std::filesystem::path& path) -> std::string {
  return base::lower(plain_name(path).extension().string());
}

auto has_extension(const std::filesystem::path& path, bool Reads::*what) -> bool {
  const std::string name = base::lower(plain_name(path).filename().string());
  return std::ranges::any_of(extensions(what), [&](std::string_view extension) { return name.ends_with(extension); });
}

}  // namespace mansard::formats
