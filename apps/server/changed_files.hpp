// Whether input files are still those that were read.
#pragma once

#include <map>
#include <mutex>
#include <string>

#include "apps/server/project.hpp"

namespace mansard::server {

/// Remembers the hashes that it computed. Every function may be called from any thread.
class ChangedFiles {
 public:
  /// Whether the file is missing or has other contents than `file` says. Compares size and time first, and the SHA-256
  /// only where these differ. Databases and servers are not queried: they count as unchanged.
  [[nodiscard]] auto changed(const KnownFile& file) -> bool;

 private:
  struct Checked {
    Stamp stamp;  ///< of the file when it was hashed
    bool changed = false;
  };
  std::mutex mutex_;
  std::map<std::string, Checked> checked_;  // by path and expected hash
};

}  // namespace mansard::server
