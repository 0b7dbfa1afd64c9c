// Several files as one to take away.
#pragma once

#include <filesystem>
#include <string>

#include "mansard/base/result.hpp"

namespace mansard::server {

/// All files of a folder and below it as a ZIP, as they are (APPNOTE.TXT of PKWARE, method 0), in the order of their
/// names and of no date: the same files give the same bytes. Gives up with "server-large" where the format ends (4 GB,
/// 65,535 files), and as base::read_file does.
[[nodiscard]] auto zip_of(const std::filesystem::path& folder) -> base::Result<std::string>;

}  // namespace mansard::server
