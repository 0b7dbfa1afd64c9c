#include "mansard/formats/gltf/gltf_file.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "mansard/base/text.hpp"

namespace mansard::formats::detail {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF buffers are little-endian");

using geometry::Point3;

enum Component : std::int64_t { short_number = 5122, unsigned_int = 5125, float_number = 5126 };
enum BufferTarget : std::int64_t { array_buffer = 34962, element_array_buffer = 34963 };

/// Meshes are compressed together until they have so many vertices: the JSON of a view would outweigh a part's.
constexpr std::size_t chunk_size = 16384;
/// Compressed positions are multiples of this or finer, up to 4 km from the origin.
constexpr double step = 1.0 / 1024;
/// Feature ids are floats, the only type of a vertex attribute that holds more than 65536 of them.
constexpr std::uint64_t most_ids = 1 << 24;

/// base_color is linear in glTF, and our colours are sRGB (IEC 61966-2-1, here to three decimals).
constexpr std::array<std::array<double, 4>, class_count> linear_colours{{{0.687, 0.658, 0.604, 1},
                                                                         {0.305, 0.305, 0.342, 1},
                                                                         {0.434, 0.122, 0.080, 1},
                                                                         {0.188, 0.202, 0.188, 1},
                                                                         {0.305, 0.231, 0.162, 1}}};

/// East, up, south: y is up in glTF.
auto y_up(Point3 p) -> Float3 { return {static_cast<float>(p.x), static_cast<float>(p.z), static_cast<float>(-p.y)}; }

template <class T>
auto bytes_of(const std::vector<T>& values) -> std::string_view {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

template <class T>
void append_raw(base::Sink& sink, T value) {
  sink.append({reinterpret_cast<const char*>(&value), sizeof value});
}

void grow(std::optional<std::array<Float3, 2>>& bounds, const Float3& p) {
  if (!bounds) bounds = {p, p};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    (*bounds)[0][axis] = std::min((*bounds)[0][axis], p[axis]);
    (*bounds)[1][axis] = std::max((*bounds)[1][axis], p[axis]);
  }
}

auto whole(std::uint64_t value) -> std::int64_t { return static_cast<std::int64_t>(value); }

/// Degrees to a hundredth.
auto degrees(double radians) -> float {
  return static_cast<float>(std::round(radians * 18000 / std::numbers::pi) / 100);
}

/// Items that were put aside as JSON, each followed by a comma.
void append_items(base::Spool& items, std::string_view item) {
  if (items.size() > 0) items.append(",");
  items.append(item);
}

auto padded(std::uint64_t size) -> std::uint64_t { return (size + 7) / 8 * 8; }

auto pad_to(base::Sink& sink, std::uint64_t size) {
  sink.append(std::string(static_cast<std::size_t>(padded(size) - size), '\0'));
}

}  // namespace

auto gltf_options(const WriteOptions& options) -> GltfOptions {
  const bool webp = options.texture_format == TextureFormat::webp;
  return {options.compress, options.unlit, webp ? ImageCodec::webp : ImageCodec::jpeg,
          static_cast<int>(options.texture_quality)};
}

auto part_texture(const PartMesh& mesh, const TexturedSolids& textured, std::size_t solid) -> PartTexture {
  PartTexture out;
  out.uv.resize(mesh.vertices.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const FaceMesh& face = mesh.faces[f];
    out.pages.push_back(textured.first_page + textured.atlas->page_of(solid, f));
    for (std::uint32_t v = face.first_vertex; v < face.first_vertex + face.vertices; ++v) {
      const auto [across, down] = textured.atlas->uv(solid, f, mesh.vertices[v]);
      out.uv[v] = {static_cast<float>(across), static_cast<float>(down)};
    }
  }
  return out;
}

