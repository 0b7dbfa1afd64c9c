// A mesh with a class per triangle.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <numeric>

#include "mansard/formats/json/json_text.hpp"
#include "mansard/formats/scan.hpp"

namespace mansard::formats {
namespace {

using model::SurfaceClass;
static_assert(std::endian::native == std::endian::little, "both formats are little-endian");

template <class T>
void append(std::string& out, T value) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), &value, sizeof(T));
  out.append(raw.data(), raw.size());
}

/// Linear, as glTF has them: grey, red, grey-green as in the models, and green for all else.
constexpr std::array<std::array<double, 4>, model::surface_class_count> colours{
    {{0.687, 0.658, 0.604, 1}, {0.434, 0.122, 0.080, 1}, {0.188, 0.202, 0.188, 1}, {0.093, 0.305, 0.107, 1}}};

/// The triangles of each class that occurs.
struct Group {
  SurfaceClass kind = SurfaceClass::wall;
  std::size_t first = 0, indices = 0;
};

struct Buffers {
  std::vector<std::array<float, 3>> positions;
  std::vector<std::uint32_t> indices;
  std::vector<Group> groups;
};

auto buffers_of(const geometry::Mesh& mesh, std::span<const SurfaceClass> classes) -> Buffers {
  Buffers out;
  for (const auto v : mesh.vertices)
    out.positions.push_back({static_cast<float>(v.x), static_cast<float>(v.z), static_cast<float>(-v.y)});
  for (std::size_t c = 0; c < model::surface_class_count; ++c) {
    const Group group{static_cast<SurfaceClass>(c), out.indices.size(), 0};
    for (std::size_t t = 0; t < classes.size(); ++t)
      if (classes[t] == group.kind)
        out.indices.insert(out.indices.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
    if (out.indices.size() > group.first)
      out.groups.push_back({group.kind, group.first, out.indices.size() - group.first});
  }
  return out;
}

void append_materials(detail::JsonText& json, const std::vector<Group>& groups) {
  json.key("materials").begin_array();
  for (const auto& group : groups) {
    json.begin_object().key("name").text(model::to_string(group.kind)).key("doubleSided").flag(true);
    json.key("pbrMetallicRoughness").begin_object().key("baseColorFactor").begin_array();
    for (const double channel : colours[static_cast<std::size_t>(group.kind)]) json.number(channel);
    json.end_array().key("metallicFactor").number(0).key("roughnessFactor").number(0.9).end_object();
    json.end_object();
  }
  json.end_array();
}

/// Accessor 0 is the positions, accessor 1 + i the indices of group i.
void append_accessors(detail::JsonText& json, const Buffers& buffers) {
  constexpr int float_number = 5126, unsigned_int = 5125;
  json.key("accessors")
      .begin_array()
      .begin_object()
      .key("bufferView")
      .whole(0)
      .key("componentType")
      .whole(float_number);
  json.key("count").whole(static_cast<std::int64_t>(buffers.positions.size())).key("type").text("VEC3");
  auto least = buffers.positions.front(), most = least;
  for (const auto& p : buffers.positions)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      least[axis] = std::min(least[axis], p[axis]);
      most[axis] = std::max(most[axis], p[axis]);
    }
  for (const auto& [name, bound] : {std::pair{"min", least}, std::pair{"max", most}}) {
    json.key(name).begin_array();
    for (const float c : bound) json.number(static_cast<double>(c));
    json.end_array();
  }
  json.end_object();
  for (const auto& group : buffers.groups) {
    json.begin_object().key("bufferView").whole(1);
    json.key("byteOffset").whole(static_cast<std::int64_t>(group.first * sizeof(std::uint32_t)));
    json.key("componentType").whole(unsigned_int).key("count").whole(static_cast<std::int64_t>(group.indices));
    json.key("type").text("SCALAR").end_object();
  }
  json.end_array();
}

