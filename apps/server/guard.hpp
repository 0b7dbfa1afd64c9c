// Who may talk to the server: a page that came from it, with the token of the link. Everything here is a plain function
// of texts, so that it can be tested without a socket.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "mansard/base/result.hpp"

namespace mansard::server {

/// 128 bits of the kernel's randomness in hexadecimal. Gives up with "server-random".
[[nodiscard]] auto new_token() -> base::Result<std::string>;

/// Takes as long wherever the texts begin to differ.
[[nodiscard]] auto same_secret(std::string_view a, std::string_view b) -> bool;

class Guard {
 public:
  Guard(std::string address, int port, std::string token);

  [[nodiscard]] auto token() const -> const std::string& { return token_; }
  /// Whether a request for the page may be answered. A name that was pointed at this machine by somebody else (DNS
  /// rebinding) is in `host`, and is refused. Gives up with "server-host", "server-origin".
  [[nodiscard]] auto check(std::string_view host, const std::optional<std::string>& origin) const -> base::Result<void>;
  /// Of what is under /api. Gives up with "server-token".
  [[nodiscard]] auto check_token(std::string_view authorization) const -> base::Result<void>;

 private:
  [[nodiscard]] auto ours(std::string_view host) const -> bool;
  std::string address_, port_, token_;
};

/// Whether nobody but this machine can reach the address.
[[nodiscard]] auto is_loopback(std::string_view address) -> bool;

}  // namespace mansard::server
