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

// ---- GLB

template <class T>
void append_little_endian(std::string& bytes, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) bytes += static_cast<char>((value >> (8 * i)) & 0xFF);
}
void append_float(std::string& bytes, float value) { append_little_endian(bytes, std::bit_cast<std::uint32_t>(value)); }

/// Of the corners, z up: means of the triangles around them by area. Upright triangles have them too.
auto normals_of(const Mesh& mesh) -> std::vector<Point3> {
  std::vector<Point3> out(mesh.vertices.size());
  for (const auto& t : mesh.triangles) {
    const Point3 a = mesh.vertices[t[0]];
    const Point3 normal = cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a);
    for (const auto v : t) out[v] = out[v] + normal;
  }
  for (auto& n : out) {
    n = geometry::normalised(n);
    if (dot(n, n) == 0) n = {0, 0, 1};
  }
  return out;
}

/// `extras` is a JSON object for the asset, or nothing. `box` becomes that of the vertices, z up.
auto glb_of(const Mesh& mesh, const std::string& version, std::string_view extras) -> base::Result<std::string> {
  // glTF is y up: x, z, −y.
  const auto turned = [](Point3 p) {
    return std::array{static_cast<float>(p.x), static_cast<float>(p.z), static_cast<float>(-p.y)};
  };
  std::string positions, normals, indices;
  std::array<float, 3> least{}, most{};
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto p = turned(mesh.vertices[v]);
    if (v == 0) least = most = p;
    for (std::size_t i = 0; i < 3; ++i) {
      append_float(positions, p[i]);
      least[i] = std::min(least[i], p[i]);
      most[i] = std::max(most[i], p[i]);
    }
  }
  for (const auto& n : normals_of(mesh)) {
    auto f = turned(n);
    const float length = std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
    for (const float c : f) append_float(normals, c / length);
  }
  for (const auto& t : mesh.triangles)
    for (const auto v : t) append_little_endian(indices, v);
  const std::uint64_t total = positions.size() + normals.size() + indices.size();
  if (total > 0xF0000000ULL)
    return base::error("write-glb-size", "the terrain is larger than the 4 GB of a GLB; raise --terrain-tolerance");
  JsonText json;
  json.begin_object()
      .key("asset")
      .begin_object()
      .key("version")
      .text("2.0")
      .key("generator")
      .text("mansard " + version);
  if (!extras.empty()) json.key("extras").raw(extras);
  json.end_object().key("scene").whole(0).key("scenes").begin_array().begin_object().key("nodes").begin_array();
  if (!mesh.triangles.empty()) json.whole(0);
  json.end_array().end_object().end_array();
  if (!mesh.triangles.empty()) {
    const auto view = [&](std::size_t offset, std::size_t length, int target) {
      json.begin_object().key("buffer").whole(0).key("byteOffset").whole(static_cast<std::int64_t>(offset));
      json.key("byteLength").whole(static_cast<std::int64_t>(length)).key("target").whole(target).end_object();
    };
    const auto accessor = [&](int number, int component, std::size_t count, const char* type) -> JsonText& {
      json.begin_object().key("bufferView").whole(number).key("componentType").whole(component);
      return json.key("count").whole(static_cast<std::int64_t>(count)).key("type").text(type);
    };
    const auto three = [&](const char* key, const std::array<float, 3>& values) {
      json.key(key).begin_array();
      for (const float value : values) json.number(static_cast<double>(value));
      json.end_array();
    };
    json.key("nodes")
        .begin_array()
        .begin_object()
        .key("mesh")
        .whole(0)
        .key("name")
        .text(object_id)
        .end_object()
        .end_array();
    json.key("meshes").begin_array().begin_object().key("name").text(object_id).key("primitives").begin_array();
    json.begin_object().key("attributes").begin_object().key("POSITION").whole(0).key("NORMAL").whole(1).end_object();
    json.key("indices").whole(2).key("material").whole(0).end_object().end_array().end_object().end_array();
    const auto colour = detail::class_colours[static_cast<std::size_t>(model::FaceClass::ground)];
    json.key("materials")
        .begin_array()
        .begin_object()
        .key("name")
        .text("ground")
        .key("pbrMetallicRoughness")
        .begin_object();
    json.key("baseColorFactor").begin_array();
    for (const int channel : colour) json.number(std::round(std::pow(channel / 255.0, 2.2) * 1e4) / 1e4);
    json.number(1).end_array().key("metallicFactor").whole(0).key("roughnessFactor").whole(1).end_object();
    json.key("doubleSided").flag(true).end_object().end_array();
    json.key("accessors").begin_array();
    accessor(0, 5126, mesh.vertices.size(), "VEC3");
    three("min", least);
    three("max", most);
    json.end_object();
    accessor(1, 5126, mesh.vertices.size(), "VEC3").end_object();
    accessor(2, 5125, 3 * mesh.triangles.size(), "SCALAR").end_object();
    json.end_array().key("bufferViews").begin_array();
    view(0, positions.size(), 34962);
    view(positions.size(), normals.size(), 34962);
    view(positions.size() + normals.size(), indices.size(), 34963);
    json.end_array().key("buffers").begin_array().begin_object().key("byteLength");
    json.whole(static_cast<std::int64_t>(total)).end_object().end_array();
  }
  std::string text = std::move(json.end_object()).str();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string out = "glTF";
  const std::uint64_t binary = mesh.triangles.empty() ? 0 : 8 + total;
  append_little_endian(out, std::uint32_t{2});
  append_little_endian(out, static_cast<std::uint32_t>(12 + 8 + text.size() + binary));
  append_little_endian(out, static_cast<std::uint32_t>(text.size()));
  out += "JSON" + text;
  if (binary > 0) {
    append_little_endian(out, static_cast<std::uint32_t>(total));
    out += std::string("BIN\0", 4);
    out += positions;
    out += normals;
    out += indices;
  }
  return out;
}

