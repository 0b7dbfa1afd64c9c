// Files as GDAL sees them: on disk, in archives, compressed, or on a server.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "mansard/base/result.hpp"

namespace mansard::formats {

/// Whether GDAL's virtual files are asked for: "/vsizip/…", "/vsigzip/…", "/vsicurl/…", "/vsis3/…", or a name that ends
/// in ".gz".
[[nodiscard]] auto is_virtual(const std::filesystem::path& path) -> bool;

/// The name that tells the format: without ".gz".
[[nodiscard]] auto plain_name(const std::filesystem::path& path) -> std::filesystem::path;

/// What GDAL calls the file: "x.gz" is "/vsigzip/x.gz", "x.zip" is "/vsizip/x.zip", on a server too; all else, and what
/// says already how it is opened, keeps its name.
[[nodiscard]] auto name_for_gdal(const std::filesystem::path& path) -> std::string;

/// Whether there is a file or folder of that name. Of servers this asks; nothing is said where they do not answer.
[[nodiscard]] auto is_there(const std::filesystem::path& path) -> bool;

/// The archive on disk that a virtual name leads into, and the name of its member; both empty where there is none.
[[nodiscard]] auto archive_of(const std::string& name) -> std::pair<std::filesystem::path, std::string>;

/// What of a whole archive on disk is to be opened: packing a folder makes an archive with that folder alone in it, and
/// macOS adds one of its own beside it. All other names stay as they are.
[[nodiscard]] auto inside_of(std::string name) -> std::string;

/// Why there is no such file, in an archive, on a server or on disk: "file-missing", or "file-read" with GDAL's words
/// where a server or a damaged archive does not give it.
[[nodiscard]] auto why_missing(const std::filesystem::path& path) -> base::Diagnostic;

/// The bytes of a file, mapped where it lies on disk, unpacked or fetched where it is virtual. A mapped file must not
/// be cut shorter while it is read.
class Bytes {
 public:
  [[nodiscard]] auto view() const -> std::string_view { return view_; }
  /// Fails with "file-missing", "file-read".
  [[nodiscard]] static auto of(const std::filesystem::path& path) -> base::Result<Bytes>;

 private:
  std::shared_ptr<const void> owner_;
  std::string_view view_;
};

}  // namespace mansard::formats
