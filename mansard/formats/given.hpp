// What can be wrong with a file that a user names, before any reader opens it.
#pragma once

#include <filesystem>

#include "mansard/base/result.hpp"

namespace mansard::formats {

/// Of a pipe, that a program writes to it, for which it waits up to 10 s: opening one that no program writes to would
/// never end. Of a file, that it is not text in UTF-16 or UTF-32, which looks damaged to every reader. Anything else
/// passes. Fails with "file-read".
[[nodiscard]] auto check_given(const std::filesystem::path& path) -> base::Result<void>;

}  // namespace mansard::formats
