#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <tuple>

#include "mansard/formats/gltf/draco.hpp"
#include "mansard/formats/gltf/gltf_input.hpp"
#include "mansard/formats/gltf/gltf_material.hpp"
#include "mansard/formats/mesh/mesh_formats.hpp"
#include "mansard/formats/mesh/textured_formats.hpp"
#include "mansard/formats/mesh/transform.hpp"

namespace mansard::formats {
namespace {

using geometry::Point3;

auto transform_of(const tinygltf::Node& node) -> Transform {
  if (node.matrix.size() == 16) return Transform::by_columns(node.matrix);
  const auto part = [](const std::vector<double>& given, std::array<double, 4> value, std::size_t size) {
    if (given.size() == size) std::copy(given.begin(), given.end(), value.begin());
    return value;
  };
  const auto [x, y, z, w] = part(node.rotation, {0, 0, 0, 1}, 4);
  const auto scale = part(node.scale, {1, 1, 1, 0}, 3);
  const auto shift = part(node.translation, {0, 0, 0, 0}, 3);
  const std::array<std::array<double, 3>, 3> turn{
      {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
       {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
       {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}}};
  Transform t;
  for (std::size_t i = 0; i < 3; ++i)
    t.row[i] = {turn[i][0] * scale[0], turn[i][1] * scale[1], turn[i][2] * scale[2], shift[i]};
  return t;
}

/// Elements of an accessor, read where they lie; made only when all of them are within the buffer.
struct View {
  const unsigned char* data = nullptr;
  std::size_t count = 0, stride = 0, components = 0;
  int type = 0;
  bool normalised = false;

  /// Component c of element i; integers that stand for fractions are scaled as the specification says.
  [[nodiscard]] auto value(std::size_t i, std::size_t c) const -> double {
    const unsigned char* at =
        data + i * stride +
        c * static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type)));
    const auto as = [at](auto sample) {
      std::memcpy(&sample, at, sizeof sample);
      return static_cast<double>(sample);
    };
    const auto fraction = [this](double raw, double most) { return normalised ? std::max(raw / most, -1.0) : raw; };
    switch (type) {
      case TINYGLTF_COMPONENT_TYPE_BYTE: return fraction(as(std::int8_t{}), 127);
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return fraction(as(std::uint8_t{}), 255);
      case TINYGLTF_COMPONENT_TYPE_SHORT: return fraction(as(std::int16_t{}), 32767);
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return fraction(as(std::uint16_t{}), 65535);
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return as(std::uint32_t{});
      case TINYGLTF_COMPONENT_TYPE_DOUBLE: return as(double{});
      default: return as(float{});
    }
  }
};

class GltfReader {
 public:
  /// With `textured`, its corners and materials are those of the triangles that are read.
  GltfReader(const tinygltf::Model& model, std::string name, TexturedMesh* textured = nullptr)
      : model_(model), name_(std::move(name)), textured_(textured) {}

  auto read() -> base::Result<RawMesh> {
    std::vector<int> roots;
    if (const int scene = std::max(model_.defaultScene, 0); static_cast<std::size_t>(scene) < model_.scenes.size()) {
      roots = model_.scenes[static_cast<std::size_t>(scene)].nodes;
    } else {
      std::vector<char> child(model_.nodes.size(), 0);
      for (const auto& node : model_.nodes)
        for (const int c : node.children)
          if (c >= 0 && static_cast<std::size_t>(c) < child.size()) child[static_cast<std::size_t>(c)] = 1;
      for (std::size_t i = 0; i < child.size(); ++i)
        if (child[i] == 0) roots.push_back(static_cast<int>(i));
    }
    for (const int root : roots)
      if (auto done = take_node(root, {}, 0); !done) return done.error();
    return std::move(mesh_);
  }

 private:
  auto bad(const std::string& what) const -> base::Diagnostic {
    return base::error("ingest-mesh-format", what + "; export the mesh again", name_);
  }

