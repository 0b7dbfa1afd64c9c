#include "mansard/base/text.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace mansard::base {
namespace {

template <class T>
auto parse(std::string_view text) -> std::optional<T> {
  if (text.starts_with('+')) text.remove_prefix(1);
  T value{};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

auto to_text(double value) -> std::string {
  std::array<char, 32> buffer{};
  const auto [end, code] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), end};
}

auto to_text(double value, int decimals) -> std::string {
  std::array<char, 400> buffer{};
  const auto [end, code] =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, decimals);
  std::string text(buffer.data(), end);
  if (text.starts_with('-') && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

auto to_number(std::string_view text) -> std::optional<double> {
  const auto value = parse<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

auto to_integer(std::string_view text) -> std::optional<std::int64_t> { return parse<std::int64_t>(text); }

auto lower(std::string_view text) -> std::string {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

auto on_one_line(std::string text) -> std::string {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  return text;
}

}  // namespace mansard::base
