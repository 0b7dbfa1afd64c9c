// Files of other producers: models, shells, tilesets, meshes, rasters, footprint sources.
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include "apps/cli/info.hpp"
#include "mansard/accuracy/accuracy.hpp"
#include "mansard/base/files.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/citygml_made_by.hpp"
#include "mansard/formats/models.hpp"
#include "mansard/formats/points.hpp"
#include "mansard/formats/source.hpp"
#include "mansard/ingest/model.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;

auto head(const fs::path& path, const char* kind, const std::string& format) -> Json {
  Json out;
  out["file"] = path.string();
  out["kind"] = kind;
  out["format"] = format;
  std::error_code status;
  if (fs::is_regular_file(path, status)) out["bytes"] = fs::file_size(path, status);
  return out;
}

/// Without the dot, and without that of a compressed file.
auto extension_of(const fs::path& path) -> std::string {
  const auto extension = formats::extension_of(path);
  return extension.empty() ? extension : extension.substr(1);
}

auto warnings_json(const std::vector<base::Diagnostic>& warnings) -> Json {
  Json out = Json::array();
  for (const auto& warning : warnings) out.push_back({{"code", warning.code}, {"message", warning.message}});
  return out;
}

/// What is measured of the noise of a scan; null where that is nothing.
auto accuracy_json(const model::Accuracy& scan) -> Json {
  if (scan.windows == 0) return nullptr;
  Json words = Json::object();
  for (const auto& [name, value] : accuracy::in_words(scan)) words[name] = value;
  return {{"noise_m", scan.noise},
          {"correlated_area_m2", scan.correlated_area},
          {"spacing_m", scan.spacing},
          {"words", std::move(words)}};
}

// ---- models of other producers

/// A file from its start, up to the place where `enough(bytes)` is true: asked after every megabyte.
template <class Enough>
auto start_of(const fs::path& path, Enough enough) -> std::string {
  constexpr std::size_t piece = std::size_t{1} << 20;
  std::ifstream file(path, std::ios::binary);
  std::string bytes;
  while (file && !enough(bytes)) {
    const std::size_t before = bytes.size();
    bytes.resize(before + piece);
    file.read(bytes.data() + before, piece);
    bytes.resize(before + static_cast<std::size_t>(file.gcount()));
  }
  return bytes;
}

/// How a CityGML that mansard wrote was made; none of any other file.
auto made_by_mansard(const fs::path& path, const std::string& format) -> std::optional<model::MadeBy> {
  if (format != "citygml") return std::nullopt;
  const auto whole = [](const std::string& bytes) {
    const auto comment = bytes.find(formats::citygml_made_by_start);
    return bytes.find("CityModel") != bytes.npos &&
           (comment == bytes.npos || bytes.find(" -->", comment) != bytes.npos);
  };
  return formats::citygml_made_by(start_of(path, whole));
}

auto info_of_model(const fs::path& path, const model::Model& model, bool all_options) -> Json {
  const auto surface = model::surface_of(model);
  Extent3 extent;
  for (const auto p : surface.mesh.vertices) extent.add(p, model.frame);
  std::size_t parts = 0, faces = 0;
  std::array<std::size_t, model::surface_class_count> classes{};
  for (const auto& building : model.buildings) {
    parts += building.parts.size();
    for (const auto& part : building.parts) {
      faces += part.faces.size();
      for (const auto& face : part.faces) ++classes[static_cast<std::size_t>(face.kind)];
    }
  }
  Json out = head(path, "models",
                  extension_of(path) == "obj"                            ? "obj"
                  : extension_of(path).find("json") != std::string::npos ? "cityjson"
                                                                         : "citygml");
  const auto made_by = made_by_mansard(path, out["format"]);
  out["by"] = made_by ? "mansard" : "others";
  out["crs"] = model.frame.crs;
  out["extent"] = extent.json();
  out["counts"] = {{"buildings", model.buildings.size()},
                   {"parts", parts},
                   {"faces", faces},
                   {"triangles", surface.mesh.triangles.size()},
                   {"vertices", surface.mesh.vertices.size()}};
  if (!model.lod.empty()) out["lods"] = Json::array({model.lod});
  for (std::size_t i = 0; i < classes.size(); ++i)
    out["classes"][std::string(model::to_string(static_cast<model::SurfaceClass>(i)))] = classes[i];
  if (made_by) out["made_by"] = made_by_json(*made_by, all_options);
  out["warnings"] = warnings_json(model.warnings);
  return out;
}

