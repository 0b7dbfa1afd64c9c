// What can be wrong with a file that a user names, before any reader opens it.
#pragma once

#include <filesystem>

#include "mansard/base/result.hpp"

namespace mansard::formats {

/// That it is no pipe (base::check_no_pipe), and no file with text in UTF-16 or UTF-32, which looks damaged to every
/// reader. Fails with "file-read".
[[nodiscard]] auto check_given(const std::filesystem::path& path) -> base::Result<void>;

}  // namespace mansard::formats
