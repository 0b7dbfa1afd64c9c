// Files appear whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"

namespace mansard::base {

/// Writes beside the target and renames. Gives up with "file-write" (what the system said, and the path).
[[nodiscard]] auto write_file(const std::filesystem::path& path, std::string_view bytes) -> Result<void>;

struct FileToWrite {
  std::filesystem::path path;
  std::string_view bytes;
};

/// All of the files or none: every one is written beside its target before the first is renamed. Gives up with
/// "file-write", and with "cancelled" when that is asked for before the first is renamed.
[[nodiscard]] auto write_files(const std::vector<FileToWrite>& files, const Cancel* cancel = nullptr) -> Result<void>;

/// The whole file. Gives up with "file-missing" (no such file), "file-read" (a folder, no permission, a failed read).
[[nodiscard]] auto read_file(const std::filesystem::path& path) -> Result<std::string>;

/// Diagnostic codes of this room: files and options.
[[nodiscard]] auto codes() -> std::vector<Code>;

}  // namespace mansard::base
