// Durable files: once a call has returned, its file survives a power cut. Files are complete or do not exist.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "mansard/base/result.hpp"

namespace mansard::server {

/// A file descriptor that is closed by its destructor.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(other.release()) {}
  auto operator=(Descriptor&& other) noexcept -> Descriptor&;
  Descriptor(const Descriptor&) = delete;
  auto operator=(const Descriptor&) -> Descriptor& = delete;
  ~Descriptor();
  [[nodiscard]] auto number() const -> int { return number_; }
  [[nodiscard]] auto is_open() const -> bool { return number_ >= 0; }

 private:
  auto release() -> int;
  int number_;
};

/// Writes a temporary file in the same folder, flushes it, renames it and flushes the folder. Fails with
/// "file-write".
[[nodiscard]] auto write_durably(const std::filesystem::path& path, std::string_view bytes) -> base::Result<void>;
/// Makes the folder; its parent must exist. An existing folder is no error, a symbolic link is: what is written into
/// the folder would go elsewhere. Fails with "file-write".
[[nodiscard]] auto make_folder(const std::filesystem::path& path) -> base::Result<void>;
/// Renames within one file system and flushes both parent folders. Fails with "file-write".
[[nodiscard]] auto move_durably(const std::filesystem::path& from, const std::filesystem::path& to)
    -> base::Result<void>;

/// "server-exists": an upload would replace this file.
[[nodiscard]] auto name_taken(const std::filesystem::path& path) -> base::Diagnostic;

/// A file to which lines are appended; each line is on disk before append() returns.
class Journal {
 public:
  /// Truncates the file to `kept` bytes. Fails with "file-write".
  [[nodiscard]] static auto open(const std::filesystem::path& path, std::uint64_t kept) -> base::Result<Journal>;
  /// Appends the line and a line break, or nothing. Fails with "file-write".
  [[nodiscard]] auto append(std::string_view line) -> base::Result<void>;

 private:
  Journal(std::filesystem::path path, Descriptor file, std::uint64_t size);
  std::filesystem::path path_;
  Descriptor file_;
  std::uint64_t size_ = 0;
};

/// A file that is received piece by piece. It gets its name when it is complete; an incomplete one is deleted.
class Arriving {
 public:
  /// Fails with "file-write".
  [[nodiscard]] static auto open(std::filesystem::path path) -> base::Result<Arriving>;
  Arriving(Arriving&&) = default;
  auto operator=(Arriving&&) -> Arriving& = default;
  ~Arriving();
  [[nodiscard]] auto add(std::string_view bytes) -> base::Result<void>;
  [[nodiscard]] auto size() const -> std::uint64_t { return size_; }
  [[nodiscard]] auto finish() -> base::Result<void>;
  /// As finish(), but an existing file is never replaced: it is kept if it has the same bytes, and otherwise the call
  /// fails with "server-exists".
  [[nodiscard]] auto finish_new() -> base::Result<void>;

 private:
  Arriving(std::filesystem::path path, std::filesystem::path beside, Descriptor file);
  std::filesystem::path path_, beside_;
  Descriptor file_;
  std::uint64_t size_ = 0;
};

}  // namespace mansard::server