auto GltfFile::open(const GltfOptions& options) -> base::Result<std::unique_ptr<GltfFile>> {
  Spools spools;
  std::vector<std::unique_ptr<base::Spool>*> all{&spools.packed,    &spools.views,    &spools.nodes,   &spools.meshes,
                                                 &spools.accessors, &spools.rows,     &spools.records, &spools.classes,
                                                 &spools.slopes,    &spools.azimuths, &spools.tables,  &spools.images};
  for (auto& view : spools.of_view) all.push_back(&view);
  for (auto* spool : all) {
    auto opened = base::Spool::open();
    if (!opened) return opened.error();
    *spool = std::move(*opened);
  }
  return std::unique_ptr<GltfFile>(new GltfFile(options, std::move(spools)));
}

auto GltfFile::add_images(const SolidAtlas& atlas) -> base::Result<std::uint32_t> {
  const auto first = static_cast<std::uint32_t>(image_bytes_.size());
  for (std::size_t page = 0; page < atlas.pages(); ++page) {
    const auto bytes = encode_image(atlas.page(page), options_.codec, options_.quality);
    if (!bytes) return bytes.failure();
    image_bytes_.push_back(bytes->size());
    spools_.images->append(*bytes);
    pad_to(*spools_.images, spools_.images->size());
    image_ends_.push_back(spools_.images->size());
  }
  return first;
}

auto GltfFile::material_number(std::uint32_t image, std::uint32_t kind) -> std::int64_t {
  if (!textured_) return kind;
  const auto number = std::ranges::find(materials_, std::pair(image, kind)) - materials_.begin();
  if (number == static_cast<std::ptrdiff_t>(materials_.size())) materials_.emplace_back(image, kind);
  return number;
}

void GltfFile::add_part(const Row& row, std::string_view record, const PartMesh& mesh, std::span<const Point3> places,
                        std::span<const Point3> facing, const PartTexture* texture) {
  std::string bytes;
  append_row(bytes, row);
  append_raw(*spools_.rows, static_cast<std::uint32_t>(bytes.size()));
  spools_.rows->append(bytes);
  spools_.records->append(record);
  record_ends_.push_back(static_cast<std::uint32_t>(spools_.records->size()));

  const auto base = static_cast<std::uint32_t>(mesh_.positions.size());
  if (texture != nullptr && !places.empty()) {
    textured_ = true;
    mesh_.uv.insert(mesh_.uv.end(), texture->uv.begin(), texture->uv.end());
  }
  for (const Point3& place : places) mesh_.positions.push_back(y_up(place));
  if (!places.empty()) ++mesh_.parts;
  mesh_.part_ids.resize(mesh_.positions.size(), static_cast<float>(parts_));
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const FaceMesh& face = mesh.faces[f];
    auto& indices = mesh_.indices[{texture != nullptr ? texture->pages[f] : 0, static_cast<std::uint32_t>(face.kind)}];
    mesh_.normals.insert(mesh_.normals.end(), face.vertices, y_up(geometry::normalised(facing[f])));
    mesh_.surface_ids.insert(mesh_.surface_ids.end(), face.vertices, static_cast<float>(surfaces_));
    for (std::uint32_t i = 0; i < face.indices; ++i) indices.push_back(base + mesh.indices[face.first_index + i]);
    if (face.vertices > 0) ++mesh_.surfaces;
    const auto& n = face.normal;
    const float slope = degrees(std::atan2(std::hypot(n.x, n.y), std::abs(n.z)));
    const double azimuth = std::atan2(n.x, n.y);
    const float looks = degrees(azimuth < 0 ? azimuth + 2 * std::numbers::pi : azimuth);
    append_raw(*spools_.classes, static_cast<std::uint8_t>(face.kind));
    append_raw(*spools_.slopes, slope);
    append_raw(*spools_.azimuths, slope < 0.5F ? -1.0F : looks >= 360.0F ? 0.0F : looks);
    ++surfaces_;
  }
  ++parts_;
}

