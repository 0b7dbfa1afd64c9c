// Files that are there after a power cut once the call has returned, and whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "mansard/base/result.hpp"

namespace mansard::server {

/// A descriptor that is closed with its owner.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(other.release()) {}
  auto operator=(Descriptor&& other) noexcept -> Descriptor&;
  Descriptor(const Descriptor&) = delete;
  auto operator=(const Descriptor&) -> Descriptor& = delete;
  ~Descriptor();
  [[nodiscard]] auto number() const -> int { return number_; }
  [[nodiscard]] auto there() const -> bool { return number_ >= 0; }

 private:
  auto release() -> int;
  int number_;
};

/// Written beside, flushed, renamed; the folder is flushed too. Gives up with "file-write".
[[nodiscard]] auto write_durably(const std::filesystem::path& path, std::string_view bytes) -> base::Result<void>;
/// Makes the folder, whose parent must be there; no error where it is there already. Gives up with "file-write".
[[nodiscard]] auto make_folder(const std::filesystem::path& path) -> base::Result<void>;
/// Renames within one file system and flushes both folders. Gives up with "file-write".
[[nodiscard]] auto move_durably(const std::filesystem::path& from, const std::filesystem::path& to)
    -> base::Result<void>;

/// A file that only grows, line by line; each line is on the disk before append() returns.
class Journal {
 public:
  /// Cuts what is there at `kept` bytes. Gives up with "file-write".
  [[nodiscard]] static auto open(const std::filesystem::path& path, std::uint64_t kept) -> base::Result<Journal>;
  /// All of the line, which gets its line break here, or nothing. Gives up with "file-write".
  [[nodiscard]] auto append(std::string_view line) -> base::Result<void>;

 private:
  Journal(std::filesystem::path path, Descriptor file, std::uint64_t size);
  std::filesystem::path path_;
  Descriptor file_;
  std::uint64_t size_ = 0;
};

/// A file that arrives piece by piece and gets its name when it is whole; one that does not vanishes.
class Arriving {
 public:
  /// Gives up with "file-write".
  [[nodiscard]] static auto open(std::filesystem::path path) -> base::Result<Arriving>;
  Arriving(Arriving&&) = default;
  auto operator=(Arriving&&) -> Arriving& = default;
  ~Arriving();
  [[nodiscard]] auto add(std::string_view bytes) -> base::Result<void>;
  [[nodiscard]] auto size() const -> std::uint64_t { return size_; }
  [[nodiscard]] auto finish() -> base::Result<void>;

 private:
  Arriving(std::filesystem::path path, std::filesystem::path beside, Descriptor file);
  std::filesystem::path path_, beside_;
  Descriptor file_;
  std::uint64_t size_ = 0;
};

}  // namespace mansard::server
