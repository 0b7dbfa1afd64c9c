// Parts of a file, without reading the rest.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "mansard/base/result.hpp"

namespace mansard::formats {

/// Some bytes of a file, for as long as this lives.
class Range {
 public:
  Range(std::string_view view, std::shared_ptr<const void> owner) : view_(view), owner_(std::move(owner)) {}
  [[nodiscard]] auto view() const -> std::string_view { return view_; }

 private:
  std::string_view view_;
  std::shared_ptr<const void> owner_;
};

/// A file of which parts are asked for: read part by part where it is on disk or on a server, decompressed as a whole
/// where it is in an archive. Files on disk are not kept open: there may be thousands of them.
class RangeFile {
 public:
  virtual ~RangeFile() = default;
  RangeFile() = default;
  RangeFile(const RangeFile&) = delete;
  auto operator=(const RangeFile&) -> RangeFile& = delete;

  /// Fails with "file-missing", "file-read".
  [[nodiscard]] static auto open(const std::filesystem::path& path) -> base::Result<std::shared_ptr<const RangeFile>>;

  [[nodiscard]] virtual auto size() const -> std::uint64_t = 0;
  /// SHA-256 of all of it; none of a file on a server, which would be fetched for that. Fails with "file-read".
  [[nodiscard]] virtual auto hash() const -> base::Result<std::optional<std::string>> = 0;
  /// `count` bytes from `offset` on, or those up to the end of the file. From any thread. Fails with "file-read".
  [[nodiscard]] virtual auto read(std::uint64_t offset, std::uint64_t count) const -> base::Result<Range> = 0;
};

}  // namespace mansard::formats
