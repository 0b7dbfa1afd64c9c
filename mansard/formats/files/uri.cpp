#include "mansard/formats/files/uri.hpp"

#include "mansard/base/text.hpp"

namespace mansard::formats {

auto without_percent(std::string_view uri) -> std::string {
  const auto digit = [&](std::size_t at) -> int {
    const char c = at < uri.size() ? uri[at] : 'x';
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
  };
  std::string out;
  out.reserve(uri.size());
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool escaped = uri[i] == '%' && digit(i + 1) >= 0 && digit(i + 2) >= 0;
    out += escaped ? static_cast<char>(16 * digit(i + 1) + digit(i + 2)) : uri[i];
    if (escaped) i += 2;
  }
  return out;
}

auto data_uri(std::string_view uri) -> std::optional<DataUri> {
  constexpr std::string_view scheme = "data:";
  if (uri.size() < scheme.size() || base::lower(std::string(uri.substr(0, scheme.size()))) != scheme)
    return std::nullopt;
  const auto comma = uri.find(',');
  if (comma == uri.npos) return std::nullopt;
  const auto head = base::lower(std::string(uri.substr(0, comma)));
  return DataUri{without_percent(uri.substr(comma + 1)), head.ends_with(";base64")};
}

}  // namespace mansard::formats
