// What is in a folder of inputs.
#pragma once

#include <filesystem>
#include <vector>

#include "mansard/base/result.hpp"

namespace mansard::ingest::detail {

/// All files in a folder and below it, in no order; in buckets, and in archives that are not ZIP files, folders too,
/// which end in '/'. Fails with "file-read".
[[nodiscard]] auto files_below(const std::filesystem::path& folder) -> base::Result<std::vector<std::filesystem::path>>;

}  // namespace mansard::ingest::detail