// ---- STL

/// Binary: 80 bytes of text, the number of triangles, 50 bytes for each.
auto info_of_stl(const fs::path& path) -> base::Result<Json> {
  constexpr std::size_t before_triangles = 84, triangle = 50, length_of_text = 80;
  std::ifstream file(path, std::ios::binary);
  std::string bytes(before_triangles, '\0');
  file.read(bytes.data(), before_triangles);
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  std::error_code status;
  const auto size = fs::file_size(path, status);
  if (status) return base::error("file-read", "cannot be read: " + status.message(), path.string());
  Json out = head(path, "shells", "stl");
  const auto at = [&](std::size_t offset) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[offset]));
  };
  const bool whole = bytes.size() == before_triangles;
  const std::size_t count = whole ? at(80) | at(81) << 8 | at(82) << 16 | static_cast<std::size_t>(at(83)) << 24 : 0;
  if (!whole || size != before_triangles + triangle * count) {
    if (bytes.starts_with("solid")) out["text"] = true;
    else
      return base::error("ingest-mesh-truncated", "not a complete binary STL; copy or export it again", path.string());
    return out;
  }
  std::string text = bytes.substr(0, std::min(length_of_text, bytes.find('\0')));
  text.erase(text.find_last_not_of(' ') + 1);
  out["header"] = base::on_one_line(text);
  out["counts"] = {{"triangles", count}};
  return out;
}

// ---- meshes

auto info_of_mesh(const fs::path& path, const base::Run& run) -> base::Result<Json> {
  // A y-up glTF is reported with z up, as `reconstruct` reads it.
  const auto mesh = ingest::read_mesh({path}, {}, {}, run);
  if (!mesh) return mesh.failure();
  std::error_code status;
  Json out = head(path, "mesh", fs::is_directory(path, status) ? "folder" : extension_of(path));
  Extent3 extent;
  for (const auto p : mesh->mesh.vertices) extent.add(p, {});
  out["extent"] = extent.json();
  out["accuracy"] = accuracy_json(accuracy::measure_alone(mesh->mesh));
  const auto& c = mesh->counts;
  out["counts"] = {{"triangles", c.triangles},
                   {"vertices", c.vertices},
                   {"triangles_read", c.triangles_read},
                   {"vertices_read", c.vertices_read},
                   {"not_finite", c.not_finite},
                   {"out_of_range", c.out_of_range},
                   {"degenerate", c.degenerate},
                   {"duplicate", c.duplicate},
                   {"non_manifold_edges", c.non_manifold_edges},
                   {"boundary_edges", c.boundary_edges},
                   {"flipped_edges", c.flipped_edges}};
  if (!mesh->classes.empty()) {
    std::array<std::size_t, model::surface_class_count> classes{};
    for (const auto kind : mesh->classes) ++classes[static_cast<std::size_t>(kind)];
    for (std::size_t i = 0; i < classes.size(); ++i)
      out["classes"][std::string(model::to_string(static_cast<model::SurfaceClass>(i)))] = classes[i];
  }
  Json files = Json::array();
  for (const auto& input : mesh->inputs)
    files.push_back({{"path", input.path}, {"bytes", input.bytes}, {"sha256", input.sha256}});
  out["files"] = std::move(files);
  out["warnings"] = warnings_json(mesh->warnings);
  return out;
}

// ---- point clouds

