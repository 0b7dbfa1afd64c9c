#include "apps/server/assets.hpp"

#include <algorithm>

namespace mansard::server {

auto find_asset(std::string_view name) -> const Asset* {
  const auto all = assets();
  const auto at = std::ranges::find(all, name.empty() ? "index.html" : name, &Asset::name);
  return at == all.end() ? nullptr : &*at;
}

}  // namespace mansard::server
