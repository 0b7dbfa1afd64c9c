// Where a test writes: a folder of its own, so that tests that run side by side never meet in one file.
#pragma once

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace mansard::test {

/// A new, empty folder among the system's temporary ones, which goes with its owner. Throws where none can be made.
class Scratch {
 public:
  Scratch() {
    std::string name = std::filesystem::temp_directory_path() / "mansard-test-XXXXXX";
    if (::mkdtemp(name.data()) == nullptr) throw std::system_error(errno, std::generic_category(), name);
    path_ = name;
  }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  auto operator=(const Scratch&) -> Scratch& = delete;

  [[nodiscard]] auto operator/(const std::filesystem::path& name) const -> std::filesystem::path {
    return path_ / name;
  }
  // NOLINTNEXTLINE(google-explicit-constructor): it is given wherever a path is
  operator const std::filesystem::path&() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace mansard::test