auto info_of_points(const fs::path& path, const cloud::ClassMap& as, const base::Run& run) -> base::Result<Json> {
  const auto opened = formats::open_points(path);
  if (!opened) return opened.failure();
  const auto& cloud = **opened;
  const auto& info = cloud.info();
  struct Piece {
    geometry::Box3 box;
    std::array<std::uint64_t, 256> classes{};
    std::uint64_t withheld = 0, not_finite = 0, last_returns = 0;
    std::vector<geometry::Point3> buildings, others;  ///< some pieces: what noise is measured of
    std::optional<base::Failure> failure;
  };
  std::vector<Piece> pieces(cloud.pieces());
  // Neighbours are mostly in one piece; so many of them are enough for the noise.
  constexpr std::uint64_t enough = 2'000'000;
  const std::size_t every = static_cast<std::size_t>(info.points / enough) + 1;
  base::parallel_for(pieces.size(), [&](std::size_t i) {
    auto& piece = pieces[i];
    const auto points = cloud.read(i);
    if (run.cancelled()) return;
    if (!points) {
      piece.failure = points.failure();
      return;
    }
    for (const auto& p : *points) {
      ++piece.classes[p.classification];
      piece.withheld += p.withheld ? 1 : 0;
      piece.last_returns += p.return_number >= p.returns ? 1 : 0;
      const bool finite = std::isfinite(p.position.x) && std::isfinite(p.position.y) && std::isfinite(p.position.z);
      if (finite) piece.box.add(p.position);
      else ++piece.not_finite;
      if (!finite || p.withheld || i % every != 0 || info.unit <= 0) continue;
      const auto in_metres = [&] {
        return geometry::Point3{info.unit * p.position.x, info.unit * p.position.y, info.unit * p.position.z};
      };
      if (as[p.classification] == cloud::building) piece.buildings.push_back(in_metres());
      else if (as[p.classification] < 3 && p.returns <= 1) piece.others.push_back(in_metres());
    }
  });
  if (run.cancelled()) return base::error("cancelled", "stopped on request");
  Piece all;
  for (const auto& piece : pieces) {
    if (piece.failure) return *piece.failure;
    all.box.include(piece.box);
    all.withheld += piece.withheld;
    all.not_finite += piece.not_finite;
    all.last_returns += piece.last_returns;
    for (std::size_t c = 0; c < all.classes.size(); ++c) all.classes[c] += piece.classes[c];
  }
  std::vector<geometry::Point3> surface;
  for (auto part : {&Piece::buildings, &Piece::others}) {
    for (const auto& piece : pieces) surface.insert(surface.end(), (piece.*part).begin(), (piece.*part).end());
    if (!surface.empty()) break;  // of roofs, where they are known
  }
  Json out = head(path, "points", info.format);
  if (info.point_format >= 0) out["point_format"] = info.point_format;
  out["crs"] = info.crs_title;
  out["extent"] = nullptr;
  if (!all.box.empty())
    out["extent"] = {all.box.least.x, all.box.least.y, all.box.least.z, all.box.most.x, all.box.most.y, all.box.most.z};
  out["accuracy"] = accuracy_json(accuracy::noise_of(std::move(surface)));
  Json counts{{"points", info.points},
              {"last_returns", all.last_returns},
              {"withheld", all.withheld},
              {"not_finite", all.not_finite}};
  out["density"] = nullptr;  // per square metre
  if (info.unit > 0 && !all.box.empty()) {
    const double area = (all.box.most.x - all.box.least.x) * (all.box.most.y - all.box.least.y) * info.unit * info.unit;
    if (area > 0) out["density"] = static_cast<double>(info.points) / area;
  }
  out["points"] = std::move(counts);
  if (info.has_classes)
    for (std::size_t c = 0; c < all.classes.size(); ++c)
      if (all.classes[c] > 0) out["classes"][std::to_string(c)] = all.classes[c];
  out["warnings"] = warnings_json(info.warnings);
  return out;
}

// ---- reports of runs