/// The triangles of a list, with their own corners.
auto part_of(const Mesh& mesh, std::span<const std::uint32_t> triangles) -> Mesh {
  Mesh out;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> numbers;  // of corners, by their number in the whole
  for (const auto t : triangles)
    for (const auto v : mesh.triangles[t]) numbers.emplace_back(v, 0);
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  for (auto& [v, number] : numbers) {
    number = static_cast<std::uint32_t>(out.vertices.size());
    out.vertices.push_back(mesh.vertices[v]);
  }
  for (const auto t : triangles) {
    geometry::Triangle corners{};
    for (std::size_t i = 0; i < 3; ++i)
      corners[i] =
          std::ranges::lower_bound(numbers, mesh.triangles[t][i], {}, [](const auto& n) { return n.first; })->second;
    out.triangles.push_back(corners);
  }
  return out;
}

// ---- 3D Tiles

void append_point(JsonText& json, Point3 p) { json.number(p.x).number(p.y).number(p.z); }

void append_box(JsonText& json, const geometry::Box3& box) {
  constexpr double margin = 0.002;  // metres; the JSON of a matrix and single precision are coarser than a double
  const Point3 half = 0.5 * (box.most - box.least) + Point3{margin, margin, margin};
  json.key("boundingVolume").begin_object().key("box").begin_array();
  append_point(json, 0.5 * (box.least + box.most));
  for (const Point3 axis : {Point3{half.x, 0, 0}, Point3{0, half.y, 0}, Point3{0, 0, half.z}}) append_point(json, axis);
  json.end_array().end_object();
}

/// Halves the triangles at the median of their middles until a tile has no more than `most`.
void halve(const Mesh& mesh, std::span<std::uint32_t> triangles, std::size_t most,
           std::vector<std::span<std::uint32_t>>& out) {
  if (triangles.size() <= most) {
    if (!triangles.empty()) out.push_back(triangles);
    return;
  }
  const auto middle = [&](std::uint32_t t) {
    const auto& c = mesh.triangles[t];
    return xy(mesh.vertices[c[0]]) + xy(mesh.vertices[c[1]]) + xy(mesh.vertices[c[2]]);
  };
  geometry::Box2 box;
  for (const auto t : triangles) box.add(middle(t));
  const bool wide = box.most.x - box.least.x >= box.most.y - box.least.y;
  std::ranges::sort(triangles, {}, [&](std::uint32_t t) {
    const auto at = middle(t);
    return std::tuple(wide ? at.x : at.y, wide ? at.y : at.x, t);
  });
  halve(mesh, triangles.first(triangles.size() / 2), most, out);
  halve(mesh, triangles.subspan(triangles.size() / 2), most, out);
}

