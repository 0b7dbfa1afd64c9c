// The hash of bytes that come one after the other.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace mansard::formats {

/// As sha256 of all bytes together.
class Sha256 {
 public:
  Sha256();
  void add(std::string_view bytes);
  /// Can be called once.
  [[nodiscard]] auto text() -> std::string;

 private:
  std::shared_ptr<void> context_;
};

}  // namespace mansard::formats
