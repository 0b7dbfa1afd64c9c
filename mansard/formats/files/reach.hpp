// What files may make the program open: a file that is read can name others.
#pragma once

#include <filesystem>

#include "mansard/base/result.hpp"

namespace mansard::formats {

/// Whether `named`, which a file of the input `given` names, may be opened. On disk and in archives: what is in the
/// folder of the given file, or below it. From a server: what is on the same server. Never a server from a file on
/// disk. Symbolic links in the folder were put there by its owner and are followed. The environment variable
/// MANSARD_OUTSIDE=yes allows everything: who starts the program decides, not who sends it files. Fails with
/// "ingest-outside".
[[nodiscard]] auto check_reach(const std::filesystem::path& given, const std::filesystem::path& named)
    -> base::Result<void>;

/// Whether the name leads to a network: a server, a database or a service.
[[nodiscard]] auto is_remote(const std::filesystem::path& path) -> bool;

/// While it lives, GDAL opens no connection from this thread, unless `given` leads to a network itself: what a file on
/// disk says must not make the program call out. MANSARD_OUTSIDE=yes allows it.
class Offline {
 public:
  explicit Offline(const std::filesystem::path& given);
  Offline(const Offline&) = delete;
  auto operator=(const Offline&) -> Offline& = delete;
  ~Offline();

 private:
  bool active_;
};

}  // namespace mansard::formats
