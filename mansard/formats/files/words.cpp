#include "mansard/formats/files/words.hpp"

#include <charconv>
#include <limits>

namespace mansard::formats {
namespace {

auto is_blank(char c) -> bool { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f'; }

}  // namespace

auto without_mark(std::string_view text) -> std::string_view {
  constexpr std::string_view mark = "\xef\xbb\xbf";
  return text.starts_with(mark) ? text.substr(mark.size()) : text;
}

auto take_line(std::string_view& text) -> std::string_view {
  const std::size_t end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == text.npos ? text.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

auto take_word(std::string_view& text) -> std::string_view {
  std::size_t start = 0;
  while (start < text.size() && is_blank(text[start])) ++start;
  std::size_t end = start;
  while (end < text.size() && !is_blank(text[end])) ++end;
  const std::string_view word = text.substr(start, end - start);
  text.remove_prefix(end);
  return word;
}

auto to_coordinate(std::string_view word) -> std::optional<double> {
  if (word.starts_with('+')) word.remove_prefix(1);
  if (word.empty()) return std::nullopt;
  double value = 0;
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (code == std::errc::result_out_of_range) {
    const std::size_t exponent = word.find_first_of("eE");
    const bool tiny =
        exponent != word.npos ? word.substr(exponent + 1).starts_with('-') : word.find("0.0") != word.npos;
    return tiny ? 0 : std::numeric_limits<double>::infinity();
  }
  if (code != std::errc{}) return std::nullopt;
  if (end != word.data() + word.size())
    return *end == '#' ? std::optional(std::numeric_limits<double>::quiet_NaN()) : std::nullopt;
  return value;
}

auto to_corner(std::string_view word) -> std::optional<std::int64_t> {
  std::int64_t value = 0;
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end == word.data() || (end != word.data() + word.size() && *end != '/')) return std::nullopt;
  if (code == std::errc::result_out_of_range) return std::numeric_limits<std::int64_t>::max();
  return value;
}

}  // namespace mansard::formats