/// Positions at multiples of the step by the filter that decoders undo, and what these will see then.
void GltfFile::quantise() {
  float far = 0;
  for (const Float3& p : mesh_.positions)
    for (const float c : p) far = std::max(far, std::abs(c));
  // The filter keeps `bits` bits of the largest coordinate of a vertex, its sign among them.
  const int bits = far > 0 ? std::clamp(std::ilogb(far / step) + 2, 2, 23) : 2;
  std::vector<std::uint32_t> filtered(mesh_.positions.size() * 3);
  meshopt_encodeFilterExp(filtered.data(), mesh_.positions.size(), sizeof(Float3), bits,
                          mesh_.positions.front().data());
  chunk_[position_view] += bytes_of(filtered);
  meshopt_decodeFilterExp(filtered.data(), mesh_.positions.size(), sizeof(Float3));
  std::memcpy(mesh_.positions.data(), filtered.data(), filtered.size() * sizeof(float));
  for (const Float3& n : mesh_.normals)
    for (std::size_t i = 0; i < 4; ++i) {
      const auto value = static_cast<std::int16_t>(i < 3 ? std::lround(n[i] * 32767.0F) : 0);
      chunk_[normal_view].append(reinterpret_cast<const char*>(&value), sizeof value);
    }
}

void GltfFile::append_view(View view, std::string_view bytes) {
  if (compress_) chunk_[view] += bytes;
  else spools_.of_view[view]->append(bytes);
}

void GltfFile::append_accessor(View view, std::size_t offset, std::size_t count, const std::array<Float3, 2>* bounds) {
  JsonText json;
  const std::size_t index = (compress_ ? packed_chunks_ * views() : 0) + view;
  json.begin_object().key("bufferView").whole(whole(index)).key("byteOffset").whole(whole(offset));
  const bool packed_normal = compress_ && view == normal_view;
  json.key("componentType").whole(packed_normal ? short_number : view == index_view ? unsigned_int : float_number);
  if (packed_normal) json.key("normalized").flag(true);
  json.key("count")
      .whole(whole(count))
      .key("type")
      .text(view == position_view || view == normal_view ? "VEC3"
            : view == uv_view                            ? "VEC2"
                                                         : "SCALAR");
  if (bounds != nullptr)
    for (std::size_t side = 0; side < 2; ++side) {
      json.key(side == 0 ? "min" : "max").begin_array();
      for (const float v : (*bounds)[side])
        json.number(static_cast<double>(v));  // exact: readers compare with the buffer
      json.end_array();
    }
  append_items(*spools_.accessors, json.end_object().str());
  ++accessors_;
}

void GltfFile::append_primitives(JsonText& json, std::size_t vertex, std::size_t index,
                                 const std::array<Float3, 2>& bounds) {
  const std::size_t count = mesh_.positions.size();
  const std::int64_t first = accessors_;
  append_accessor(position_view, vertex * sizeof(Float3), count, &bounds);
  append_accessor(normal_view, vertex * (compress_ ? 8 : sizeof(Float3)), count, nullptr);
  append_accessor(part_view, vertex * sizeof(float), count, nullptr);
  append_accessor(surface_view, vertex * sizeof(float), count, nullptr);
  if (textured_) append_accessor(uv_view, vertex * sizeof(Float2), count, nullptr);
  json.begin_array();
  for (const auto& [kind, indices] : mesh_.indices) {
    if (indices.empty()) continue;
    json.begin_object().key("attributes").begin_object().key("POSITION").whole(first).key("NORMAL").whole(first + 1);
    json.key("_FEATURE_ID_0").whole(first + 2).key("_FEATURE_ID_1").whole(first + 3);
    if (textured_) json.key("TEXCOORD_0").whole(first + 4);
    json.end_object().key("indices").whole(accessors_);
    json.key("material").whole(material_number(kind.first, kind.second)).key("extensions").begin_object();
    json.key("EXT_mesh_features").begin_object().key("featureIds").begin_array();
    json.begin_object().key("featureCount").whole(mesh_.parts).key("attribute").whole(0);
    json.key("label").text("part").key("propertyTable").whole(0).end_object();
    json.begin_object().key("featureCount").whole(mesh_.surfaces).key("attribute").whole(1);
    json.key("label").text("surface").key("propertyTable").whole(1).end_object();
    json.end_array().end_object().end_object().end_object();
    append_accessor(index_view, index * sizeof(std::uint32_t), indices.size(), nullptr);
    index += indices.size();
  }
  json.end_array();
}

