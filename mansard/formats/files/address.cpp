#include "mansard/formats/files/address.hpp"

#include <algorithm>

namespace mansard::formats {
namespace {

namespace fs = std::filesystem;
using Spans = std::vector<std::pair<std::size_t, std::size_t>>;

constexpr std::string_view hidden = "***";

auto names_a_password(std::string_view key) -> bool { return key.ends_with("password"); }  // "sslpassword" too

auto is_space(char c) -> bool { return c == ' ' || (c >= '\t' && c <= '\r'); }

/// "key=value key = 'quoted value' …", a backslash before what counts as it stands:
/// https://www.postgresql.org/docs/15/libpq-connect.html#LIBPQ-CONNSTRING
auto in_keywords(std::string_view words, std::size_t at) -> Spans {
  Spans found;
  const auto skip = [&] {
    while (at < words.size() && is_space(words[at])) ++at;
  };
  while (skip(), at < words.size()) {
    const auto from = at;
    while (at < words.size() && words[at] != '=' && !is_space(words[at])) ++at;
    const auto key = words.substr(from, at - from);
    skip();
    if (at >= words.size() || words[at] != '=') continue;
    ++at;
    skip();
    const auto value = at;
    const bool quoted = at < words.size() && words[at] == '\'';
    if (quoted) ++at;
    while (at < words.size() && (quoted ? words[at] != '\'' : !is_space(words[at]))) at += words[at] == '\\' ? 2 : 1;
    at = std::min(words.size(), at + (quoted ? 1 : 0));
    if (names_a_password(key) && at > value) found.emplace_back(value, at - value);
  }
  return found;
}

/// "//user:password@host/name?key=value&…", from behind the slashes on.
auto in_url(std::string_view words, std::size_t at) -> Spans {
  Spans found;
  const auto query = std::min(words.find('?', at), words.size());
  const auto authority = words.substr(at, std::min(words.find('/', at), query) - at);
  const auto host = authority.rfind('@'), colon = authority.find(':');  // '@' in a password is wrong, but a password
  if (host != authority.npos && colon < host && host > colon + 1) found.emplace_back(at + colon + 1, host - colon - 1);
  for (auto from = query + 1; from < words.size();) {
    const auto end = std::min(words.find('&', from), words.size());
    const auto pair = words.substr(from, end - from);
    const auto equals = pair.find('=');
    if (equals != pair.npos && names_a_password(pair.substr(0, equals)) && equals + 1 < pair.size())
      found.emplace_back(from + equals + 1, pair.size() - equals - 1);
    from = end + 1;
  }
  return found;
}

void replace_all(std::string& text, std::string_view what, std::string_view with) {
  if (what.empty()) return;
  for (std::size_t at = 0; (at = text.find(what, at)) != text.npos; at += with.size())
    text.replace(at, what.size(), with);
}

}  // namespace

auto is_database(const fs::path& path) -> bool {
  const std::string name = path.string();
  return name.starts_with("PG:") || name.starts_with("postgresql://");
}

auto is_elsewhere(const fs::path& path) -> bool {
  const std::string name = path.string();
  return is_database(path) || name.find("/vsicurl/") != name.npos || name.starts_with("/vsis3/") ||
         name.starts_with("/vsigs/") || name.starts_with("/vsiaz/") || name.starts_with("/vsiadls/") ||
         name.starts_with("/vsiswift/") || name.starts_with("/vsioss/");
}

auto passwords_in(std::string_view words) -> Spans {
  constexpr std::string_view prefix = "PG:";
  const std::size_t start = words.starts_with(prefix) ? prefix.size() : 0;
  const auto slashes = words.find("://", start);
  const auto scheme = words.substr(start, slashes == words.npos ? 0 : slashes - start);
  if (scheme == "postgresql" || scheme == "postgres") return in_url(words, slashes + 3);
  return in_keywords(words, start);
}

auto shown_name(const fs::path& path) -> std::string {
  std::string name = path.string();
  if (!is_database(path)) return name;
  const auto spans = passwords_in(name);
  for (auto span = spans.rbegin(); span != spans.rend(); ++span) name.replace(span->first, span->second, hidden);
  return name;
}

auto shown_text(std::string text, const fs::path& path) -> std::string {
  if (!is_database(path)) return text;
  const std::string name = path.string();
  replace_all(text, name, shown_name(path));
  for (const auto& [start, size] : passwords_in(name)) {
    const std::string_view password = std::string_view(name).substr(start, size);
    replace_all(text, password, hidden);
    if (password.size() > 2 && password.front() == '\'') replace_all(text, password.substr(1, size - 2), hidden);
  }
  return text;
}

}  // namespace mansard::formats
