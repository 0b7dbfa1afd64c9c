// The page, as it was built into the program.
#pragma once

#include <span>
#include <string_view>

namespace mansard::server {

struct Asset {
  std::string_view name;  ///< "index.html", "assets/index-Bw3kX.js"
  std::string_view bytes;
  std::string_view mime;
  std::string_view hash;  ///< of the bytes
};

/// By name.
[[nodiscard]] auto assets() -> std::span<const Asset>;
/// Null where there is none. "" is index.html.
[[nodiscard]] auto find_asset(std::string_view name) -> const Asset*;

/// openapi.json, as it was built in.
[[nodiscard]] auto openapi() -> std::string_view;

}  // namespace mansard::server
