#include "mansard/formats/gltf/gltf_material.hpp"

#include <cmath>
#include <filesystem>

#include "mansard/base/text.hpp"
#include "mansard/formats/files/uri.hpp"

namespace mansard::formats {
namespace {

using tinygltf::Value;

template <class List>
auto item(const List& list, int number) -> const typename List::value_type* {
  return number >= 0 && static_cast<std::size_t>(number) < list.size() ? &list[static_cast<std::size_t>(number)]
                                                                       : nullptr;
}

auto member(const Value& value, const std::string& key) -> Value {
  return value.IsObject() && value.Has(key) ? value.Get(key) : Value();
}

auto integer(const Value& value, int otherwise) -> int {
  return value.IsNumber() ? static_cast<int>(value.GetNumberAsDouble()) : otherwise;
}

auto component(const Value& list, std::size_t i, double otherwise) -> double {
  if (!list.IsArray() || i >= list.ArrayLen() || !list.Get(static_cast<int>(i)).IsNumber()) return otherwise;
  return list.Get(static_cast<int>(i)).GetNumberAsDouble();
}

/// KHR_texture_transform: shift · turn · scale.
void take_transform(const Value& extension, GltfMaterial& out) {
  if (!extension.IsObject()) return;
  const auto offset = member(extension, "offset"), scale = member(extension, "scale");
  const auto angle = member(extension, "rotation");
  const double turn = angle.IsNumber() ? angle.GetNumberAsDouble() : 0;
  const double c = std::cos(turn), s = std::sin(turn), sx = component(scale, 0, 1), sy = component(scale, 1, 1);
  out.turn = {{{c * sx, s * sy, component(offset, 0, 0)}, {-s * sx, c * sy, component(offset, 1, 0)}}};
  out.uv_set = integer(member(extension, "texCoord"), out.uv_set);
}

auto wrap_of(int code) -> Wrap {
  if (code == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::clamp;
  return code == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirror : Wrap::repeat;
}

/// The number of the image of a texture: what is supercompressed comes only where there is nothing else.
auto image_of(const tinygltf::Texture& texture) -> int {
  for (const char* extension : {"EXT_texture_webp"})
    if (const auto found = texture.extensions.find(extension); found != texture.extensions.end())
      return integer(member(found->second, "source"), texture.source);
  if (texture.source >= 0) return texture.source;
  for (const char* extension : {"KHR_texture_basisu", "MSFT_texture_dds"})
    if (const auto found = texture.extensions.find(extension); found != texture.extensions.end())
      return integer(member(found->second, "source"), -1);
  return -1;
}

}  // namespace

auto image_source(const tinygltf::Model& model, int number, const std::string& file) -> std::optional<ImageSource> {
  const auto* image = item(model.images, number);
  if (image == nullptr) return std::nullopt;
  ImageSource out;
  out.path = file;
  out.name = file + " image " + std::to_string(number);
  if (const auto* view = item(model.bufferViews, image->bufferView)) {
    const auto* buffer = item(model.buffers, view->buffer);
    const bool inside = buffer != nullptr && view->byteOffset <= buffer->data.size() &&
                        view->byteLength <= buffer->data.size() - view->byteOffset;
    const auto* from = inside ? reinterpret_cast<const char*>(buffer->data.data()) + view->byteOffset : nullptr;
    out.bytes = std::make_shared<const std::string>(inside ? std::string(from, view->byteLength) : std::string());
  } else if (!image->image.empty()) {
    out.bytes = std::make_shared<const std::string>(image->image.begin(), image->image.end());
  } else if (!image->uri.empty()) {
    return ImageSource::beside(file, file, without_percent(image->uri));
  } else {
    out.bytes = std::make_shared<const std::string>();
  }
  return out;
}

auto material_of(const tinygltf::Model& model, int number) -> GltfMaterial {
  GltfMaterial out;
  const auto* material = item(model.materials, number);
  if (material == nullptr) return out;
  const auto& base = material->pbrMetallicRoughness;
  int texture = base.baseColorTexture.index;
  out.uv_set = std::max(base.baseColorTexture.texCoord, 0);
  for (std::size_t c = 0; c < 3 && c < base.baseColorFactor.size(); ++c) out.factor[c] = base.baseColorFactor[c];
  if (const auto found = base.baseColorTexture.extensions.find("KHR_texture_transform");
      found != base.baseColorTexture.extensions.end())
    take_transform(found->second, out);
  // Materials by shaders: what producers of photogrammetry call the diffuse texture.
  if (const auto found = material->extensions.find("KHR_techniques_webgl"); found != material->extensions.end())
    texture = integer(member(member(member(found->second, "values"), "u_diffuse"), "index"), texture);
  if (const auto found = material->extensions.find("KHR_materials_pbrSpecularGlossiness");
      found != material->extensions.end() && texture < 0) {
    const auto diffuse = member(found->second, "diffuseTexture");
    texture = integer(member(diffuse, "index"), -1);
    out.uv_set = std::max(integer(member(diffuse, "texCoord"), 0), 0);
    const auto factor = member(found->second, "diffuseFactor");
    for (std::size_t c = 0; c < 3; ++c) out.factor[c] = component(factor, c, 1);
  }
  const auto* used = item(model.textures, texture);
  if (used == nullptr) return out;
  out.image = image_of(*used);
  if (const auto* sampler = item(model.samplers, used->sampler))
    out.wrap = {wrap_of(sampler->wrapS), wrap_of(sampler->wrapT)};
  return out;
}

}  // namespace mansard::formats