void GltfFile::end_mesh(const std::string& name, std::string_view extras) {
  std::size_t corners = 0;
  for (const auto& [kind, indices] : mesh_.indices) corners += indices.size();
  if (corners > 0) {
    const std::size_t vertex = compress_ ? chunk_vertices_ : vertices_, index = compress_ ? chunk_indices_ : indices_;
    if (compress_) {
      quantise();
    } else {
      append_view(position_view, bytes_of(mesh_.positions));
      append_view(normal_view, bytes_of(mesh_.normals));
    }
    append_view(part_view, bytes_of(mesh_.part_ids));
    append_view(surface_view, bytes_of(mesh_.surface_ids));
    for (const auto& [kind, indices] : mesh_.indices) append_view(index_view, bytes_of(indices));
    if (textured_) {
      mesh_.uv.resize(mesh_.positions.size());
      append_view(uv_view, bytes_of(mesh_.uv));
    }
    std::optional<std::array<Float3, 2>> bounds;
    for (const Float3& p : mesh_.positions) grow(bounds, p);
    for (const Float3& corner : *bounds) grow(bounds_, corner);

    JsonText node, mesh;
    node.begin_object().key("name").text(name).key("mesh").whole(nodes_);
    if (!extras.empty()) node.key("extras").raw(extras);
    append_items(*spools_.nodes, node.end_object().str());
    append_primitives(mesh.begin_object().key("name").text(name).key("primitives"), vertex, index, *bounds);
    append_items(*spools_.meshes, mesh.end_object().str());
    ++nodes_;
    vertices_ += mesh_.positions.size();
    indices_ += corners;
    chunk_vertices_ += mesh_.positions.size();
    chunk_indices_ += corners;
    if (compress_ && chunk_vertices_ >= chunk_size) pack();
  }
  mesh_ = {};
}

void GltfFile::pack() {
  if (chunk_vertices_ == 0) return;
  // The versions that EXT_meshopt_compression is written against.
  meshopt_encodeVertexVersion(0);
  meshopt_encodeIndexVersion(1);
  constexpr std::array<std::size_t, view_count> strides{
      sizeof(Float3), 8, sizeof(float), sizeof(float), sizeof(std::uint32_t), sizeof(Float2)};
  for (std::size_t view = 0; view < views(); ++view) {
    const std::size_t stride = strides[view], count = chunk_[view].size() / stride;
    std::vector<unsigned char> packed;
    if (view == index_view) {
      const auto* corners = reinterpret_cast<const unsigned int*>(chunk_[view].data());
      packed.resize(meshopt_encodeIndexBufferBound(count, chunk_vertices_));
      packed.resize(meshopt_encodeIndexBuffer(packed.data(), packed.size(), corners, count));
    } else {
      packed.resize(meshopt_encodeVertexBufferBound(count, stride));
      packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), chunk_[view].data(), count, stride));
    }
    JsonText json;
    json.begin_object().key("buffer").whole(1).key("byteOffset").whole(whole(unpacked_bytes_));
    json.key("byteLength").whole(whole(chunk_[view].size()));
    if (view != index_view) json.key("byteStride").whole(whole(stride));
    json.key("target").whole(view == index_view ? element_array_buffer : array_buffer).key("extensions").begin_object();
    json.key("EXT_meshopt_compression").begin_object().key("buffer").whole(0);
    json.key("byteOffset").whole(whole(spools_.packed->size())).key("byteLength").whole(whole(packed.size()));
    json.key("byteStride").whole(whole(stride)).key("count").whole(whole(count));
    json.key("mode").text(view == index_view ? "TRIANGLES" : "ATTRIBUTES");
    if (view == position_view) json.key("filter").text("EXPONENTIAL");
    append_items(*spools_.views, json.end_object().end_object().end_object().str());
    unpacked_bytes_ += padded(chunk_[view].size());
    spools_.packed->append(bytes_of(packed));
    pad_to(*spools_.packed, spools_.packed->size());
    chunk_[view].clear();
  }
  chunk_vertices_ = chunk_indices_ = 0;
  ++packed_chunks_;
}

