#include "apps/cli/layout.hpp"

#include <algorithm>

namespace mansard::cli {
namespace {

auto continues(char c) -> bool { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

/// Bytes of the first so many columns.
auto bytes_of(std::string_view text, std::size_t columns) -> std::size_t {
  std::size_t at = 0;
  for (; at < text.size(); ++at)
    if (!continues(text[at]) && columns-- == 0) break;
  return at;
}

}  // namespace

auto columns_of(std::string_view text) -> std::size_t {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return !continues(c); }));
}

auto padded(std::string text, std::size_t columns) -> std::string {
  const auto own = columns_of(text);
  if (own < columns) text.append(columns - own, ' ');
  return text;
}

auto wrapped(std::string_view text, std::size_t columns) -> std::vector<std::string> {
  std::vector<std::string> lines;
  while (columns_of(text) > columns) {
    std::size_t end = bytes_of(text, columns);
    if (text[end] != ' ')
      if (const auto blank = text.rfind(' ', end); blank != std::string_view::npos && blank > 0) end = blank;
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(end);
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  }
  if (!text.empty() || lines.empty()) lines.emplace_back(text);
  return lines;
}

auto term_and_text(const std::string& term, std::string_view text, std::size_t margin, std::size_t width)
    -> std::string {
  std::string out = padded(term, margin);
  if (columns_of(term) + 2 > margin) out = term + "\n" + std::string(margin, ' ');
  bool first = true;
  for (const auto& line : wrapped(text, width - margin)) {
    out += (first ? "" : std::string(margin, ' ')) + line + "\n";
    first = false;
  }
  return out;
}

auto listed(const std::vector<std::string>& words, std::string_view last) -> std::string {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " " + std::string(last) + " " : std::string(", ")) + words[i];
  return text;
}

}  // namespace mansard::cli
