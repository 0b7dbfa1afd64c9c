#include "apps/cli/shell_word.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace mansard::cli {

auto quoted(const std::string& word) -> std::string {
  const bool plain = !word.empty() && std::ranges::all_of(word, [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("/._-+=:,@%").find(c) != std::string::npos;
  });
  if (plain) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace mansard::cli
