#include "mansard/formats/json_cursor.hpp"

#include <array>
#include <charconv>
#include <cstring>
#include <optional>
#include <system_error>

#include "mansard/base/utf8.hpp"

namespace mansard::formats {
namespace {

auto is_digit(char c) -> bool { return c >= '0' && c <= '9'; }

/// Powers of ten that are doubles: a number of up to 15 digits, times or divided by one of them, is rounded once, and
/// is therefore the double that is nearest to the text.
constexpr std::array<double, 23> powers{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                        1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
constexpr std::int64_t most_exact = std::int64_t{1} << 53U;

/// Four hexadecimal digits at the start of a text.
auto code_unit(std::string_view text) -> std::optional<unsigned> {
  unsigned unit = 0;
  if (text.size() < 4) return std::nullopt;
  const auto read = std::from_chars(text.data(), text.data() + 4, unit, 16);
  if (read.ec != std::errc() || read.ptr != text.data() + 4) return std::nullopt;
  return unit;
}

void append_utf8(std::string& out, unsigned code) {
  const auto rest = [&](unsigned shift) { out += static_cast<char>(0x80U | ((code >> shift) & 0x3fU)); };
  if (code < 0x80) {
    out += static_cast<char>(code);
  } else if (code < 0x800) {
    out += static_cast<char>(0xc0U | (code >> 6U));
    rest(0);
  } else if (code < 0x10000) {
    out += static_cast<char>(0xe0U | (code >> 12U));
    rest(6), rest(0);
  } else {
    out += static_cast<char>(0xf0U | (code >> 18U));
    rest(12), rest(6), rest(0);
  }
}

/// What is between the quotation marks of a string, without its escapes; false where one is wrong.
auto unescaped(std::string_view text, std::string& out) -> bool {
  constexpr std::string_view letters = "\"\\/bfnrt", meanings = "\"\\/\b\f\n\r\t";
  constexpr unsigned high = 0xd800, low = 0xdc00, past = 0xe000;  // surrogates
  out.clear();
  while (!text.empty()) {
    const auto plain = text.substr(0, text.find('\\'));
    out += plain;
    text.remove_prefix(plain.size());
    if (text.empty()) return true;
    if (text.size() < 2) return false;
    const char letter = text[1];
    text.remove_prefix(2);
    if (letter != 'u') {
      const auto at = letters.find(letter);
      if (at == std::string_view::npos) return false;
      out += meanings[at];
      continue;
    }
    auto unit = code_unit(text);
    if (!unit || (*unit >= low && *unit < past)) return false;
    text.remove_prefix(4);
    if (*unit >= high && *unit < low) {
      const auto second = text.starts_with("\\u") ? code_unit(text.substr(2)) : std::nullopt;
      if (!second || *second < low || *second >= past) return false;
      text.remove_prefix(6);
      unit = 0x10000 + ((*unit - high) << 10U) + (*second - low);
    }
    append_utf8(out, *unit);
  }
  return true;
}

}  // namespace

auto JsonCursor::done() -> bool {
  next();
  return good_ && at_ == end_;
}

auto JsonCursor::string(std::string& escaped) -> std::string_view {
  if (!take('"')) return {};
  const char* from = at_;
  bool plain = true;
  while (at_ != end_ && *at_ != '"') {
    const auto c = static_cast<unsigned char>(*at_);
    if (c >= 0x20 && c < 0x80 && c != '\\') {
      ++at_;
    } else if (c == '\\') {
      plain = false;
      at_ += end_ - at_ >= 2 ? 2 : 1;
    } else {
      const auto length = c < 0x20 ? 0 : base::utf8_length({at_, static_cast<std::size_t>(end_ - at_)});
      if (length == 0) return good_ = false, std::string_view();
      at_ += length;
    }
  }
  if (at_ == end_) return good_ = false, std::string_view();
  const std::string_view inside(from, static_cast<std::size_t>(at_ - from));
  ++at_;
  if (plain) return inside;
  if (!unescaped(inside, escaped)) return good_ = false, std::string_view();
  return escaped;
}

auto JsonCursor::key(std::string& escaped) -> std::string_view {
  const auto name = string(escaped);
  return take(':') ? name : std::string_view();
}

auto JsonCursor::text() -> std::string {
  std::string escaped;
  return std::string(string(escaped));
}

auto JsonCursor::word(std::string_view name) -> bool {
  if (static_cast<std::size_t>(end_ - at_) < name.size() || std::memcmp(at_, name.data(), name.size()) != 0)
    return good_ = false;
  at_ += name.size();
  return good_;
}

auto JsonCursor::any_number() -> Number {
  next();
  const char* from = at_;
  const auto here = [&] { return at_ == end_ ? '\0' : *at_; };
  const auto failed = [&] { return good_ = false, Number(0.0); };
  const bool negative = here() == '-';
  if (negative) ++at_;
  std::int64_t digits = 0;
  int count = 0, scale = 0;  // digits without leading zeros, and powers of ten
  const auto take_digits = [&](int step) {
    const char* first = at_;
    for (; is_digit(here()); ++at_, scale += step) {
      if (count > 0 || *at_ != '0') ++count;
      if (count <= 18) digits = 10 * digits + (*at_ - '0');
    }
    return at_ - first;
  };
  const char* whole = at_;
  const auto before = take_digits(0);
  if (!good_ || before == 0 || (before > 1 && *whole == '0')) return failed();
  if (const char c = here(); c != '.' && c != 'e' && c != 'E') {
    if (count > 18) return failed();
    return negative ? -digits : digits;
  }
  if (here() == '.') {
    ++at_;
    if (take_digits(-1) == 0) return failed();
  }
  bool exponent = false;
  if (here() == 'e' || here() == 'E') {
    exponent = true;
    ++at_;
    if (here() == '+' || here() == '-') ++at_;
    const char* first = at_;
    while (is_digit(here())) ++at_;
    if (at_ == first) return failed();
  }
  if (!exponent && count <= 18 && digits <= most_exact && -scale < static_cast<int>(powers.size())) {
    const double value = static_cast<double>(digits) / powers[static_cast<std::size_t>(-scale)];
    return negative ? -value : value;
  }
  double value = 0;
  const auto read = std::from_chars(from, at_, value);
  if (read.ec != std::errc() || read.ptr != at_) return failed();
  return value;
}

auto JsonCursor::number() -> double {
  const auto read = any_number();
  const auto* whole = std::get_if<std::int64_t>(&read);
  return whole != nullptr ? static_cast<double>(*whole) : std::get<double>(read);
}

auto JsonCursor::value() -> model::Value {
  switch (good_ ? next() : '\0') {
    case '"': return text();
    case 't': return word("true") ? model::Value(true) : model::Value();
    case 'f': return word("false") ? model::Value(false) : model::Value();
    case 'n': return word("null"), model::Value();
    case '{':
    case '[': return good_ = false, model::Value();
    default: {
      const auto read = any_number();
      if (const auto* whole = std::get_if<std::int64_t>(&read)) return *whole;
      return std::get<double>(read);
    }
  }
}

auto JsonCursor::skip() -> std::string_view {
  if (!good_) return {};
  const char first = next();
  const char* from = at_;
  std::string escaped;
  switch (first) {
    case '{': object([&](std::string_view) { skip(); }); break;
    case '[': array([&] { skip(); }); break;
    case '"': (void)string(escaped); break;
    case 't': word("true"); break;
    case 'f': word("false"); break;
    case 'n': word("null"); break;
    default: (void)any_number();
  }
  return good_ ? std::string_view(from, static_cast<std::size_t>(at_ - from)) : std::string_view();
}

void JsonCursor::leave_out() {
  if (!good_) return;
  const char first = next();
  if (first != '{' && first != '[') return void(skip());
  int depth = 0;
  while (at_ != end_) {
    const char c = *at_++;
    if (c == '"') {
      for (; at_ != end_ && *at_ != '"'; ++at_)
        if (*at_ == '\\' && end_ - at_ > 1) ++at_;
      if (at_ == end_) break;
      ++at_;
    } else if (c == '{' || c == '[') {
      ++depth;
    } else if ((c == '}' || c == ']') && --depth == 0) {
      return;
    }
  }
  fail();
}

}  // namespace mansard::formats
