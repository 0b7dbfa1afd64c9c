// What files may make the program open: a file that is read can name others.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "mansard/base/result.hpp"
#include "mansard/crs/gdal_reach.hpp"

namespace mansard::formats {

/// Whether `named`, which a file of the input `given` names, may be opened. On disk and in archives: what is in the
/// folder of the given file, or below it, also after symbolic links are followed; of an archive, what is in it. From a
/// server: what is on the same server. Never a server from a file on disk. The environment variable MANSARD_OUTSIDE=yes
/// allows everything: who starts the program decides, not who sends it files. Fails with "ingest-outside".
[[nodiscard]] auto check_reach(const std::filesystem::path& given, const std::filesystem::path& named)
    -> base::Result<void>;

/// Whether the name leads to a network: a server, a database or a service.
[[nodiscard]] auto is_remote(const std::filesystem::path& path) -> bool;

/// While it lives, GDAL opens in this thread only what `given` may name (check_reach), whatever driver reads it and
/// however deep one file leads to the next, and no connection beyond the server of `given`.
class Confined {
 public:
  explicit Confined(const std::filesystem::path& given);
  Confined(const Confined&) = delete;
  auto operator=(const Confined&) -> Confined& = delete;
  ~Confined();

  /// Fails with "ingest-outside" where something else was named; `given` was then read without it, or not at all.
  [[nodiscard]] auto check() const -> base::Result<void>;

 private:
  std::filesystem::path given_;
  std::string server_;  ///< that `given` is on
  bool offline_ = false;
  std::optional<crs::GdalReach> reach_;
};

}  // namespace mansard::formats
