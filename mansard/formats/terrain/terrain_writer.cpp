#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "mansard/base/files.hpp"
#include "mansard/crs/globe.hpp"
#include "mansard/formats/cityjson/cityjson.hpp"
#include "mansard/formats/detail/records.hpp"
#include "mansard/formats/foreign.hpp"
#include "mansard/formats/gltf/glb_bytes.hpp"
#include "mansard/formats/terrain.hpp"
#include "mansard/formats/terrain/terrain_glb.hpp"
#include "mansard/formats/terrain/terrain_tiles.hpp"

namespace mansard::formats {
namespace {

using detail::JsonText;
using geometry::Mesh;
using geometry::Point3;

constexpr std::array written{Format::cityjson, Format::cityjsonseq, Format::glb, Format::tiles, Format::stl};
constexpr std::string_view object_id = "terrain";

// ---- CityJSON

/// The TINRelief with all its triangles; CityJSON has no terrain at LoD 2, so that it is LoD 1. Vertices are those of
/// the mesh, in their order.
auto tin_relief(const Mesh& mesh, std::string& vertices, detail::Extent& extent) -> std::string {
  const auto quanta = [](double metres) { return std::llround(metres * model::quanta_per_metre); };
  for (const auto& p : mesh.vertices) {
    const detail::Vertex v{quanta(p.x), quanta(p.y), quanta(p.z)};
    detail::widen(extent, v);
    vertices += (vertices.empty() ? "[" : ",[") + std::to_string(v[0]) + "," + std::to_string(v[1]) + "," +
                std::to_string(v[2]) + "]";
  }
  JsonText json;
  json.begin_object().key(object_id).begin_object().key("type").text("TINRelief");
  json.key("geometry").begin_array().begin_object().key("type").text("CompositeSurface").key("lod").text("1");
  json.key("boundaries").begin_array();
  for (const auto& t : mesh.triangles) {
    json.begin_array().begin_array();
    for (const auto v : t) json.whole(v);
    json.end_array().end_array();
  }
  json.end_array().end_object().end_array().end_object().end_object();
  return std::move(json).str();
}

auto write_cityjson(const Mesh& mesh, const Header& header, const detail::CityJsonOptions& own, base::Sink& file)
    -> void {
  std::string vertices;
  detail::Extent extent;
  const auto objects = tin_relief(mesh, vertices, extent);
  JsonText json = cityjson_head(header, own, extent, 0);
  json.raw(objects).line().key("vertices").begin_array();
  if (!vertices.empty()) json.raw(vertices);
  file.append(json.end_array().line().end_object().take() + "\n");
}

auto write_cityjsonseq(const Mesh& mesh, const Header& header, const detail::CityJsonOptions& own, base::Sink& file)
    -> void {
  JsonText head = cityjson_head(header, own, std::nullopt, -1);
  head.begin_object().end_object().key("vertices").begin_array().end_array().end_object();
  file.append(head.take() + "\n");
  std::string vertices;
  detail::Extent extent;
  const auto objects = tin_relief(mesh, vertices, extent);
  JsonText json;
  json.begin_object().key("type").text("CityJSONFeature").key("id").text(object_id).key("CityObjects").raw(objects);
  json.key("vertices").begin_array();
  if (!vertices.empty()) json.raw(vertices);
  file.append(json.end_array().end_object().take() + "\n");
}

// ---- STL

auto write_stl(const Mesh& mesh, const Header& header, base::Sink& file) -> base::Result<void> {
  if (mesh.triangles.size() > UINT32_MAX)
    return base::error("write-stl-size", "there are more triangles than an STL can count; raise --terrain-tolerance");
  std::string head = "mansard; metres, z up; add";
  for (const auto metres : header.frame.origin) head += " " + std::to_string(metres);
  if (header.frame.crs.starts_with("EPSG:")) head += " for " + header.frame.crs;
  head.resize(80, ' ');
  detail::append_little_endian(head, static_cast<std::uint32_t>(mesh.triangles.size()));
  file.append(head);
  for (const auto& t : mesh.triangles) {
    const Point3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    std::string bytes;
    for (const Point3& p : {geometry::normalised(cross(b - a, c - a)), a, b, c})
      for (const double v : {p.x, p.y, p.z}) detail::append_float(bytes, static_cast<float>(v));
    bytes.append(2, '\0');
    file.append(bytes);
  }
  return {};
}

}  // namespace

auto terrain_format_of(const std::filesystem::path& path) -> std::optional<Format> {
  const auto format = format_of(path);
  if (!format || std::ranges::find(written, *format) == written.end()) return std::nullopt;
  return format;
}

auto terrain_extensions() -> std::string {
  std::string all;
  for (const auto& format : formats())
    if (std::ranges::find(written, format.format) != written.end())
      all += (all.empty() ? "" : ", ") + std::string(format.ending);
  return all;
}

auto write_terrain(Format format, const std::filesystem::path& path, const Mesh& mesh, const Header& header,
                   const WriteOptions& options, base::Outputs& outputs, const Mesh& below)
    -> base::Result<std::vector<base::Diagnostic>> {
  if (format == Format::tiles) {
    const auto globe = crs::Globe::of(header.frame);
    if (!globe) return globe.failure();
    const auto place = outputs.folder(path);
    if (!place) return place.failure();
    if (auto done = detail::write_terrain_tiles(*place, mesh, below, header, options, *globe); !done)
      return done.failure();
    return *globe ? (*globe)->warnings() : std::vector<base::Diagnostic>();
  }
  const auto file = outputs.file(path);
  if (!file) return file.failure();
  if (format == Format::stl) {
    if (auto done = write_stl(mesh, header, **file); !done) return done.failure();
  } else if (format == Format::glb) {
    JsonText extras;
    extras.begin_object().key("crs").text(header.frame.crs).key("origin").begin_array();
    for (const auto metres : header.frame.origin) extras.whole(metres);
    const auto bytes = detail::terrain_glb(mesh, header.made_by.version, extras.end_array().end_object().str());
    if (!bytes) return bytes.failure();
    (*file)->append(*bytes);
  } else {
    auto own = detail::cityjson_options(options, format);
    if (!own) return own.failure();
    own->lods = {};
    if (format == Format::cityjson) write_cityjson(mesh, header, *own, **file);
    else write_cityjsonseq(mesh, header, *own, **file);
  }
  return std::vector<base::Diagnostic>();
}

}  // namespace mansard::formats