auto GltfFile::fill_tables(TableBytes& parts, TableBytes& plans, TableBytes& surfaces, const PartColumns& columns)
    -> base::Result<void> {
  for (std::uint32_t number = 0; number < columns.columns().size(); ++number)
    if (auto added = parts.add(columns.columns()[number], number, *spools_.rows, parts_); !added) return added;
  if (auto added = plans.add_texts(PartColumns::record, *spools_.records, record_ends_); !added) return added;
  if (surfaces_ == 0) return {};
  for (auto& [name, spool] :
       {std::pair{"class", &spools_.classes}, {"slope", &spools_.slopes}, {"azimuth", &spools_.azimuths}})
    if (auto added = surfaces.add_values(name, **spool); !added) return added;
  return {};
}

void GltfFile::append_textured_material(JsonText& json, std::uint32_t image, std::uint32_t kind) const {
  json.begin_object().key("name").text(class_name(static_cast<model::FaceClass>(kind)));
  json.key("pbrMetallicRoughness").begin_object().key("baseColorTexture").begin_object();
  json.key("index").whole(image).end_object();
  json.key("metallicFactor").number(0).key("roughnessFactor").number(0.9).end_object();
  if (options_.unlit)
    json.key("extensions").begin_object().key("KHR_materials_unlit").begin_object().end_object().end_object();
  json.end_object();
}

void GltfFile::append_images(JsonText& json, std::size_t first_view) const {
  if (image_bytes_.empty()) return;
  enum Sampler : std::int64_t { linear = 9729, linear_mipmap_linear = 9987, clamp_to_edge = 33071 };
  json.key("samplers").begin_array().begin_object().key("magFilter").whole(linear);
  json.key("minFilter").whole(linear_mipmap_linear).key("wrapS").whole(clamp_to_edge);
  json.key("wrapT").whole(clamp_to_edge).end_object().end_array().key("textures").begin_array();
  for (std::size_t i = 0; i < image_bytes_.size(); ++i) {
    json.begin_object().key("sampler").whole(0);
    if (options_.codec == ImageCodec::webp) {
      json.key("extensions").begin_object().key("EXT_texture_webp").begin_object().key("source").whole(whole(i));
      json.end_object().end_object().end_object();
    } else {
      json.key("source").whole(whole(i)).end_object();
    }
  }
  json.end_array().key("images").begin_array();
  for (std::size_t i = 0; i < image_bytes_.size(); ++i)
    json.begin_object()
        .key("bufferView")
        .whole(whole(first_view + i))
        .key("mimeType")
        .text(mime_type_of(options_.codec))
        .end_object();
  json.end_array();
}

void GltfFile::append_materials(JsonText& json) const {
  json.key("materials").begin_array();
  if (textured_) {
    for (const auto& [image, kind] : materials_) append_textured_material(json, image, kind);
    json.end_array();
    return;
  }
  for (std::size_t c = 0; c < class_count; ++c) {
    json.begin_object().key("name").text(class_name(static_cast<model::FaceClass>(c)));
    json.key("pbrMetallicRoughness").begin_object().key("baseColorFactor").begin_array();
    for (const double channel : linear_colours[c]) json.number(channel);
    json.end_array().key("metallicFactor").number(0).key("roughnessFactor").number(0.9).end_object().end_object();
  }
  json.end_array();
}

