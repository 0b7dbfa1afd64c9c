#include <tiny_gltf.h>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>

#include "mansard/ingest/detail/mesh_formats.hpp"

namespace mansard::ingest::detail {
namespace {

using geometry::Point3;

/// An affine map: three rows of a 3 × 4 matrix.
struct Transform {
  std::array<std::array<double, 4>, 3> row{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

  [[nodiscard]] auto operator()(Point3 p) const -> Point3 {
    const auto along = [&p](const std::array<double, 4>& r) { return r[0] * p.x + r[1] * p.y + r[2] * p.z + r[3]; };
    return {along(row[0]), along(row[1]), along(row[2])};
  }
  /// First `inner`, then this.
  [[nodiscard]] auto after(const Transform& inner) const -> Transform {
    Transform out;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 4; ++j) {
        out.row[i][j] = j == 3 ? row[i][3] : 0;
        for (std::size_t k = 0; k < 3; ++k) out.row[i][j] += row[i][k] * inner.row[k][j];
      }
    return out;
  }
  [[nodiscard]] auto mirrors() const -> bool {
    const auto column = [this](std::size_t j) { return Point3{row[0][j], row[1][j], row[2][j]}; };
    return dot(cross(column(0), column(1)), column(2)) < 0;
  }
};

auto transform_of(const tinygltf::Node& node) -> Transform {
  Transform t;
  if (node.matrix.size() == 16) {
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 4; ++j) t.row[i][j] = node.matrix[4 * j + i];  // stored by columns
    return t;
  }
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
  GltfReader(const tinygltf::Model& model, const std::string& name) : model_(model), name_(name) {}

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
      // All zero but for what the sparse part says; which cannot be more than the buffers hold.
      if (!given.sparse.isSparse || given.count > 1'000'000'000) return std::nullopt;
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
      const auto at = static_cast<std::size_t>(where->value(i, 0));
      if (at >= points.size()) return std::nullopt;
      points[at] = {what->value(i, 0), what->value(i, 1), what->value(i, 2)};
    }
    return points;
  }

  auto take_primitive(const tinygltf::Primitive& primitive, const Transform& here) -> base::Result<void> {
    const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    if (mode != TINYGLTF_MODE_TRIANGLES && mode != TINYGLTF_MODE_TRIANGLE_STRIP && mode != TINYGLTF_MODE_TRIANGLE_FAN)
      return {};  // points and lines have no surface
    const auto at = primitive.attributes.find("POSITION");
    const auto* given = at == primitive.attributes.end() ? nullptr : accessor(at->second);
    if (given == nullptr) return bad("a primitive has no positions");
    const auto points = positions_of(*given);
    if (!points) return bad("the positions of a primitive reach beyond their buffer");

    const std::size_t first = mesh_.vertices.size();
    if (first + points->size() >= no_vertex) return bad("more than 4 thousand million vertices");
    for (const Point3 p : *points) mesh_.vertices.push_back(here(p));
    std::vector<std::uint32_t> corners;
    const auto name_corner = [&](double i) {
      corners.push_back(i < static_cast<double>(points->size())
                            ? static_cast<std::uint32_t>(first + static_cast<std::size_t>(i))
                            : no_vertex);
    };
    if (primitive.indices >= 0) {
      const auto* list = accessor(primitive.indices);
      const auto view = list == nullptr ? std::nullopt
                                        : view_of(list->bufferView, list->byteOffset, list->count, list->componentType,
                                                  TINYGLTF_TYPE_SCALAR);
      if (!view) return bad("the indices of a primitive reach beyond their buffer");
      for (std::size_t i = 0; i < view->count; ++i) name_corner(view->value(i, 0));
    } else {
      for (std::size_t i = 0; i < points->size(); ++i) name_corner(static_cast<double>(i));
    }

    const std::size_t before = mesh_.triangles.size();
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) add_strip(mesh_, corners);
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN) add_face(mesh_, corners);
    if (mode == TINYGLTF_MODE_TRIANGLES)
      for (std::size_t i = 0; i + 2 < corners.size(); i += 3) add_face(mesh_, std::span(corners).subspan(i, 3));
    if (here.mirrors())
      for (std::size_t t = before; t < mesh_.triangles.size(); ++t)
        std::swap(mesh_.triangles[t][1], mesh_.triangles[t][2]);
    return {};
  }

  const tinygltf::Model& model_;
  const std::string& name_;
  RawMesh mesh_;
  std::size_t visits_ = 0;
};

/// A required extension this reader cannot do without knowing it; those about looks change no geometry.
auto unknown_extension(const tinygltf::Model& model) -> std::optional<std::string> {
  for (const std::string& name : model.extensionsRequired)
    if (!name.starts_with("KHR_materials_") && !name.starts_with("KHR_texture_") && !name.starts_with("EXT_texture_") &&
        !name.starts_with("MSFT_texture_") && name != "KHR_mesh_quantization" && name != "KHR_lights_punctual")
      return name;
  return std::nullopt;
}

auto skip_image(tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*, int, void*)
    -> bool {
  return true;
}

}  // namespace

auto read_gltf(std::string_view bytes, const std::filesystem::path& path) -> base::Result<RawMesh> {
  const std::string name = path.string();
  const bool binary = bytes.starts_with("glTF");
  if (binary) {
    // The header's third word is the length of the whole file, little endian.
    std::uint32_t length = 0;
    for (std::size_t i = 0; i < 4 && bytes.size() >= 12; ++i)
      length |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[8 + i])) << (8 * i);
    if (bytes.size() < 20 || length > bytes.size())
      return base::error("ingest-mesh-truncated",
                         "the file has " + std::to_string(bytes.size()) + " bytes of the " + std::to_string(length) +
                             " it promises; copy or export it again",
                         name);
  }
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(&skip_image, nullptr);
  tinygltf::Model model;
  std::string errors, warnings;
  const std::string folder = path.parent_path().string();
  const auto size = static_cast<unsigned int>(bytes.size());
  if (bytes.size() > std::numeric_limits<unsigned int>::max())
    return base::error("ingest-mesh-format", "glTF files end at 4 GB; cut the mesh into tiles", name);
  const bool loaded =
      binary ? loader.LoadBinaryFromMemory(&model, &errors, &warnings,
                                           reinterpret_cast<const unsigned char*>(bytes.data()), size, folder)
             : loader.LoadASCIIFromString(&model, &errors, &warnings, bytes.data(), size, folder);
  if (const auto extension = unknown_extension(model)) {
    const bool packed = extension->find("draco") != extension->npos || extension->find("meshopt") != extension->npos;
    return base::error("ingest-mesh-format",
                       packed
                           ? "the mesh is compressed (" + *extension + "), which is not read; write it uncompressed"
                           : "the file requires the extension " + *extension + ", which is not read; write it without",
                       name);
  }
  if (!loaded) {
    for (char& c : errors) c = c == '\n' ? ' ' : c;
    return base::error("ingest-mesh-format", "not a readable glTF file (" + errors + "); export the mesh again", name);
  }
  return GltfReader(model, name).read();
}

}  // namespace mansard::ingest::detail
