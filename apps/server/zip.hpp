// A folder as one ZIP file to download, and back.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mansard/base/result.hpp"

namespace mansard::server {

/// All files of a folder and its subfolders as a ZIP without compression (APPNOTE.TXT of PKWARE, method 0). Files are
/// sorted by name and have a fixed date: the same files give the same bytes. Fails with "server-large" beyond the
/// limits of the format (4 GB, 65,535 files), and as base::read_file does.
[[nodiscard]] auto zip_of(const std::filesystem::path& folder) -> base::Result<std::string>;

/// Whether the name has the file extension of a ZIP file.
[[nodiscard]] auto is_zip(const std::filesystem::path& path) -> bool;

/// The names of the files in a ZIP file without compression, as zip_of() makes them. Fails with "server-archive" for
/// compressed or encrypted files, for names that leave the folder, and for damaged archives; and as base::read_file.
[[nodiscard]] auto names_in_zip(const std::filesystem::path& zip) -> base::Result<std::vector<std::string>>;

/// Writes the files of such a ZIP file into a new folder. They have at most the size of the ZIP file together, since
/// nothing is compressed. Fails as names_in_zip(), and with "file-write".
[[nodiscard]] auto unzip(const std::filesystem::path& zip, const std::filesystem::path& folder) -> base::Result<void>;

}  // namespace mansard::server
