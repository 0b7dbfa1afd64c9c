#include "mansard/formats/osm/osm.hpp"

#include <algorithm>
#include <optional>
#include <string>

namespace mansard::formats {
namespace {

/// Takes a text in quotes off the front.
auto take_quoted(std::string_view& text) -> std::optional<std::string> {
  if (!text.starts_with('"')) return std::nullopt;
  std::string out;
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (text[i] == '"') {
      text.remove_prefix(i + 1);
      return out;
    }
    if (text[i] == '\\' && i + 1 < text.size()) ++i;
    out += text[i];
  }
  return std::nullopt;
}

/// "key"=>"value" with commas between, PostgreSQL's hstore.
auto pairs_of(std::string_view text) -> std::optional<model::Attributes> {
  model::Attributes out;
  while (!text.empty()) {
    auto key = take_quoted(text);
    if (!key || !text.starts_with("=>")) return std::nullopt;
    text.remove_prefix(2);
    auto value = take_quoted(text);
    if (!value) return std::nullopt;
    out.emplace_back(*std::move(key), *std::move(value));
    while (text.starts_with(',') || text.starts_with(' ')) text.remove_prefix(1);
  }
  return out;
}

auto text_of(const model::Attributes& attributes, std::string_view name) -> std::string {
  for (const auto& [key, value] : attributes)
    if (const auto* text = key == name ? std::get_if<std::string>(&value) : nullptr; text != nullptr) return *text;
  return {};
}

}  // namespace

void split_tags(model::Attributes& attributes) {
  const auto at = std::ranges::find(attributes, "other_tags", &model::Attributes::value_type::first);
  if (at == attributes.end()) return;
  const auto* text = std::get_if<std::string>(&at->second);
  auto tags = text != nullptr ? pairs_of(*text) : model::Attributes();
  if (!tags) return;
  const auto place = attributes.erase(at);
  attributes.insert(place, std::make_move_iterator(tags->begin()), std::make_move_iterator(tags->end()));
}

auto osm_name(const model::Attributes& attributes) -> std::string {
  // OGR: areas made of relations have osm_id, those made of closed ways osm_way_id.
  if (const auto way = text_of(attributes, "osm_way_id"); !way.empty()) return "way/" + way;
  const auto relation = text_of(attributes, "osm_id");
  return relation.empty() ? relation : "relation/" + relation;
}

}  // namespace mansard::formats
