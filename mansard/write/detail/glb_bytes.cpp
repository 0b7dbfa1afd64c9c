#include "mansard/write/detail/glb_bytes.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <span>

#include "mansard/write/detail/triangles.hpp"

namespace mansard::write::detail {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF buffers are little-endian");

using Float3 = std::array<float, 3>;

/// East, up, south: y is up in glTF.
auto y_up(geometry::Point3 p) -> Float3 {
  return {static_cast<float>(p.x), static_cast<float>(p.z), static_cast<float>(-p.y)};
}

/// The triangles of one class of one part.
struct Primitive {
  std::size_t surface_class = 0;
  std::size_t first_vertex = 0, vertices = 0, first_index = 0, indices = 0;
  Float3 least{}, most{};
};

struct PartMesh {
  std::string key, building;
  std::vector<Primitive> primitives;
};

struct Buffers {
  std::vector<Float3> positions, normals;
  std::vector<std::uint32_t> indices;
};

/// Vertices are shared within a face and not between faces, so every face keeps its own flat normal.
auto append_part(Buffers& buffers, PartMesh& mesh, const Part& part) -> base::Result<void> {
  const auto& solid = part.model.solid;
  const auto triangulated = triangles_of(solid, part.id);
  if (!triangulated) return triangulated.error();
  std::array<std::vector<std::size_t>, class_count> of_class;
  for (std::size_t t = 0; t < triangulated->triangles.size(); ++t)
    of_class[static_cast<std::size_t>(part.model.classes[triangulated->face_of[t]])].push_back(t);
  constexpr std::uint32_t none = ~0U;
  std::vector<std::uint32_t> index_of(solid.vertices.size(), none);  // within the face at hand
  for (std::size_t c = 0; c < class_count; ++c) {
    Primitive primitive{c, buffers.positions.size(), 0, buffers.indices.size(), 0, {}, {}};
    std::uint32_t face = none;
    for (const std::size_t t : of_class[c]) {
      if (const std::uint32_t f = triangulated->face_of[t]; f != face) {
        face = f;
        for (const auto& loop : solid.faces[f].loops)
          for (const auto v : loop) index_of[v] = none;
      }
      for (const auto corner : triangulated->triangles[t]) {
        if (index_of[corner] == none) {
          index_of[corner] = static_cast<std::uint32_t>(buffers.positions.size() - primitive.first_vertex);
          buffers.positions.push_back(y_up(solid.vertices[corner]));
          buffers.normals.push_back(y_up(geometry::normalised(solid.faces[face].normal)));
        }
        buffers.indices.push_back(index_of[corner]);
      }
    }
    primitive.vertices = buffers.positions.size() - primitive.first_vertex;
    primitive.indices = buffers.indices.size() - primitive.first_index;
    if (primitive.indices == 0) continue;
    const std::span used(buffers.positions.data() + primitive.first_vertex, primitive.vertices);
    primitive.least = primitive.most = used.front();
    for (const Float3& v : used)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        primitive.least[axis] = std::min(primitive.least[axis], v[axis]);
        primitive.most[axis] = std::max(primitive.most[axis], v[axis]);
      }
    mesh.primitives.push_back(primitive);
  }
  return {};
}

enum Component : std::int64_t { unsigned_int = 5125, float_number = 5126 };
enum Target : std::int64_t { array_buffer = 34962, element_array_buffer = 34963 };

/// Buffer views, in the order of the buffer.
enum View : std::int64_t { positions_view, normals_view, indices_view };

/// base_color is linear in glTF, and our colours are sRGB (IEC 61966-2-1, here to three decimals).
constexpr std::array<std::array<double, 4>, class_count> linear_colours{{{0.687, 0.658, 0.604, 1},
                                                                         {0.305, 0.305, 0.342, 1},
                                                                         {0.434, 0.122, 0.080, 1},
                                                                         {0.188, 0.202, 0.188, 1},
                                                                         {0.305, 0.231, 0.162, 1}}};

/// The classes that occur, in order: the file's materials.
auto materials_of(const std::vector<PartMesh>& meshes) -> std::vector<std::size_t> {
  std::vector<std::size_t> classes;
  for (std::size_t c = 0; c < class_count; ++c)
    if (std::ranges::any_of(meshes, [&](const PartMesh& mesh) {
          return std::ranges::any_of(mesh.primitives, [&](const Primitive& p) { return p.surface_class == c; });
        }))
      classes.push_back(c);
  return classes;
}

void append_materials(JsonText& json, const std::vector<std::size_t>& materials) {
  json.key("materials").begin_array();
  for (const std::size_t c : materials) {
    json.begin_object().key("name").text(class_name(static_cast<label::Class>(c)));
    json.key("pbrMetallicRoughness").begin_object().key("baseColorFactor").begin_array();
    for (const double channel : linear_colours[c]) json.number(channel);
    json.end_array().key("metallicFactor").number(0).key("roughnessFactor").number(0.9).end_object().end_object();
  }
  json.end_array();
}

void append_bounds(JsonText& json, const char* name, const Float3& bounds) {
  json.key(name).begin_array();
  for (const float v : bounds) json.number(static_cast<double>(v));  // exact: readers compare with the buffer
  json.end_array();
}

