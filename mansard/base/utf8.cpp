#include "mansard/base/utf8.hpp"

namespace mansard::base {

auto utf8_length(std::string_view s) -> std::size_t {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(s[i]); };
  const auto continues = [&](std::size_t i, unsigned least = 0x80, unsigned most = 0xBF) {
    return i < s.size() && byte(i) >= least && byte(i) <= most;
  };
  const unsigned b = byte(0);
  if (b < 0x80) return 1;
  if (b >= 0xC2 && b <= 0xDF) return continues(1) ? 2 : 0;
  if (b >= 0xE0 && b <= 0xEF)
    return continues(1, b == 0xE0 ? 0xA0 : 0x80, b == 0xED ? 0x9F : 0xBF) && continues(2) ? 3 : 0;
  if (b >= 0xF0 && b <= 0xF4)
    return continues(1, b == 0xF0 ? 0x90 : 0x80, b == 0xF4 ? 0x8F : 0xBF) && continues(2) && continues(3) ? 4 : 0;
  return 0;
}

auto as_utf8(std::string_view text) -> std::string {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto length = utf8_length(text.substr(i));
    out += length == 0 ? std::string_view("\xEF\xBF\xBD") : text.substr(i, length);
    i += length == 0 ? 1 : length;
  }
  return out;
}

auto markup_escaped(std::string_view text) -> std::string {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) switch (const char c = text[i]) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default:
        if (const auto code = static_cast<unsigned char>(c); code < 0x80) {
          out += code < ' ' && c != '\t' && c != '\n' && c != '\r' ? ' ' : c;
        } else if (const auto length = utf8_length(text.substr(i)); length > 0) {
          out += text.substr(i, length);
          i += length - 1;
        } else {
          out += "\xEF\xBF\xBD";
        }
    }
  return out;
}

}  // namespace mansard::base