/// The run.json of a run; none where it is none.
auto info_of_report(const fs::path& path, bool all_options) -> std::optional<Json> {
  if (extension_of(path) != "json") return std::nullopt;
  const auto bytes = base::read_file(path);
  if (!bytes) return std::nullopt;
  const auto report = Json::parse(*bytes, nullptr, false);
  if (!report.is_object() || !report.value("mansard", Json()).is_string()) return std::nullopt;
  const auto member = [&](const char* name) { return report.value(name, Json()); };
  const auto counts = member("counts"), options = member("options"), inputs = member("inputs");
  if (!counts.is_object() || !options.is_object() || !inputs.is_array()) return std::nullopt;
  model::MadeBy made_by;
  made_by.version = member("mansard").get<std::string>();
  for (const auto& [name, value] : options.items())
    if (value.is_string()) made_by.options.emplace_back(name, value.get<std::string>());
  for (const auto& input : inputs)
    if (input.is_object())
      made_by.inputs.push_back({input.value("path", std::string()), input.value("bytes", std::uintmax_t{0}),
                                input.value("sha256", std::string())});
  Json out = head(path, "report", "run.json");
  out["by"] = "mansard";
  if (member("crs").is_string()) out["crs"] = member("crs");
  out["outcomes"] = Json::object();
  for (const auto& [name, count] : counts.items())
    if (count.is_number_integer()) out["outcomes"][name] = count;
  out["made_by"] = made_by_json(made_by, all_options);
  out["warnings"] = Json::array();
  for (const auto& warning : member("warnings"))
    if (warning.is_object())
      out["warnings"].push_back(
          {{"code", warning.value("code", std::string())}, {"message", warning.value("message", std::string())}});
  return out;
}

// ---- what GDAL reads

auto info_of_raster(const fs::path& path) -> base::Result<Json> {
  const auto source = formats::raster_source(path);
  if (!source) return source.failure();
  Json out = head(path, "raster", source->driver);
  out["crs"] = source->crs;
  out["extent"] = source->extent;
  out["columns"] = source->columns;
  out["rows"] = source->rows;
  out["bands"] = source->bands;
  out["cell"] = source->cell;
  out["nodata"] = source->nodata && std::isfinite(*source->nodata) ? Json(*source->nodata) : Json(nullptr);
  out["unit"] = source->unit;
  return out;
}

auto layers_of(const formats::VectorSource& source) -> Json {
  Json out = Json::array();
  for (const auto& layer : source.layers) {
    Json one;
    one["name"] = layer.name;
    one["geometry"] = layer.geometry;
    one["crs"] = layer.crs;
    one["features"] = layer.features ? Json(*layer.features) : Json(nullptr);
    one["extent"] = layer.extent ? Json(*layer.extent) : Json(nullptr);
    one["fields"] = Json::array();
    for (const auto& [name, type] : layer.fields) one["fields"].push_back({{"name", name}, {"type", type}});
    out.push_back(std::move(one));
  }
  return out;
}

auto info_of_source(const fs::path& path) -> base::Result<Json> {
  const auto source = formats::vector_source(path);
  if (!source) return source.failure();
  Json out = head(path, "footprints", source->driver);
  out["layers"] = layers_of(*source);
  return out;
}

auto is_mesh(const fs::path& path) -> bool {
  std::error_code status;
  return fs::is_directory(path, status) || formats::has_extension(path, &formats::Reads::mesh);
}

/// JSON with the file extension or the member of CityJSON, and GML with the root of CityGML.
auto may_be_city_model(const fs::path& path) -> bool {
  const auto extension = extension_of(path);
  if (extension == "jsonl" || extension == "citygml") return true;
  if (extension == "gml" || extension == "xml") {
    const auto any = [](const std::string& bytes) { return !bytes.empty(); };
    return start_of(path, any).substr(0, 16384).find("CityModel") != std::string::npos;
  }
  if (extension != "json") return false;
  constexpr std::string_view word = "\"CityJSON\"";
  constexpr std::size_t piece = std::size_t{1} << 20;
  std::ifstream file(path, std::ios::binary);
  std::string bytes;
  while (file) {  // the end of a piece stays: the word may be in two
    bytes.erase(0, bytes.size() > word.size() ? bytes.size() - word.size() : 0);
    const std::size_t before = bytes.size();
    bytes.resize(before + piece);
    file.read(bytes.data() + before, piece);
    bytes.resize(before + static_cast<std::size_t>(file.gcount()));
    if (bytes.find(word) != bytes.npos) return true;
  }
  return false;
}

}  // namespace

