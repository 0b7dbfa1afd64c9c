// Pictures that GDAL reads and writes in memory.
#pragma once

#include <cpl_conv.h>
#include <cpl_vsi.h>

#include <string>
#include <utility>

namespace mansard::formats {

/// A file in memory for as long as it lives.
class MemoryFile {
 public:
  explicit MemoryFile(std::string name) : name_(std::move(name)) {}
  MemoryFile(const MemoryFile&) = delete;
  auto operator=(const MemoryFile&) -> MemoryFile& = delete;
  ~MemoryFile() { VSIUnlink(name_.c_str()); }
  [[nodiscard]] auto name() const -> const char* { return name_.c_str(); }
  /// What was written to it; empty where nothing was.
  [[nodiscard]] auto bytes() const -> std::string {
    vsi_l_offset size = 0;
    const GByte* start = VSIGetMemFileBuffer(name_.c_str(), &size, FALSE);
    return start == nullptr ? std::string()
                            : std::string(reinterpret_cast<const char*>(start), static_cast<std::size_t>(size));
  }

 private:
  std::string name_;
};

/// No file with metadata is looked for, or written, beside a picture.
class WithoutSidecars {
 public:
  WithoutSidecars() { CPLSetThreadLocalConfigOption("GDAL_PAM_ENABLED", "NO"); }
  WithoutSidecars(const WithoutSidecars&) = delete;
  auto operator=(const WithoutSidecars&) -> WithoutSidecars& = delete;
  ~WithoutSidecars() { CPLSetThreadLocalConfigOption("GDAL_PAM_ENABLED", nullptr); }
};

}  // namespace mansard::formats
