// A folder as one ZIP file to download.
#pragma once

#include <filesystem>
#include <string>

#include "mansard/base/result.hpp"

namespace mansard::server {

/// All files of a folder and its subfolders as a ZIP without compression (APPNOTE.TXT of PKWARE, method 0). Files are
/// sorted by name and have a fixed date: the same files give the same bytes. Fails with "server-large" beyond the
/// limits of the format (4 GB, 65,535 files), and as base::read_file does.
[[nodiscard]] auto zip_of(const std::filesystem::path& folder) -> base::Result<std::string>;

}  // namespace mansard::server
