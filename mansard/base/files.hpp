// Files are written completely or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"

namespace mansard::base {

/// Writes beside the target and renames. Fails with "file-write" (the system's message and the path).
[[nodiscard]] auto write_file(const std::filesystem::path& path, std::string_view bytes) -> Result<void>;

struct FileToWrite {
  std::filesystem::path path;
  std::string_view bytes;
};

/// All of the files or none: every one is written beside its target before the first is renamed. Fails with
/// "file-write", and with "cancelled" when the run is cancelled before the first is renamed.
[[nodiscard]] auto write_files(const std::vector<FileToWrite>& files, const Cancel* cancel = nullptr) -> Result<void>;

/// Every input can be read again, so none is a pipe. Opening one would also wait for a program that writes to it,
/// without end. Anything else passes. Fails with "file-read".
[[nodiscard]] auto check_no_pipe(const std::filesystem::path& path) -> Result<void>;

/// The whole file. Fails with "file-missing" (no such file), "file-read" (a folder, a pipe, no permission, a failed
/// read).
[[nodiscard]] auto read_file(const std::filesystem::path& path) -> Result<std::string>;

/// Diagnostic codes of this module: files and options.
[[nodiscard]] auto codes() -> std::vector<Code>;

}  // namespace mansard::base
