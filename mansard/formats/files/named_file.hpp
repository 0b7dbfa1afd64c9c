// Files that other files name.
#pragma once

#include <filesystem>
#include <string>

#include "mansard/base/result.hpp"
#include "mansard/formats/files/virtual_files.hpp"

namespace mansard::formats {

/// The bytes of a buffer or a tile. As Bytes::of, but never of a device or a pipe, which need not end: those a user may
/// name, not a file. Fails with "file-missing", "file-read".
[[nodiscard]] auto bytes_of_named(const std::filesystem::path& path) -> base::Result<Bytes>;

/// A file that another one in `folder` names, perhaps with the path of another computer: then that of the same name in
/// `folder`.
[[nodiscard]] auto named_beside(const std::filesystem::path& folder, std::string name) -> std::filesystem::path;

}  // namespace mansard::formats
