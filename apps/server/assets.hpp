// The page of the workbench, as built into the program.
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
/// Null for an unknown name. "" is index.html.
[[nodiscard]] auto find_asset(std::string_view name) -> const Asset*;

/// openapi.json, as built into the program.
[[nodiscard]] auto openapi() -> std::string_view;

}  // namespace mansard::server
