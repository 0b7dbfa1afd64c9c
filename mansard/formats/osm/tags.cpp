#include "mansard/formats/osm/tags.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "mansard/base/text.hpp"
#include "mansard/formats/osm/osm.hpp"

namespace mansard::formats {
namespace {

auto plain(std::string_view name) -> std::string {
  std::string out = base::lower(std::string(name));
  for (char& c : out)
    if (c == ':' || c == '-' || c == '.' || c == ' ') c = '_';
  return out;
}

auto text_of(const model::Value& value) -> std::string {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
  if (const auto* number = std::get_if<double>(&value)) return base::to_text(*number);
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "yes" : "no";
  return {};
}

auto in_text(const std::string& text, std::string_view tag) -> std::string {
  model::Attributes apart{{"other_tags", text}};
  split_tags(apart);
  for (const auto& [key, value] : apart)
    if (key == tag) return text_of(value);
  if (!text.starts_with('{')) return {};
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) return {};
  const auto found = json.find(tag);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace

auto tag_of(const model::Attributes& attributes, std::string_view tag) -> std::string {
  constexpr std::size_t in_shapefile = 10;
  const std::string wanted = plain(tag), cut = wanted.substr(0, in_shapefile);
  // Ten letters of "building" are "building" still, but those of "building:part" could be of other tags, too.
  const bool is_cut = wanted.size() > in_shapefile;
  for (const auto& [name, value] : attributes)
    if (const auto own = plain(name); own == wanted || (is_cut && own == cut))
      if (auto text = text_of(value); !text.empty()) return text;
  for (const auto& [name, value] : attributes) {
    const auto own = plain(name);
    if (own != "other_tags" && own != "all_tags" && own != "tags") continue;
    if (const auto* text = std::get_if<std::string>(&value))
      if (auto found = in_text(*text, tag); !found.empty()) return found;
  }
  return {};
}

auto role_of(const model::Attributes& attributes) -> BuildingRole {
  const auto is_there = [&](std::string_view tag) {
    const auto value = base::lower(tag_of(attributes, tag));
    return !value.empty() && value != "no" && value != "false" && value != "0";
  };
  return {is_there("building"), is_there("building:part")};
}

auto relations_of(const model::Attributes& attributes) -> std::vector<BuildingRelation> {
  std::vector<BuildingRelation> out;
  for (const auto& [name, value] : attributes) {
    const auto* text = name == relations_attribute ? std::get_if<std::string>(&value) : nullptr;
    if (text == nullptr) continue;
    const auto list = nlohmann::json::parse(*text, nullptr, false);
    if (!list.is_array()) continue;
    const auto word = [](const nlohmann::json& of, const char* key) -> std::string {
      const auto found = of.is_object() ? of.find(key) : of.end();
      if (!of.is_object() || found == of.end()) return {};
      if (found->is_string()) return found->get<std::string>();
      return found->is_number_integer() ? std::to_string(found->get<std::int64_t>()) : std::string();
    };
    for (const auto& one : list) {
      if (!one.is_object() || !one.contains("reltags") || word(one["reltags"], "type") != "building") continue;
      if (const auto id = word(one, "rel"); !id.empty()) out.push_back({"relation/" + id, word(one, "role")});
    }
  }
  return out;
}

auto relations_text(const std::vector<BuildingRelation>& relations) -> std::string {
  auto list = nlohmann::json::array();
  constexpr std::string_view kind = "relation/";
  for (const auto& [id, role] : relations)
    list.push_back({{"role", role},
                    {"rel", std::string(std::string_view(id).substr(id.starts_with(kind) ? kind.size() : 0))},
                    {"reltags", {{"type", "building"}}}});
  return list.dump();
}

}  // namespace mansard::formats
