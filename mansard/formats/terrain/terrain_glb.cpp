#include "mansard/formats/terrain/terrain_glb.hpp"

#include <array>
#include <cmath>
#include <vector>

#include "mansard/formats/detail/parts.hpp"
#include "mansard/formats/json/json_text.hpp"

namespace mansard::formats::detail {
namespace {

using geometry::Mesh;
using geometry::Point3;

constexpr std::string_view mesh_name = "terrain";

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

}  // namespace

auto terrain_glb(const Mesh& mesh, const std::string& version, std::string_view extras) -> base::Result<std::string> {
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
        .text(mesh_name)
        .end_object()
        .end_array();
    json.key("meshes").begin_array().begin_object().key("name").text(mesh_name).key("primitives").begin_array();
    json.begin_object().key("attributes").begin_object().key("POSITION").whole(0).key("NORMAL").whole(1).end_object();
    json.key("indices").whole(2).key("material").whole(0).end_object().end_array().end_object().end_array();
    const auto colour = class_colours[static_cast<std::size_t>(model::FaceClass::ground)];
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

}  // namespace mansard::formats::detail
