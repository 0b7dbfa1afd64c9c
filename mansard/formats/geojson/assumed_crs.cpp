#include "mansard/formats/geojson/assumed_crs.hpp"

#include <cstddef>

namespace mansard::formats {
namespace {

auto skip_blanks(std::string_view text, std::size_t at) -> std::size_t {
  const std::size_t next = text.find_first_not_of(" \t\r\n", at);
  return next == text.npos ? text.size() : next;
}

}  // namespace

auto has_top_level_member(std::string_view json, std::string_view name) -> bool {
  int depth = 0;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (c == '{' || c == '[') ++depth;
    if (c == '}' || c == ']') --depth;
    if (c != '"') continue;
    const std::size_t start = ++i;
    while (i < json.size() && json[i] != '"') i += json[i] == '\\' ? 2 : 1;
    if (i >= json.size()) return false;
    if (depth != 1 || json.substr(start, i - start) != name) continue;
    const std::size_t colon = skip_blanks(json, i + 1);
    if (colon < json.size() && json[colon] == ':')
      return !json.substr(skip_blanks(json, colon + 1)).starts_with("null");
  }
  return false;
}

}  // namespace mansard::formats
