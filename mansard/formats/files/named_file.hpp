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

/// That a file does not begin as text in UTF-16 or UTF-32 does, which is read nowhere but in XML. Fails with
/// "file-read".
[[nodiscard]] auto check_text(const std::filesystem::path& path) -> base::Result<void>;

/// A picture or a library of materials that `from` names, perhaps with the path of another computer: then the file of
/// the same name beside `from`. Fails as check_reach(given, …), where nothing was opened.
[[nodiscard]] auto named_beside(const std::filesystem::path& given, const std::filesystem::path& from, std::string name)
    -> base::Result<std::filesystem::path>;

}  // namespace mansard::formats