auto info_of_tileset(const fs::path& path) -> Json {
  const auto source = formats::tileset_source(path);
  if (!source) return nullptr;
  const auto as_stated = [](const std::string& json) { return json.empty() ? Json(nullptr) : Json::parse(json); };
  Json out;
  out["version"] = source->version;
  out["geometric_error_m"] = as_stated(source->geometric_error);
  out["placed_on_the_earth"] = source->placed_on_the_earth;
  if (!source->bounding_volume.empty()) out["bounding_volume"] = as_stated(source->bounding_volume);
  if (source->tilesets > 0) out["tilesets_within"] = source->tilesets;
  out["levels"] = Json::array();
  for (const auto& level : source->levels) {
    const bool stated = level.minimum_error && level.maximum_error;
    out["levels"].push_back(
        {{"tiles", level.tiles},
         {"contents", level.contents},
         {"geometric_error_m", stated ? Json::array({*level.minimum_error, *level.maximum_error}) : Json(nullptr)}});
  }
  return out;
}

auto info_of_layers(const fs::path& path) -> base::Result<Json> {
  const auto source = formats::vector_source(path);
  if (!source) return source.failure();
  return layers_of(*source);
}

namespace {

/// What its CRS lacks is a warning, and the rest is described nevertheless.
auto model_of(const fs::path& path) -> base::Result<model::Model> {
  auto model = ingest::read_model(path);
  if (model || model.error().code != "ingest-model-crs") return model;
  auto local = ingest::read_model(path, {{}, "local"});
  if (!local) return model;
  const auto& why = model.error();
  local->warnings.push_back(base::warning(why.code, why.message, why.subject));
  return local;
}

}  // namespace

auto info_of_other(const fs::path& path, const base::Diagnostic& why, bool all_options, const cloud::ClassMap& classes,
                   const base::Run& run) -> base::Result<Json> {
  if (extension_of(path) == "stl") return info_of_stl(path);
  if (formats::is_point_cloud(path)) return info_of_points(path, classes, run);
  std::error_code status;
  if (fs::is_regular_file(path / "ept.json", status)) return info_of_points(path / "ept.json", classes, run);
  if (auto tileset = info_of_tileset(path); !tileset.is_null()) {
    Json out = head(path, "tileset", "tiles");
    out["tileset"] = std::move(tileset);
    return out;
  }
  // An OBJ whose faces have no class is a mesh like any other.
  const bool obj = extension_of(path) == "obj";
  if (obj ? formats::labels_every_face(path) : may_be_city_model(path)) {
    const auto model = model_of(path);
    if (model) return info_of_model(path, *model, all_options);
    if (!obj) return model.failure();
  }
  if (is_mesh(path)) {
    auto mesh = info_of_mesh(path, run);
    // A folder without meshes may be one of Shapefiles, or a geodatabase.
    if (mesh || mesh.error().code != "ingest-mesh-empty") return mesh;
    auto source = info_of_source(path);
    return source ? std::move(source) : std::move(mesh);
  }
  if (formats::named_as_raster(path)) return info_of_raster(path);
  if (auto report = info_of_report(path, all_options)) return *std::move(report);
  auto source = info_of_source(path);
  if (!source && extension_of(path) == "zip")
    if (auto mesh = info_of_mesh(path, run)) return mesh;
  if (!source)  // a picture
    if (auto raster = info_of_raster(path)) return raster;
  // A broken file of plans is better reported as one.
  return !source && why.code.starts_with("write-plan") ? base::Result<Json>(why) : source;
}

}  // namespace mansard::cli