void GltfFile::append_extensions(JsonText& json, const TableBytes& parts, const TableBytes& plans,
                                 const TableBytes& surfaces, const PartColumns& columns) const {
  if (parts_ > 0) {
    json.key("extensions").begin_object().key("EXT_structural_metadata").begin_object();
    columns.append_schema(json.key("schema").begin_object().key("id").text("mansard").key("version").text("1"));
    json.end_object().key("propertyTables").begin_array();
    const std::size_t chunks = compress_ ? packed_chunks_ : nodes_ > 0 ? 1 : 0;
    std::size_t base = chunks * views();  // tables come after the meshes
    const auto table = [&](std::string_view name, std::uint64_t count, const TableBytes& bytes) {
      json.begin_object().key("name").text(name).key("class").text(name).key("count").whole(whole(count));
      json.key("properties").begin_object();
      for (const TableColumn& column : bytes.columns()) {
        json.key(column.identifier).begin_object().key("values").whole(whole(base + column.values));
        if (column.has_offsets) json.key("stringOffsets").whole(whole(base + column.offsets));
        json.end_object();
      }
      json.end_object().end_object();
      base += bytes.views().size();
    };
    table("part", parts_, parts);
    if (surfaces_ > 0) table("surface", surfaces_, surfaces);
    if (!plans.columns().empty()) table(PartColumns::record_class, parts_, plans);  // after those of feature ids
    json.end_array().end_object().end_object();
  }
  std::vector<std::string_view> used;
  if (nodes_ > 0) used.emplace_back("EXT_mesh_features");
  if (parts_ > 0) used.emplace_back("EXT_structural_metadata");
  const bool packed = compress_ && nodes_ > 0;
  std::vector<std::string_view> required;
  if (packed) required = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
  if (textured_ && options_.codec == ImageCodec::webp) required.emplace_back("EXT_texture_webp");
  used.insert(used.end(), required.begin(), required.end());
  if (textured_ && options_.unlit) used.emplace_back("KHR_materials_unlit");
  if (used.empty()) return;
  json.key("extensionsUsed").begin_array();
  for (const auto name : used) json.text(name);
  json.end_array();
  if (required.empty()) return;
  json.key("extensionsRequired").begin_array();
  for (const auto name : required) json.text(name);
  json.end_array();
}

auto GltfFile::mesh_bytes() const -> std::uint64_t {
  std::uint64_t bytes = spools_.packed->size();
  if (!compress_)
    for (const auto& view : spools_.of_view) bytes += padded(view->size());
  return bytes;
}

/// Of meshes that are not compressed.
void GltfFile::append_views(JsonText& json) const {
  if (compress_ || nodes_ == 0) return;
  std::uint64_t offset = spools_.packed->size();
  for (std::size_t view = 0; view < views(); ++view) {
    const auto size = spools_.of_view[view]->size();
    json.begin_object().key("buffer").whole(0).key("byteOffset").whole(whole(offset));
    json.key("byteLength").whole(whole(size));
    const std::size_t stride = view < part_view ? sizeof(Float3) : view == uv_view ? sizeof(Float2) : sizeof(float);
    if (view != index_view) json.key("byteStride").whole(whole(stride));
    json.key("target").whole(view == index_view ? element_array_buffer : array_buffer).end_object();
    offset += padded(size);
  }
}

/// The binary chunk, and one that exists only to be decompressed into.
void GltfFile::append_buffers(JsonText& json, std::uint64_t binary) const {
  json.key("buffers").begin_array().begin_object().key("byteLength").whole(whole(binary)).end_object();
  if (compress_ && nodes_ > 0) {
    json.begin_object().key("byteLength").whole(whole(unpacked_bytes_)).key("extensions").begin_object();
    json.key("EXT_meshopt_compression").begin_object().key("fallback").flag(true).end_object();
    json.end_object().end_object();
  }
  json.end_array();
}

