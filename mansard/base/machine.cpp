#include "mansard/base/machine.hpp"

#include <unistd.h>
#include <array>
#include <ctime>

namespace mansard::base {

auto host() -> const std::string& {
  static const std::string name = [] {
    std::array<char, 256> words{};
    (void)::gethostname(words.data(), words.size() - 1);
    std::string out(words.data());
    for (char& c : out) c = c == '/' ? '-' : c;
    return out;
  }();
  return name;
}

auto utc_now() -> std::string {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  std::array<char, 32> text{};
  ::gmtime_r(&now, &parts);
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

}  // namespace mansard::base