/// A root without content, which is always refined, and the pieces below it: no piece replaces another, so that there
/// are no gaps between levels of detail.
auto write_tiles(const std::filesystem::path& folder, Mesh mesh, const Header& header, const WriteOptions& options,
                 const std::optional<crs::Globe>& globe) -> base::Result<void> {
  for (auto& v : mesh.vertices) v.z += options.tiles_height_offset;
  geometry::Box3 whole = geometry::Box3::of(mesh.vertices);
  crs::Place place;
  place.origin = whole.empty()
                     ? Point3{}
                     : Point3{(whole.least.x + whole.most.x) / 2, (whole.least.y + whole.most.y) / 2, whole.least.z};
  if (globe) {
    auto there = globe->place(place.origin);
    if (!there) return there.failure();
    place = *there;
    if (auto done = globe->to_earth(mesh.vertices); !done) return done;
  }
  for (auto& v : mesh.vertices) v = place.inside(v);
  std::vector<std::uint32_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0U);
  std::vector<std::span<std::uint32_t>> pieces;
  halve(mesh, order, std::max<std::size_t>(1, static_cast<std::size_t>(options.tile_triangles)), pieces);
  std::error_code failure;
  std::filesystem::create_directories(folder / "tiles", failure);
  whole = geometry::Box3::of(mesh.vertices);
  if (whole.empty()) whole.add({0, 0, 0});
  const double diagonal = std::ceil(length(whole.most - whole.least));
  JsonText json;
  json.begin_object().key("asset").begin_object().key("version").text("1.1").key("extras").begin_object();
  json.key("generator")
      .text("mansard " + header.made_by.version)
      .key("crs")
      .text(header.frame.crs)
      .end_object()
      .end_object();
  json.line().key("geometricError").number(diagonal).line().key("root").begin_object();
  append_box(json, whole);
  json.key("geometricError").number(diagonal).key("refine").text("ADD").key("transform").begin_array();
  for (const Point3 axis : {place.east, place.north, place.up}) {
    append_point(json, axis);
    json.number(0);
  }
  append_point(json, place.origin);
  json.number(1).end_array();
  if (!pieces.empty()) json.key("children").begin_array();
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    std::ranges::sort(pieces[i]);
    const auto piece = part_of(mesh, pieces[i]);
    const auto name = "tiles/terrain-" + std::to_string(i) + ".glb";
    const auto bytes = glb_of(piece, header.made_by.version, {});
    if (!bytes) return bytes.failure();
    if (auto done = base::write_file(folder / name, *bytes); !done) return done;
    json.line().begin_object();
    append_box(json, geometry::Box3::of(piece.vertices));
    json.key("geometricError").number(0).key("content").begin_object().key("uri").text(name).end_object().end_object();
  }
  if (!pieces.empty()) json.end_array();
  json.end_object().line().end_object();
  return base::write_file(folder / "tileset.json", std::move(json).str() + "\n");
}

// ---- STL

auto write_stl(const Mesh& mesh, const Header& header, base::Sink& file) -> base::Result<void> {
  if (mesh.triangles.size() > UINT32_MAX)
    return base::error("write-stl-size", "there are more triangles than an STL can count; raise --terrain-tolerance");
  std::string head = "mansard; metres, z up; add";
  for (const auto metres : header.frame.origin) head += " " + std::to_string(metres);
  if (header.frame.crs.starts_with("EPSG:")) head += " for " + header.frame.crs;
  head.resize(80, ' ');
  append_little_endian(head, static_cast<std::uint32_t>(mesh.triangles.size()));
  file.append(head);
  for (const auto& t : mesh.triangles) {
    const Point3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    std::string bytes;
    for (const Point3& p : {geometry::normalised(cross(b - a, c - a)), a, b, c})
      for (const double v : {p.x, p.y, p.z}) append_float(bytes, static_cast<float>(v));
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
                   const WriteOptions& options, base::Outputs& outputs) -> base::Result<std::vector<base::Diagnostic>> {
  if (format == Format::tiles) {
    const auto globe = crs::Globe::of(header.frame);
    if (!globe) return globe.failure();
    const auto place = outputs.folder(path);
    if (!place) return place.failure();
    if (auto done = write_tiles(*place, mesh, header, options, *globe); !done) return done.failure();
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
    const auto bytes = glb_of(mesh, header.made_by.version, extras.end_array().end_object().str());
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