auto GltfFile::write(base::Sink& sink, const std::string& generator, std::string_view extras,
                     const PartColumns& columns) -> base::Result<void> {
  if (compress_) pack();
  const auto too_large = [] {
    return base::error("write-glb-size", "the model is larger than the 4 GB a GLB can hold; write it as 3D Tiles");
  };
  if (surfaces_ > most_ids || parts_ > most_ids || spools_.records->size() > std::numeric_limits<std::uint32_t>::max())
    return too_large();
  TableBytes parts(*spools_.tables), plans(*spools_.tables), surfaces(*spools_.tables);
  if (auto filled = fill_tables(parts, plans, surfaces, columns); !filled) return filled;

  const std::uint64_t meshes = mesh_bytes(), tables = padded(meshes + spools_.tables->size());
  const std::uint64_t binary = tables + spools_.images->size();
  // The JSON in pieces: the long lists that were put aside come between what is made here.
  JsonText json;
  std::vector<std::pair<std::string, base::Spool*>> pieces;
  const auto insert = [&](base::Spool& items) {
    pieces.emplace_back(json.take(), &items);
    json.aside(items.size() > 0);
  };
  json.begin_object().key("asset").begin_object().key("version").text("2.0").key("generator").text(generator);
  if (!extras.empty()) json.key("extras").raw(extras);
  json.end_object().key("scene").whole(0).key("scenes").begin_array().begin_object();
  if (nodes_ > 0) {
    json.key("nodes").begin_array();
    for (std::int64_t i = 0; i < nodes_; ++i) json.whole(i);
    json.end_array();
  }
  json.end_object().end_array();
  append_extensions(json, parts, plans, surfaces, columns);
  if (nodes_ > 0) {
    append_materials(json);
    for (const auto& [name, items] :
         {std::pair{"nodes", &spools_.nodes}, {"meshes", &spools_.meshes}, {"accessors", &spools_.accessors}}) {
      json.key(name).begin_array();
      insert(**items);
      json.end_array();
    }
  }
  if (textured_) {
    const std::size_t chunks = compress_ ? packed_chunks_ : 1;
    append_images(json, chunks * views() + parts.views().size() + surfaces.views().size() + plans.views().size());
  }
  if (binary > 0) {
    json.key("bufferViews").begin_array();
    append_views(json);
    insert(*spools_.views);
    for (const TableBytes* table : {&parts, &surfaces, &plans})
      for (const TableView& view : table->views()) {
        json.begin_object().key("buffer").whole(0).key("byteOffset").whole(whole(meshes + view.offset));
        json.key("byteLength").whole(whole(view.bytes)).end_object();
      }
    for (std::size_t i = 0; i < image_bytes_.size(); ++i) {
      json.begin_object().key("buffer").whole(0).key("byteOffset").whole(whole(tables + image_ends_[i]));
      json.key("byteLength").whole(whole(image_bytes_[i])).end_object();
    }
    append_buffers(json.end_array(), binary);
  }
  pieces.emplace_back(json.end_object().take(), nullptr);

  std::uint64_t json_size = 0;
  for (const auto& [text, spool] : pieces) json_size += text.size() + (spool != nullptr ? spool->size() : 0);
  // Tables are read in place: they start at a multiple of 8 of the file too, so the JSON ends 4 bytes after one.
  const std::uint64_t padding = (8 + 4 - json_size % 8) % 8;
  json_size += padding;
  const std::uint64_t size = 12 + 8 + json_size + (binary == 0 ? 0 : 8 + binary);
  if (size > std::numeric_limits<std::uint32_t>::max()) return too_large();

  sink.append("glTF");
  append_raw(sink, std::uint32_t{2});
  append_raw(sink, static_cast<std::uint32_t>(size));
  append_raw(sink, static_cast<std::uint32_t>(json_size));
  sink.append("JSON");
  for (const auto& [text, spool] : pieces) {
    sink.append(text);
    if (spool != nullptr)
      if (auto copied = spool->copy_to(sink); !copied) return copied;
  }
  sink.append(std::string(static_cast<std::size_t>(padding), ' '));
  if (binary == 0) return {};
  append_raw(sink, static_cast<std::uint32_t>(binary));
  sink.append({"BIN\0", 4});
  if (auto copied = spools_.packed->copy_to(sink); !copied) return copied;
  if (!compress_)
    for (const auto& view : spools_.of_view) {
      if (auto copied = view->copy_to(sink); !copied) return copied;
      pad_to(sink, view->size());
    }
  if (auto copied = spools_.tables->copy_to(sink); !copied) return copied;
  pad_to(sink, spools_.tables->size());
  return spools_.images->copy_to(sink);
}

}  // namespace mansard::formats::detail