  auto take_node(int index, const Transform& outer, int depth) -> base::Result<void> {
    if (index < 0 || static_cast<std::size_t>(index) >= model_.nodes.size()) return bad("a node does not exist");
    // A node has one parent, so more visits than nodes means that the tree bites its tail.
    if (depth > 1000 || ++visits_ > model_.nodes.size()) return bad("the nodes are not a tree");
    const auto& node = model_.nodes[static_cast<std::size_t>(index)];
    const Transform here = outer.after(transform_of(node));
    if (node.mesh >= 0) {
      if (static_cast<std::size_t>(node.mesh) >= model_.meshes.size()) return bad("a mesh does not exist");
      for (const auto& primitive : model_.meshes[static_cast<std::size_t>(node.mesh)].primitives)
        if (auto done = take_primitive(primitive, here); !done) return done;
    }
    for (const int child : node.children)
      if (auto done = take_node(child, here, depth + 1); !done) return done;
    return {};
  }

  auto view_of(int buffer_view, std::size_t offset, std::size_t count, int type, int shape) const
      -> std::optional<View> {
    View view;
    const int size = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type));
    const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(shape));
    if (size <= 0 || components <= 0) return std::nullopt;
    if (buffer_view < 0 || static_cast<std::size_t>(buffer_view) >= model_.bufferViews.size()) return std::nullopt;
    const auto& piece = model_.bufferViews[static_cast<std::size_t>(buffer_view)];
    if (piece.buffer < 0 || static_cast<std::size_t>(piece.buffer) >= model_.buffers.size()) return std::nullopt;
    const auto& bytes = model_.buffers[static_cast<std::size_t>(piece.buffer)].data;
    const auto element = static_cast<std::size_t>(size) * static_cast<std::size_t>(components);
    view.stride = piece.byteStride > 0 ? piece.byteStride : element;
    view.components = static_cast<std::size_t>(components);
    view.count = count;
    view.type = type;
    if (piece.byteOffset > bytes.size() || piece.byteLength > bytes.size() - piece.byteOffset) return std::nullopt;
    if (count > 0) {
      if (offset > piece.byteLength || element > piece.byteLength - offset) return std::nullopt;
      if ((count - 1) > (piece.byteLength - offset - element) / view.stride) return std::nullopt;
      view.data = bytes.data() + piece.byteOffset + offset;
    }
    return view;
  }

  auto accessor(int index) const -> const tinygltf::Accessor* {
    const bool exists = index >= 0 && static_cast<std::size_t>(index) < model_.accessors.size();
    return exists ? &model_.accessors[static_cast<std::size_t>(index)] : nullptr;
  }

  auto bytes_of_all() const -> std::size_t {
    std::size_t bytes = 0;
    for (const auto& buffer : model_.buffers) bytes += buffer.data.size();
    return bytes;
  }

  auto positions_of(const tinygltf::Accessor& given) const -> std::optional<std::vector<Point3>> {
    std::vector<Point3> points;
    if (given.bufferView >= 0) {
      auto view = view_of(given.bufferView, given.byteOffset, given.count, given.componentType, given.type);
      if (!view || view->components != 3) return std::nullopt;
      view->normalised = given.normalized;
      points.reserve(view->count);
      for (std::size_t i = 0; i < view->count; ++i)
        points.push_back({view->value(i, 0), view->value(i, 1), view->value(i, 2)});
    } else {
      // All zero but for what the sparse part says. A corner that any triangle names takes a byte somewhere, so that
      // more of them than bytes is a count to fill the memory with.
      if (!given.sparse.isSparse || given.count > bytes_of_all()) return std::nullopt;
      points.resize(given.count);
    }
    if (!given.sparse.isSparse || given.sparse.count <= 0) return points;
    const auto& sparse = given.sparse;
    const auto size = static_cast<std::size_t>(sparse.count);
    const auto where = view_of(sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset), size,
                               sparse.indices.componentType, TINYGLTF_TYPE_SCALAR);
    auto what = view_of(sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset), size,
                        given.componentType, given.type);
    if (!where || !what || what->components != 3) return std::nullopt;
    what->normalised = given.normalized;
    for (std::size_t i = 0; i < size; ++i) {
      const double at = where->value(i, 0);
      if (!(at >= 0 && at < static_cast<double>(points.size()))) return std::nullopt;
      points[static_cast<std::size_t>(at)] = {what->value(i, 0), what->value(i, 1), what->value(i, 2)};
    }
    return points;
  }

  /// The corners of the triangles of a primitive, as numbers of its own points; one beyond them where it says so.
  auto corners_of(const tinygltf::Primitive& primitive, std::size_t points) const
      -> std::optional<std::vector<std::uint32_t>> {
    std::vector<std::uint32_t> corners;
    if (primitive.indices < 0) {
      for (std::size_t i = 0; i < points; ++i) corners.push_back(static_cast<std::uint32_t>(i));
      return corners;
    }
    const auto* list = accessor(primitive.indices);
    const auto view = list == nullptr ? std::nullopt
                                      : view_of(list->bufferView, list->byteOffset, list->count, list->componentType,
                                                TINYGLTF_TYPE_SCALAR);
    if (!view) return std::nullopt;
    corners.reserve(view->count);
    for (std::size_t i = 0; i < view->count; ++i) {
      const double corner = view->value(i, 0);
      const bool names_one = corner >= 0 && corner < static_cast<double>(points);
      corners.push_back(names_one ? static_cast<std::uint32_t>(corner) : no_vertex);
    }
    return corners;
  }

  /// Numbers of an attribute, point by point; empty where it is not there, or is not sound.
  auto numbers_of(const tinygltf::Primitive& primitive, const std::string& attribute, std::size_t points,
                  std::size_t& components) const -> std::vector<float> {
    const auto at = primitive.attributes.find(attribute);
    const auto* given = at == primitive.attributes.end() ? nullptr : accessor(at->second);
    if (given == nullptr || given->count < points || given->bufferView < 0) return {};
    auto view = view_of(given->bufferView, given->byteOffset, given->count, given->componentType, given->type);
    if (!view) return {};
    view->normalised = given->normalized;
    components = view->components;
    std::vector<float> out;
    out.reserve(points * components);
    for (std::size_t i = 0; i < points; ++i)
      for (std::size_t c = 0; c < components; ++c) out.push_back(static_cast<float>(view->value(i, c)));
    return out;
  }

  /// The texture coordinates and colours of the points of a primitive.
  struct Paint {
    GltfMaterial material;
    std::size_t uv_components = 2, colour_components = 0;
    std::vector<float> uv, colours;
  };

  auto paint_of(const tinygltf::Primitive& primitive, std::size_t points) const -> Paint {
    Paint out{material_of(model_, primitive.material), 2, 0, {}, {}};
    const auto set = "TEXCOORD_" + std::to_string(out.material.uv_set);
    out.uv = numbers_of(primitive, set, points, out.uv_components);
    out.colours = numbers_of(primitive, "COLOR_0", points, out.colour_components);
    return out;
  }

  /// What colours the triangles from `before` on, whose corners count from `first`.
  void paint(const Paint& paint, std::size_t before, std::size_t first) {
    auto& out = *textured_;
    const bool pictured = paint.material.image >= 0 && !paint.uv.empty() && paint.uv_components == 2;
    std::uint32_t number = no_material;
    if (pictured) {
      const auto& [image, wrap] = std::tie(paint.material.image, paint.material.wrap);
      const auto [entry, added] = material_numbers_.try_emplace(std::tuple(image, wrap[0], wrap[1]),
                                                                static_cast<std::uint32_t>(out.materials.size()));
      if (added) out.materials.push_back({image_source(model_, image, name_), wrap});
      number = entry->second;
    }
    for (std::size_t t = before; t < mesh_.triangles.size(); ++t) {
      TexturedCorners corners;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t point = mesh_.triangles[t][c] - first;
        const bool exists = mesh_.triangles[t][c] != no_vertex;
        if (pictured && exists) corners.uv[c] = paint.material.turned(paint.uv[2 * point], paint.uv[2 * point + 1]);
        for (std::size_t k = 0; k < 3; ++k) {
          double light = paint.material.factor[k];
          if (exists && paint.colour_components >= 3)
            light *= static_cast<double>(paint.colours[point * paint.colour_components + k]);
          corners.colour[c][k] =
              static_cast<std::uint16_t>(std::lround((light > 0 ? std::min(light, 1.0) : 0) * 65535));
        }
      }
      out.corners.push_back(corners);
      out.material_of.push_back(number);
    }
  }

  auto packed_primitive(const tinygltf::Value& packed, const tinygltf::Accessor& given,
                        std::span<DracoExtra> more) const -> base::Result<geometry::Mesh> {
    const auto whole = [](const tinygltf::Value& object, const char* key) {
      return object.Has(key) && object.Get(key).IsInt() ? object.Get(key).GetNumberAsInt() : -1;
    };
    const int position = packed.Has("attributes") ? whole(packed.Get("attributes"), "POSITION") : -1;
    const int piece = whole(packed, "bufferView");
    if (position < 0 || piece < 0 || static_cast<std::size_t>(piece) >= model_.bufferViews.size())
      return bad("a primitive packed with Draco does not say where it is");
    const auto bytes = model_.bufferViews[static_cast<std::size_t>(piece)].byteLength;
    const auto view = view_of(piece, 0, bytes, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_TYPE_SCALAR);
    if (!view) return bad("a primitive packed with Draco reaches beyond its buffer");
    return unpack_draco({view->data, bytes}, static_cast<std::uint32_t>(position), given.normalized, name_, more);
  }

  auto take_primitive(const tinygltf::Primitive& primitive, const Transform& here) -> base::Result<void> {
    const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    if (mode != TINYGLTF_MODE_TRIANGLES && mode != TINYGLTF_MODE_TRIANGLE_STRIP && mode != TINYGLTF_MODE_TRIANGLE_FAN)
      return {};  // points and lines have no surface
    const auto at = primitive.attributes.find("POSITION");
    const auto* given = at == primitive.attributes.end() ? nullptr : accessor(at->second);
    if (given == nullptr) return bad("a primitive has no positions");
    if (const auto packed = primitive.extensions.find("KHR_draco_mesh_compression");
        packed != primitive.extensions.end()) {
      Paint paint = textured_ != nullptr ? paint_of(primitive, 0) : Paint();
      const auto extra_of = [&](const std::string& attribute) {
        DracoExtra extra;
        extra.attribute = no_vertex;
        const auto& ids = packed->second.Get("attributes");
        if (ids.Has(attribute) && ids.Get(attribute).IsInt())
          extra.attribute = static_cast<std::uint32_t>(ids.Get(attribute).GetNumberAsInt());
        const auto named = primitive.attributes.find(attribute);
        if (named != primitive.attributes.end())
          if (const auto* values = accessor(named->second)) extra.normalised = values->normalized;
        return extra;
      };
      std::vector<DracoExtra> extras;
      if (textured_ != nullptr && packed->second.Has("attributes"))
        extras = {extra_of("TEXCOORD_" + std::to_string(paint.material.uv_set)), extra_of("COLOR_0")};
      auto mesh = packed_primitive(packed->second, *given, extras);
      if (!mesh) return mesh.error();
      if (extras.size() == 2) {
        paint.uv = std::move(extras[0].values);
        paint.uv_components = extras[0].components;
        paint.colours = std::move(extras[1].values);
        paint.colour_components = extras[1].components;
      }
      std::vector<std::uint32_t> corners;
      for (const auto& triangle : mesh->triangles)
        for (const auto corner : triangle) corners.push_back(corner < mesh->vertices.size() ? corner : no_vertex);
      return add(mesh->vertices, corners, TINYGLTF_MODE_TRIANGLES, here, paint);
    }
    const auto points = positions_of(*given);
    if (!points) return bad("the positions of a primitive reach beyond their buffer");
    auto corners = corners_of(primitive, points->size());
    if (!corners) return bad("the indices of a primitive reach beyond their buffer");
    return add(*points, *corners, mode, here, textured_ != nullptr ? paint_of(primitive, points->size()) : Paint());
  }

  auto add(const std::vector<Point3>& points, std::vector<std::uint32_t>& corners, int mode, const Transform& here,
           const Paint& colours) -> base::Result<void> {
    const std::size_t first = mesh_.vertices.size();
    if (first + points.size() >= no_vertex) return bad("more than 4 thousand million vertices");
    for (const Point3 p : points) mesh_.vertices.push_back(here(p));
    for (auto& corner : corners)
      if (corner != no_vertex) corner += static_cast<std::uint32_t>(first);
    const std::size_t before = mesh_.triangles.size();
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) add_strip(mesh_, corners);
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN) add_face(mesh_, corners);
    if (mode == TINYGLTF_MODE_TRIANGLES)
      for (std::size_t i = 0; i + 2 < corners.size(); i += 3) add_face(mesh_, std::span(corners).subspan(i, 3));
    if (here.mirrors())
      for (std::size_t t = before; t < mesh_.triangles.size(); ++t)
        std::swap(mesh_.triangles[t][1], mesh_.triangles[t][2]);
    if (textured_ != nullptr) paint(colours, before, first);
    return {};
  }

  const tinygltf::Model& model_;
  const std::string name_;
  TexturedMesh* textured_;
  std::map<std::tuple<int, Wrap, Wrap>, std::uint32_t> material_numbers_;
  RawMesh mesh_;
  std::size_t visits_ = 0;
};

