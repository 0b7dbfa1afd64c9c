// Serves a project to a browser on this machine: the page of the workbench, and its API (openapi.json).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"

namespace mansard::server {

/// A picture of the ground that pages can show: a raster, or tiles; neither: none.
struct Basemap {
  std::filesystem::path file;
  std::string tiles;        ///< the pattern of their names, as formats::ground_tiles_pattern gives it
  std::string attribution;  ///< to be shown with it
};

struct Options {
  std::filesystem::path project = "mansard-project";  ///< created if it is missing
  std::string address = "127.0.0.1";                  ///< to listen on
  int port = 8642;                                    ///< 0: any free port
  std::filesystem::path sample;                       ///< folder with meshes and footprints; empty: none
  Basemap basemap;
  std::string reviewer;                                 ///< who decides about models on the page; empty: unknown
  std::uint64_t upload_limit = std::uint64_t{4} << 30;  ///< bytes per uploaded file
};

/// Serves until it is cancelled. `ready` receives the link as soon as the server listens; the link grants full access.
/// Every answered change is on disk, however the server ends. Fails with "server-folder", "server-locked",
/// "server-project", "server-port", "server-random", "file-…".
[[nodiscard]] auto serve(const Options& options, const base::Cancel& cancel,
                         const std::function<void(const std::string& link)>& ready) -> base::Result<void>;

/// Maximum size of a JSON body, in bytes.
inline constexpr std::uint64_t json_limit = std::uint64_t{16} << 20;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::server
