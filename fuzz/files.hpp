// Files in memory and on disk for fuzzers of what reads files: some that stay as they are, and one whose bytes change.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/fuzz.hpp"
#include "mansard/base/files.hpp"
#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"

namespace mansard::fuzz {

/// A file in memory, whose content can be replaced.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(memfd_create("fuzz", 0)), path_("/proc/self/fd/" + std::to_string(descriptor_)) {}
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  auto operator=(const MemoryFile&) -> MemoryFile& = delete;

  void hold(std::string_view bytes) const {
    promise(ftruncate(descriptor_, 0) == 0, "no file in memory");
    promise(pwrite(descriptor_, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()), "no memory");
  }
  [[nodiscard]] auto path() const -> const std::string& { return path_; }

 private:
  int descriptor_;
  std::string path_;
};

/// A folder of names for the changing file and of files that stay, since a file is taken by its name and with those
/// beside it. The names are of one file on disk: a link to memory would lead out of the folder.
class Folder {
 public:
  explicit Folder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / ("mansard-fuzz-" + name + "-" + std::to_string(::getpid()))) {
    base::limit_threads(1);  // what a string leads to must not hang on who comes first
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
    descriptor_ = ::open((path_ / "changing").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  }
  ~Folder() {
    ::close(descriptor_);
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  auto operator=(const Folder&) -> Folder& = delete;

  /// Another name of the changing file.
  auto name(const std::string& name) const -> std::filesystem::path {
    const auto path = path_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::filesystem::create_hard_link(path_ / "changing", path);
    return path;
  }
  void hold(std::string_view bytes) const {
    promise(::ftruncate(descriptor_, 0) == 0, "no file to change");
    promise(::pwrite(descriptor_, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()), "no room");
  }

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
};

/// A module's codes, and those that all modules have in common.
inline auto with_common(std::vector<base::Code> codes) -> std::vector<base::Code> {
  const auto more = base::codes();
  codes.insert(codes.end(), more.begin(), more.end());
  return codes;
}

/// An error must be one that the modules list, on one line, and say something.
inline void check_error(const base::Diagnostic& error, const std::vector<base::Code>& codes) {
  const auto known = std::ranges::find(codes, error.code, &base::Code::code);
  const auto words = [&] { return base::to_string(error); };
  promise(known != codes.end() && known->exit_code != 0, "an error that is not the reader's", words);
  promise(!error.message.empty(), "an error that says nothing", words);
  promise(words().find('\n') == std::string::npos, "an error of several lines", words);
}

}  // namespace mansard::fuzz
