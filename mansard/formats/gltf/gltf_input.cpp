#include "mansard/formats/gltf/gltf_input.hpp"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <algorithm>
#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "mansard/base/nesting.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/files/named_file.hpp"
#include "mansard/formats/files/reach.hpp"
#include "mansard/formats/files/uri.hpp"
#include "mansard/formats/gltf/glb_container.hpp"
#include "mansard/formats/gltf/meshopt.hpp"
#include "mansard/formats/hash.hpp"

namespace mansard::formats {
namespace {

using Json = nlohmann::json;

constexpr const char* meshopt = "EXT_meshopt_compression";
constexpr const char* draco = "KHR_draco_mesh_compression";
/// Names that no file has, for buffers that are in no file: the binary part of a GLB, and room to unpack into.
constexpr std::string_view binary_part = "mansard:binary-part", room = "mansard:room";

/// What tinygltf asks for while it reads a file.
struct Surroundings {
  std::string_view binary;
  std::filesystem::path given;  ///< the file itself
  std::vector<model::InputFile> read;
  std::optional<base::Diagnostic> failure;
};

/// Images change no geometry, so they are not there for us.
auto is_image(const std::string& name) -> bool {
  static constexpr std::array<std::string_view, 8> endings{".png", ".jpg",  ".jpeg", ".webp",
                                                           ".ktx", ".ktx2", ".dds",  ".basis"};
  const auto dot = name.rfind('.');
  if (dot == name.npos) return false;
  return std::ranges::find(endings, base::lower(name.substr(dot))) != endings.end();
}

auto exists(const std::string& name, void*) -> bool { return !is_image(name); }

auto same_name(const std::string& name, void*) -> std::string { return name; }

auto read_buffer(std::vector<unsigned char>* out, std::string* errors, const std::string& name, void* data) -> bool {
  auto& around = *static_cast<Surroundings*>(data);
  if (name.ends_with(binary_part)) {
    out->assign(around.binary.begin(), around.binary.end());
    return true;
  }
  if (name.ends_with(room)) {
    out->assign(1, 0);  // give_room has the rest
    return true;
  }
  const auto reach = check_reach(around.given, name);
  const auto bytes = reach ? bytes_of_named(name) : base::Result<Bytes>(reach.error());
  if (!bytes) {
    around.failure = bytes.error();
    *errors = bytes.error().message;
    return false;
  }
  const auto view = bytes->view();
  out->assign(view.begin(), view.end());
  around.read.push_back({name, view.size(), sha256(view)});
  return true;
}

auto write_nothing(std::string*, const std::string&, const std::vector<unsigned char>&, void*) -> bool { return false; }

auto skip_image(tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*, int, void*)
    -> bool {
  return true;
}

/// Keeps the bytes of an image that is written into the JSON; others are in a buffer or a file.
auto keep_image(tinygltf::Image* image, const int, std::string*, std::string*, int, int, const unsigned char* bytes,
                int size, void*) -> bool {
  if (image->bufferView < 0 && image->uri.empty() && size > 0) image->image.assign(bytes, bytes + size);
  return true;
}

/// The two chunks of a GLB.
struct Parts {
  std::string_view json, binary;
};

auto parts_of(std::string_view bytes, const std::string& name) -> base::Result<Parts> {
  const Glb glb = read_glb(bytes);
  if (bytes.size() < 20 || glb.size > bytes.size())
    return base::error("ingest-mesh-truncated",
                       "the file has " + std::to_string(bytes.size()) + " bytes of the " + std::to_string(glb.size) +
                           " it promises; copy or export it again",
                       name);
  if (glb.version == 1)
    return base::error("ingest-mesh-format", "it is glTF 1.0, which is not read; convert it to glTF 2.0", name);
  if (!glb.json_complete) return base::error("ingest-mesh-truncated", "its JSON ends too early; copy it again", name);
  return Parts{bytes.substr(glb.json.offset, glb.json.size), bytes.substr(glb.binary.offset, glb.binary.size)};
}

/// A buffer that exists only to be unpacked into, and how large it says it is.
struct Room {
  std::size_t buffer = 0;
  std::uint64_t size = 0;
};

/// The JSON part in a form that tinygltf reads.
struct Rewritten {
  std::string json;
  std::vector<Room> rooms;
};

/// Buffers that exist only to be unpacked into have no bytes in any file, which tinygltf does not know. They get a name
/// and a byte each, and so does the binary part get a name, since what comes out is JSON.
void name_buffers(Json& json, std::size_t binary, std::vector<Room>& rooms) {
  for (std::size_t i = 0; i < json["buffers"].size(); ++i) {
    auto& buffer = json["buffers"][i];
    if (!buffer.is_object() || buffer.contains("uri")) continue;
    const auto size = buffer.value("byteLength", std::uint64_t{0});
    if (i == 0 && binary > 0 && size <= binary) {
      buffer["uri"] = binary_part;
      buffer["byteLength"] = binary;
    } else {
      buffer["uri"] = room;
      buffer["byteLength"] = 1;
      rooms.push_back({i, size});
    }
  }
}

/// tinygltf wants indices to lie in a buffer view, where Draco has them in its own: that one does, as nobody reads
/// them.
void place_indices(Json& json) {
  for (auto& mesh : json["meshes"])
    for (auto& primitive : mesh["primitives"]) {
      const auto packed = primitive.value("/extensions/KHR_draco_mesh_compression/bufferView"_json_pointer, Json());
      const auto indices = primitive.value("indices", Json());
      if (!packed.is_number_unsigned() || !indices.is_number_unsigned()) continue;
      const auto at = indices.get<std::size_t>();
      if (at < json["accessors"].size() && !json["accessors"][at].contains("bufferView"))
        json["accessors"][at]["bufferView"] = packed;
    }
}

/// Of the media types that a data URI can say tinygltf knows these, with base64, and takes all others for the name of a
/// file.
auto is_known(std::string_view uri) -> bool {
  static constexpr std::array<std::string_view, 7> known{"application/octet-stream",
                                                         "application/gltf-buffer",
                                                         "image/jpeg",
                                                         "image/png",
                                                         "image/bmp",
                                                         "image/gif",
                                                         "text/plain"};
  uri.remove_prefix(std::string_view("data:").size());
  return std::ranges::any_of(known, [&](std::string_view type) {
    return uri.starts_with(type) && uri.substr(type.size()).starts_with(";base64,");
  });
}

auto has_unknown_data(std::string_view json) -> bool {
  constexpr std::string_view start = "\"data:";
  for (auto at = json.find(start); at != json.npos; at = json.find(start, at + start.size()))
    if (!is_known(json.substr(at + 1))) return true;
  return false;
}

auto base64_of(const std::string& bytes) -> std::string {
  char* text = CPLBase64Encode(static_cast<int>(bytes.size()), reinterpret_cast<const GByte*>(bytes.data()));
  std::string out = text;
  CPLFree(text);
  return out;
}

/// The bytes in a data URI are the same whatever they are said to be.
void name_types_of_data(Json& json) {
  for (const char* list : {"buffers", "images"})
    for (auto& item : json[list]) {
      if (!item.is_object() || !item.contains("uri") || !item["uri"].is_string()) continue;
      auto& uri = item["uri"].get_ref<std::string&>();
      auto found = data_uri(uri);
      if (!found || is_known(uri) || found->data.size() > std::numeric_limits<int>::max()) continue;
      if (!found->base64) found->data = base64_of(found->data);
      uri = "data:application/octet-stream;base64," + found->data;
    }
}

auto rewritten(const Parts& parts, const std::string& name) -> base::Result<Rewritten> {
  const auto bad = [&name] {
    return base::error("ingest-mesh-format", "its JSON is damaged; export the mesh again", name);
  };
  Json json(parse_gltf(parts.json));  // whose members stay where they are when others are added
  if (!json.is_object()) return bad();
  try {  // members of another kind than the standard says
    std::vector<Room> rooms;
    name_buffers(json, parts.binary.size(), rooms);
    place_indices(json);
    name_types_of_data(json);
    for (const char* list : {"buffers", "images", "meshes", "accessors"})
      if (json[list].is_null()) json.erase(list);  // looking for one makes one
    return Rewritten{json.dump(), std::move(rooms)};
  } catch (const Json::exception&) {
    return bad();
  }
}

auto whole(const tinygltf::Value& object, const char* key, std::size_t otherwise) -> std::size_t {
  if (!object.Has(key) || !object.Get(key).IsNumber()) return otherwise;
  const double number = object.Get(key).GetNumberAsDouble();
  return number >= 0 && number < 1e15 ? static_cast<std::size_t>(number) : std::numeric_limits<std::size_t>::max();
}

auto word(const tinygltf::Value& object, const char* key) -> std::string {
  return object.Has(key) && object.Get(key).IsString() ? object.Get(key).Get<std::string>() : std::string();
}

/// A stretch of one of the buffers; empty where it reaches beyond it.
auto stretch(tinygltf::Model& model, std::size_t buffer, std::size_t offset, std::size_t size)
    -> std::span<unsigned char> {
  if (buffer >= model.buffers.size()) return {};
  auto& bytes = model.buffers[buffer].data;
  if (offset > bytes.size() || size > bytes.size() - offset) return {};
  return std::span(bytes).subspan(offset, size);
}

/// Before it is taken from memory: a file can promise what it does not hold. The codecs make 64 bytes of one at most (a
/// group of 16 equal ones has two bits).
auto give_room(tinygltf::Model& model, const std::vector<Room>& rooms, const std::string& name) -> base::Result<void> {
  constexpr std::uint64_t most = 64;
  std::uint64_t left = 0;
  for (const auto& buffer : model.buffers) left += most * buffer.data.size();
  for (const Room& wanted : rooms) {
    if (wanted.buffer >= model.buffers.size() || wanted.size > left)
      return base::error("ingest-mesh-format",
                         "its buffer " + std::to_string(wanted.buffer) + " is to hold " + std::to_string(wanted.size) +
                             " bytes, more than can be unpacked from the file; export the mesh again",
                         name);
    left -= wanted.size;
    model.buffers[wanted.buffer].data.assign(static_cast<std::size_t>(wanted.size), 0);
  }
  return {};
}

auto unpack_view(tinygltf::Model& model, const tinygltf::BufferView& view, const tinygltf::Value& packed) -> bool {
  if (!packed.IsObject() || view.buffer < 0) return false;
  const auto from = stretch(model, whole(packed, "buffer", model.buffers.size()), whole(packed, "byteOffset", 0),
                            whole(packed, "byteLength", 0));
  const auto to = stretch(model, static_cast<std::size_t>(view.buffer), view.byteOffset, view.byteLength);
  const MeshoptLayout layout{word(packed, "mode"), word(packed, "filter"), whole(packed, "count", 0),
                             whole(packed, "byteStride", 0)};
  if (from.empty() || to.empty()) return false;
  // The source may be the buffer that is unpacked into, so it is kept.
  const std::vector<unsigned char> kept(from.begin(), from.end());
  return unpack_meshopt(kept, layout, to);
}

auto unpack_views(tinygltf::Model& model, const std::string& name) -> base::Result<void> {
  for (std::size_t i = 0; i < model.bufferViews.size(); ++i) {
    const auto packed = model.bufferViews[i].extensions.find(meshopt);
    if (packed != model.bufferViews[i].extensions.end() && !unpack_view(model, model.bufferViews[i], packed->second))
      return base::error("ingest-mesh-format",
                         "its buffer view " + std::to_string(i) + ", packed with meshopt, is damaged; export it again",
                         name);
  }
  return {};
}

/// A required extension this reader cannot do without knowing it; those about looks change no geometry.
auto unknown_extension(const tinygltf::Model& model) -> std::optional<std::string> {
  static constexpr std::array<std::string_view, 10> known{"KHR_mesh_quantization",
                                                          "KHR_techniques_webgl",  // materials by shaders
                                                          draco,
                                                          meshopt,
                                                          "CESIUM_RTC",
                                                          "KHR_lights_punctual",
                                                          "EXT_mesh_features",
                                                          "EXT_structural_metadata",
                                                          "EXT_instance_features",
                                                          "CESIUM_primitive_outline"};
  for (const std::string& name : model.extensionsRequired)
    if (!name.starts_with("KHR_materials_") && !name.starts_with("KHR_texture_") && !name.starts_with("EXT_texture_") &&
        !name.starts_with("MSFT_texture_") && std::ranges::find(known, name) == known.end())
      return name;
  return std::nullopt;
}

}  // namespace

auto load_gltf(std::string_view bytes, const std::filesystem::path& path, bool images) -> base::Result<GltfInput> {
  const std::string name = path.string();
  bool binary = bytes.starts_with("glTF");
  Parts parts{bytes, {}};
  if (binary) {
    auto cut = parts_of(bytes, name);
    if (!cut) return cut.error();
    parts = *cut;
  }
  if (base::nests_too_deep(parts.json))  // tinygltf calls itself for each level
    return base::error(
        "ingest-mesh-format",
        "its JSON nests more than " + std::to_string(base::deepest_json) + " levels deep; export the mesh again", name);
  Rewritten kept;
  const bool compressed = parts.json.find(meshopt) != parts.json.npos || parts.json.find(draco) != parts.json.npos;
  if (compressed || has_unknown_data(parts.json)) {
    auto text = rewritten(parts, name);
    if (!text) return text.error();
    kept = std::move(*text);
    bytes = kept.json;
    binary = false;
  }
  if (bytes.size() > std::numeric_limits<unsigned int>::max())
    return base::error("ingest-mesh-format", "glTF files end at 4 GB; cut the mesh into tiles", name);

  Surroundings around{parts.binary, path, {}, {}};
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(images ? &keep_image : &skip_image, nullptr);
  loader.SetFsCallbacks({&exists, &same_name, &read_buffer, &write_nothing, &around});
  GltfInput file;
  std::string errors, warnings;
  const std::string folder = path.parent_path().string();
  const auto size = static_cast<unsigned int>(bytes.size());
  const bool loaded =
      binary ? loader.LoadBinaryFromMemory(&file.model, &errors, &warnings,
                                           reinterpret_cast<const unsigned char*>(bytes.data()), size, folder)
             : loader.LoadASCIIFromString(&file.model, &errors, &warnings, bytes.data(), size, folder);
  if (const auto extension = unknown_extension(file.model))
    return base::error("ingest-mesh-format",
                       "the file requires the extension " + *extension + ", which is not read; write it without", name);
  if (around.failure) return *around.failure;
  if (!loaded) {
    for (char& c : errors) c = c == '\n' ? ' ' : c;
    return base::error("ingest-mesh-format", "not a readable glTF file (" + errors + "); export the mesh again", name);
  }
  if (auto given = give_room(file.model, kept.rooms, name); !given) return given.error();
  if (auto unpacked = unpack_views(file.model, name); !unpacked) return unpacked.error();
  file.buffers = std::move(around.read);
  return file;
}

}  // namespace mansard::formats
