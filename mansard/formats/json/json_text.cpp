#include "mansard/formats/json/json_text.hpp"

#include <cmath>

#include "mansard/base/text.hpp"
#include "mansard/base/utf8.hpp"

namespace mansard::formats::detail {
namespace {

void append_quoted(std::string& out, std::string_view value) {
  constexpr std::string_view hex = "0123456789abcdef";
  out += '"';
  for (std::size_t i = 0; i < value.size();) {
    const char c = value[i];
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (const auto code = static_cast<unsigned char>(c); code < 0x20 || code == 0x7F) {
      out += "\\u00";
      out += hex[code >> 4U];
      out += hex[code & 15U];
    } else if (const std::size_t length = base::utf8_length(value.substr(i)); length == 0) {
      out += "\xEF\xBF\xBD";
    } else {
      out += value.substr(i, length);
      i += length;
      continue;
    }
    ++i;
  }
  out += '"';
}

}  // namespace

auto quoted(std::string_view value) -> std::string {
  std::string out;
  append_quoted(out, value);
  return out;
}

void JsonText::separate() {
  if (!first_ && !after_key_) text_ += ',';
  if (level_ >= 0) {
    text_ += '\n';
    text_.append(2 * static_cast<std::size_t>(level_), ' ');
    level_ = -1;
  }
  first_ = false;
  after_key_ = false;
}

auto JsonText::open(char bracket) -> JsonText& {
  separate();
  text_ += bracket;
  first_ = true;
  return *this;
}

auto JsonText::close(char bracket) -> JsonText& {
  if (level_ >= 0) {
    text_ += '\n';
    text_.append(2 * static_cast<std::size_t>(level_), ' ');
    level_ = -1;
  }
  text_ += bracket;
  first_ = false;
  return *this;
}

auto JsonText::key(std::string_view name) -> JsonText& {
  separate();
  append_quoted(text_, name);
  text_ += ':';
  after_key_ = true;
  return *this;
}

auto JsonText::text(std::string_view value) -> JsonText& {
  separate();
  append_quoted(text_, value);
  return *this;
}

auto JsonText::number(double value) -> JsonText& { return std::isfinite(value) ? raw(base::to_text(value)) : null(); }

auto JsonText::real(double value) -> JsonText& {
  if (!std::isfinite(value)) return null();
  std::string digits = base::to_text(value);
  if (digits.find_first_of(".e") == std::string::npos) digits += ".0";
  return raw(digits);
}

auto JsonText::whole(std::int64_t value) -> JsonText& { return raw(std::to_string(value)); }

auto JsonText::raw(std::string_view json) -> JsonText& {
  separate();
  text_ += json;
  return *this;
}

auto JsonText::line(int level) -> JsonText& {
  level_ = level;
  return *this;
}

}  // namespace mansard::formats::detail