void append_accessors(JsonText& json, const std::vector<PartMesh>& meshes) {
  const auto accessor = [&](View view, std::size_t offset, Component component, std::size_t count, const char* type) {
    json.begin_object().key("bufferView").whole(view).key("byteOffset").whole(static_cast<std::int64_t>(offset));
    json.key("componentType").whole(component).key("count").whole(static_cast<std::int64_t>(count));
    json.key("type").text(type);
  };
  json.key("accessors").begin_array();
  for (const PartMesh& mesh : meshes)
    for (const Primitive& p : mesh.primitives) {
      accessor(positions_view, p.first_vertex * sizeof(Float3), float_number, p.vertices, "VEC3");
      append_bounds(json, "min", p.least);
      append_bounds(json, "max", p.most);
      json.end_object();
      accessor(normals_view, p.first_vertex * sizeof(Float3), float_number, p.vertices, "VEC3");
      json.end_object();
      accessor(indices_view, p.first_index * sizeof(std::uint32_t), unsigned_int, p.indices, "SCALAR");
      json.end_object();
    }
  json.end_array();
}

void append_meshes(JsonText& json, const std::vector<PartMesh>& meshes, const std::vector<std::size_t>& materials) {
  std::int64_t accessor = 0;
  json.key("meshes").begin_array();
  for (const PartMesh& mesh : meshes) {
    json.begin_object().key("name").text(mesh.key).key("primitives").begin_array();
    for (const Primitive& p : mesh.primitives) {
      json.begin_object().key("attributes").begin_object().key("POSITION").whole(accessor);
      json.key("NORMAL").whole(accessor + 1).end_object();
      const auto material = std::ranges::find(materials, p.surface_class) - materials.begin();
      json.key("indices").whole(accessor + 2).key("material").whole(material).end_object();
      accessor += 3;
    }
    json.end_array().end_object();
  }
  json.end_array();
}

void append_buffer(JsonText& json, const Buffers& buffers) {
  const std::array<std::size_t, 3> sizes{buffers.positions.size() * sizeof(Float3),
                                         buffers.normals.size() * sizeof(Float3),
                                         buffers.indices.size() * sizeof(std::uint32_t)};
  std::size_t offset = 0;
  json.key("bufferViews").begin_array();
  for (const View view : {positions_view, normals_view, indices_view}) {
    const std::size_t size = sizes[static_cast<std::size_t>(view)];
    json.begin_object().key("buffer").whole(0).key("byteOffset").whole(static_cast<std::int64_t>(offset));
    json.key("byteLength").whole(static_cast<std::int64_t>(size));
    if (view != indices_view) json.key("byteStride").whole(sizeof(Float3));
    json.key("target").whole(view == indices_view ? element_array_buffer : array_buffer).end_object();
    offset += size;
  }
  json.end_array().key("buffers").begin_array().begin_object().key("byteLength");
  json.whole(static_cast<std::int64_t>(offset)).end_object().end_array();
}

auto json_chunk(const City& city, const std::vector<PartMesh>& meshes, const Buffers& buffers) -> std::string {
  JsonText json;
  json.begin_object().key("asset").begin_object().key("version").text("2.0").key("generator");
  json.text("mansard " + city.made_by.version).key("extras").begin_object().key("crs").text(city.frame.crs);
  json.key("origin").begin_array();
  for (const auto metres : city.frame.origin) json.whole(metres);
  append_made_by(json.end_array().key("made_by"), city.made_by);
  json.end_object().end_object();

  json.key("scene").whole(0).key("scenes").begin_array().begin_object();
  if (!meshes.empty()) {  // glTF allows no empty lists
    json.key("nodes").begin_array();
    for (std::size_t i = 0; i < meshes.size(); ++i) json.whole(static_cast<std::int64_t>(i));
    json.end_array().end_object().end_array().key("nodes").begin_array();
    for (std::size_t i = 0; i < meshes.size(); ++i)
      json.begin_object().key("name").text(meshes[i].key).key("mesh").whole(static_cast<std::int64_t>(i))
          .key("extras").begin_object().key("building").text(meshes[i].building).end_object().end_object();
    json.end_array();
    const auto materials = materials_of(meshes);
    append_meshes(json, meshes, materials);
    append_materials(json, materials);
    append_accessors(json, meshes);
    append_buffer(json, buffers);
  } else {
    json.end_object().end_array();
  }
  return std::move(json.end_object()).str();
}

void append_number(std::string& out, std::size_t value) {
  const auto number = static_cast<std::uint32_t>(value);
  out.append(reinterpret_cast<const char*>(&number), sizeof number);
}

template <class T>
void append_bytes(std::string& out, const std::vector<T>& values) {
  out.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

}  // namespace

auto glb_bytes(const City& city, const Keys& keys) -> base::Result<std::string> {
  Buffers buffers;
  std::vector<PartMesh> meshes;
  for (std::size_t b = 0; b < city.buildings.size(); ++b)
    for (std::size_t p = 0; p < city.buildings[b].parts.size(); ++p) {
      PartMesh mesh{keys.parts[b][p], keys.buildings[b], {}};
      if (const auto added = append_part(buffers, mesh, city.buildings[b].parts[p]); !added) return added.error();
      if (!mesh.primitives.empty()) meshes.push_back(std::move(mesh));
    }

  std::string json = json_chunk(city, meshes, buffers);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string binary;
  append_bytes(binary, buffers.positions);
  append_bytes(binary, buffers.normals);
  append_bytes(binary, buffers.indices);

  const std::size_t size = 12 + 8 + json.size() + (binary.empty() ? 0 : 8 + binary.size());
  if (size > std::numeric_limits<std::uint32_t>::max())
    return base::error("write-glb-size",
                       "the model is larger than the 4 GB a GLB can hold; write it in several pieces");
  std::string out = "glTF";
  append_number(out, 2);
  append_number(out, size);
  append_number(out, json.size());
  out += "JSON" + json;
  if (!binary.empty()) {
    append_number(out, binary.size());
    out.append("BIN\0", 4);
    out += binary;
  }
  return out;
}

}  // namespace mansard::write::detail
