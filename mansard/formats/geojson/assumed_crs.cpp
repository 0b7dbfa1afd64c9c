#include "mansard/formats/geojson/assumed_crs.hpp"

#include <cstddef>

namespace mansard::formats {
namespace {

auto skip_blanks(std::string_view text, std::size_t at) -> std::size_t {
  const std::size_t next = text.find_first_not_of(" \t\r\n", at);
  return next == text.npos ? text.size() : next;
}

/// The text of the value that begins there, to its end.
auto value_at(std::string_view json, std::size_t from) -> std::string_view {
  int depth = 0;
  for (std::size_t i = from; i < json.size(); ++i) {
    const char c = json[i];
    if (c == '"')
      while (++i < json.size() && json[i] != '"') i += json[i] == '\\' ? 1 : 0;
    if (c == '{' || c == '[') ++depth;
    if ((c == '}' || c == ']') && --depth < 0) return json.substr(from, i - from);
    if (depth == 0 && (c == '}' || c == ']')) return json.substr(from, i + 1 - from);
    if (depth == 0 && c == ',') return json.substr(from, i - from);
  }
  return json.substr(from);
}

}  // namespace

auto top_level_member(std::string_view json, std::string_view name) -> std::optional<std::string_view> {
  int depth = 0;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (c == '{' || c == '[') ++depth;
    if (c == '}' || c == ']') --depth;
    if (c != '"') continue;
    const std::size_t start = ++i;
    while (i < json.size() && json[i] != '"') i += json[i] == '\\' ? 2 : 1;
    if (i >= json.size()) return std::nullopt;
    if (depth != 1 || json.substr(start, i - start) != name) continue;
    const std::size_t colon = skip_blanks(json, i + 1);
    if (colon < json.size() && json[colon] == ':') {
      const auto value = value_at(json, skip_blanks(json, colon + 1));
      return value.starts_with("null") ? std::nullopt : std::optional(value);
    }
  }
  return std::nullopt;
}

}  // namespace mansard::formats
