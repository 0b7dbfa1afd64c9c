// A project served to a browser on this machine: the workbench, and what it calls (openapi.json).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"

namespace mansard::server {

struct Options {
  std::filesystem::path project = "mansard-project";    ///< made if it is missing
  std::string address = "127.0.0.1";                    ///< of the machine, to listen on
  int port = 8642;                                      ///< 0: any that is free
  std::filesystem::path sample;                         ///< a folder with meshes and footprints; empty: none
  std::uint64_t upload_limit = std::uint64_t{4} << 30;  ///< bytes of one uploaded file
};

/// Serves until it is cancelled. `ready` is told the link once it works: whoever has it may do all that the page can.
/// Whatever was answered is on the disk, however it ends. Gives up with "server-folder",
/// "server-locked", "server-project", "server-port", "server-random", "file-…".
[[nodiscard]] auto serve(const Options& options, const base::Cancel& cancel,
                         const std::function<void(const std::string& link)>& ready) -> base::Result<void>;

/// The largest body of JSON, bytes.
inline constexpr std::uint64_t json_limit = std::uint64_t{16} << 20;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::server