void append_views(detail::JsonText& json, const Buffers& buffers) {
  constexpr int array_buffer = 34962, element_array_buffer = 34963;
  const auto positions = static_cast<std::int64_t>(buffers.positions.size() * sizeof(buffers.positions.front()));
  const auto indices = static_cast<std::int64_t>(buffers.indices.size() * sizeof(std::uint32_t));
  json.key("bufferViews").begin_array();
  json.begin_object().key("buffer").whole(0).key("byteOffset").whole(0).key("byteLength").whole(positions);
  json.key("target").whole(array_buffer).end_object();
  json.begin_object().key("buffer").whole(0).key("byteOffset").whole(positions).key("byteLength").whole(indices);
  json.key("target").whole(element_array_buffer).end_object().end_array();
  json.key("buffers")
      .begin_array()
      .begin_object()
      .key("byteLength")
      .whole(positions + indices)
      .end_object()
      .end_array();
}

auto json_chunk(const Buffers& buffers, const model::Frame& frame) -> std::string {
  detail::JsonText json;
  json.begin_object().key("asset").begin_object().key("version").text("2.0").key("generator").text("mansard label");
  json.key("extras").begin_object().key("crs").text(frame.crs).key("origin").begin_array();
  for (const auto metres : frame.origin) json.whole(metres);
  json.end_array().end_object().end_object();
  json.key("scene").whole(0).key("scenes").begin_array().begin_object().key("nodes").begin_array().whole(0);
  json.end_array().end_object().end_array();
  json.key("nodes").begin_array().begin_object().key("mesh").whole(0).end_object().end_array();
  json.key("meshes").begin_array().begin_object().key("primitives").begin_array();
  for (std::size_t i = 0; i < buffers.groups.size(); ++i) {
    const auto number = static_cast<std::int64_t>(i);
    json.begin_object().key("attributes").begin_object().key("POSITION").whole(0).end_object();
    json.key("indices").whole(1 + number).key("material").whole(number).end_object();
  }
  json.end_array().end_object().end_array();
  append_materials(json, buffers.groups);
  append_accessors(json, buffers);
  append_views(json, buffers);
  return std::move(json.end_object()).str();
}

}  // namespace

auto labelled_ply(const geometry::Mesh& mesh, std::span<const SurfaceClass> classes, const model::Frame& frame)
    -> std::string {
  std::string out = "ply\nformat binary_little_endian 1.0\ncomment made by mansard label\n";
  out += "comment class: 0 wall, 1 roof, 2 ground, 3 other\nelement vertex " + std::to_string(mesh.vertices.size()) +
         "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
         std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nproperty uchar class\n" +
         "end_header\n";
  const auto& o = frame.origin;
  for (const auto v : mesh.vertices) {
    append(out, v.x + static_cast<double>(o[0]));
    append(out, v.y + static_cast<double>(o[1]));
    append(out, v.z + static_cast<double>(o[2]));
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    append(out, std::uint8_t{3});
    for (const auto v : mesh.triangles[t]) append(out, static_cast<std::int32_t>(v));
    append(out, static_cast<std::uint8_t>(classes[t]));
  }
  return out;
}

auto labelled_glb(const geometry::Mesh& mesh, std::span<const SurfaceClass> classes, const model::Frame& frame)
    -> base::Result<std::string> {
  const Buffers buffers = buffers_of(mesh, classes);
  std::string json = json_chunk(buffers, frame);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::size_t binary =
      buffers.positions.size() * sizeof(buffers.positions.front()) + buffers.indices.size() * sizeof(std::uint32_t);
  const std::size_t size = 12 + 8 + json.size() + 8 + binary;
  if (size > std::numeric_limits<std::uint32_t>::max())
    return base::error("write-glb-size", "the mesh is larger than the 4 GB a GLB can hold; write it as PLY");
  std::string out = "glTF";
  const auto append_size = [&](std::size_t value) { append(out, static_cast<std::uint32_t>(value)); };
  append_size(2);
  append_size(size);
  append_size(json.size());
  out += "JSON" + json;
  append_size(binary);
  out.append("BIN\0", 4);
  out.append(reinterpret_cast<const char*>(buffers.positions.data()),
             buffers.positions.size() * sizeof(buffers.positions.front()));
  out.append(reinterpret_cast<const char*>(buffers.indices.data()), buffers.indices.size() * sizeof(std::uint32_t));
  return out;
}

}  // namespace mansard::formats