/// CESIUM_RTC: where the origin of the file's coordinates lies, on the z-up axes of the tileset around it.
auto centre_of(const tinygltf::Model& model) -> std::optional<Point3> {
  const auto found = model.extensions.find("CESIUM_RTC");
  if (found == model.extensions.end() || !found->second.Has("center")) return std::nullopt;
  const auto& numbers = found->second.Get("center");
  if (!numbers.IsArray() || numbers.ArrayLen() != 3) return std::nullopt;
  const auto at = [&numbers](std::size_t i) {
    return numbers.Get(static_cast<int>(i)).IsNumber() ? numbers.Get(static_cast<int>(i)).GetNumberAsDouble() : 0.0;
  };
  return Point3{at(0), at(1), at(2)};
}

}  // namespace

auto read_gltf(std::string_view bytes, const std::filesystem::path& path) -> base::Result<GltfMesh> {
  auto file = load_gltf(bytes, path);
  if (!file) return file.error();
  auto mesh = GltfReader(file->model, path.string()).read();
  if (!mesh) return mesh.error();
  return GltfMesh{std::move(*mesh), centre_of(file->model), std::move(file->buffers)};
}

auto read_textured_gltf(std::string_view bytes, const std::filesystem::path& path) -> base::Result<TexturedGltf> {
  auto file = load_gltf(bytes, path, true);
  if (!file) return file.error();
  TexturedGltf out;
  auto mesh = GltfReader(file->model, path.string(), &out.mesh).read();
  if (!mesh) return mesh.error();
  out.mesh.mesh = {std::move(mesh->vertices), std::move(mesh->triangles)};
  out.centre = centre_of(file->model);
  return out;
}

}  // namespace mansard::formats
