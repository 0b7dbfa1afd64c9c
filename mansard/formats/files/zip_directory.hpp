// The names in a ZIP file, in one pass.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace mansard::formats {

/// The names of the files, not the folders, in a ZIP file on disk, as its central directory has them (APPNOTE.TXT of
/// PKWARE, 4.3.12 to 4.3.16). GDAL asks for each member by going through all others. None where that would call one of
/// them differently (characters beyond ASCII, backslashes, names with "." and ".." or without any), and where this is
/// no ZIP file, or a damaged one. Linear in the size of the directory.
[[nodiscard]] auto names_in_zip(const std::filesystem::path& archive) -> std::optional<std::vector<std::string>>;

}  // namespace mansard::formats
