// Access control: requests must come from a page of this server and carry the token of its link. Everything here works
// on strings, so that it can be tested without a socket.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "mansard/base/result.hpp"

namespace mansard::server {

/// 128 random bits from the kernel, in hexadecimal. Fails with "server-random".
[[nodiscard]] auto new_token() -> base::Result<std::string>;

/// Compares in constant time, wherever the strings differ.
[[nodiscard]] auto same_secret(std::string_view a, std::string_view b) -> bool;

class Guard {
 public:
  Guard(std::string address, int port, std::string token);

  [[nodiscard]] auto token() const -> const std::string& { return token_; }
  /// Checks the headers Host and Origin. A foreign name that resolves to this machine (DNS rebinding) is refused. Gives
  /// up with "server-host", "server-origin".
  [[nodiscard]] auto check(std::string_view host, const std::optional<std::string>& origin) const -> base::Result<void>;
  /// Checks the header Authorization of a request under /api. Fails with "server-token".
  [[nodiscard]] auto check_token(std::string_view authorization) const -> base::Result<void>;

 private:
  [[nodiscard]] auto ours(std::string_view host) const -> bool;
  std::string address_, port_, token_;
};

/// Whether the address can be reached from this machine only.
[[nodiscard]] auto is_loopback(std::string_view address) -> bool;

}  // namespace mansard::server
