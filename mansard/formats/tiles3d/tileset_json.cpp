#include "mansard/formats/tiles3d/tileset_json.hpp"

#include <algorithm>
#include <array>

#include "mansard/base/nesting.hpp"

namespace mansard::formats {

using Json = nlohmann::ordered_json;

auto object_in(const Json& from, const char* key) -> const Json& {
  static const Json nothing = Json::object();
  const auto found = from.find(key);
  return found != from.end() && found->is_object() ? *found : nothing;
}

auto text_in(const Json& from, const char* key) -> std::string {
  const auto found = from.find(key);
  return found != from.end() && found->is_string() ? found->get<std::string>() : std::string();
}

auto number_in(const Json& from, const char* key) -> std::optional<double> {
  const auto found = from.find(key);
  return found != from.end() && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

auto TileJson::transform() const -> std::optional<Transform> {
  const auto found = json_.find("transform");
  if (found == json_.end()) return Transform{};
  const bool numbers = found->is_array() && found->size() == 16 &&
                       std::ranges::all_of(*found, [](const Json& n) { return n.is_number(); });
  if (!numbers) return std::nullopt;
  return Transform::by_columns(found->get<std::vector<double>>());
}

auto TileJson::adds() const -> std::optional<bool> {
  const auto refine = text_in(json_, "refine");
  if (refine.empty()) return std::nullopt;
  return refine == "ADD" || refine == "add";  // in capitals since 1.0
}

auto TileJson::contents() const -> std::vector<TileContentName> {
  std::vector<TileContentName> out;
  const auto add = [&out](const Json& content) {
    if (!content.is_object()) return;
    auto uri = text_in(content, "uri");
    if (uri.empty()) uri = text_in(content, "url");
    if (!uri.empty()) out.push_back({uri, volume_of(object_in(content, "boundingVolume"))});
  };
  const auto add_list = [&add](const Json& holder, const char* key) {
    const auto list = holder.find(key);
    if (list != holder.end() && list->is_array()) std::ranges::for_each(*list, add);
  };
  add(object_in(json_, "content"));
  add_list(json_, "contents");
  const Json& several = object_in(object_in(json_, "extensions"), "3DTILES_multiple_contents");
  add_list(several, "content");
  add_list(several, "contents");
  return out;
}

auto TileJson::implicit_tiling() const -> const Json& {
  return json_.contains("implicitTiling") ? object_in(json_, "implicitTiling")
                                          : object_in(object_in(json_, "extensions"), "3DTILES_implicit_tiling");
}

auto TileJson::children() const -> std::vector<TileJson> {
  const auto children = json_.find("children");
  if (children == json_.end() || !children->is_array()) return {};
  std::vector<TileJson> out;
  out.reserve(children->size());
  for (const Json& child : *children) out.emplace_back(child);
  return out;
}

TilesetJson::TilesetJson(std::string_view bytes) {
  if (base::nests_too_deep(bytes)) {
    fault_ = Fault::too_deep;
    return;
  }
  json_ = Json::parse(bytes, nullptr, false);
  if (!json_.is_object() || !json_.contains("root")) fault_ = Fault::not_a_tileset;
}

auto TilesetJson::unknown_extension() const -> std::optional<std::string> {
  static constexpr std::array<std::string_view, 7> known{"3DTILES_content_gltf",
                                                         "3DTILES_multiple_contents",
                                                         "3DTILES_implicit_tiling",
                                                         "3DTILES_metadata",
                                                         "3DTILES_bounding_volume_S2",
                                                         "3DTILES_batch_table_hierarchy",
                                                         "MAXAR_grid"};
  const auto required = json_.find("extensionsRequired");
  if (required == json_.end() || !required->is_array()) return std::nullopt;
  for (const Json& extension : *required)
    if (extension.is_string() && std::ranges::find(known, extension.get<std::string>()) == known.end())
      return extension.get<std::string>();
  return std::nullopt;
}

}  // namespace mansard::formats
