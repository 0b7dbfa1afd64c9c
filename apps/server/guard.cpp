#include "apps/server/guard.hpp"

#include <sys/random.h>
#include <algorithm>
#include <array>
#include <cctype>

#include "mansard/base/text.hpp"

namespace mansard::server {
namespace {

constexpr std::string_view bearer = "Bearer ";

/// Whether it is an IP address: a DNS entry cannot redirect it.
auto is_number(std::string_view host) -> bool {
  if (host.starts_with('[')) return true;
  return !host.empty() && std::ranges::all_of(host, [](unsigned char c) { return std::isdigit(c) != 0 || c == '.'; });
}

}  // namespace

auto new_token() -> base::Result<std::string> {
  std::array<unsigned char, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    return base::error("server-random", "the system provides no random numbers, so no token can be made");
  constexpr std::string_view digits = "0123456789abcdef";
  std::string token;
  for (const auto byte : bytes) {
    token += digits[byte >> 4];
    token += digits[byte & 15];
  }
  return token;
}

auto same_secret(std::string_view a, std::string_view b) -> bool {
  if (a.size() != b.size()) return false;  // the length is not secret
  volatile unsigned char difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference =
        static_cast<unsigned char>(difference | (static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i])));
  return difference == 0;
}

auto is_loopback(std::string_view address) -> bool {
  return address == "localhost" || address == "::1" || (address.starts_with("127.") && is_number(address));
}

Guard::Guard(std::string address, int port, std::string token)
    : address_(base::lower(address.find(':') == std::string::npos ? address : "[" + address + "]")),
      port_(std::to_string(port)),
      token_(std::move(token)) {}

auto Guard::ours(std::string_view given) const -> bool {
  const auto whole = base::lower(given);
  std::string_view host = whole;
  const auto colon = host.rfind(':');
  const bool has_port = colon != std::string_view::npos && host.find(']', colon) == std::string_view::npos;
  if (has_port ? host.substr(colon + 1) != port_ : port_ != "80") return false;
  if (has_port) host = host.substr(0, colon);
  if (host == address_ || (host == "localhost" && (is_loopback(address_) || address_ == "0.0.0.0"))) return true;
  // A server that listens on all addresses can be reached by any of them.
  return (address_ == "0.0.0.0" || address_ == "[::]") && is_number(host);
}

auto Guard::check(std::string_view host, const std::optional<std::string>& origin) const -> base::Result<void> {
  if (!ours(host))
    return base::error("server-host", "the request names another host; open the link that 'mansard serve' printed");
  constexpr std::string_view scheme = "http://";
  if (origin && (!origin->starts_with(scheme) || !ours(std::string_view(*origin).substr(scheme.size()))))
    return base::error("server-origin",
                       "the request comes from a page of another server; open the link that 'mansard serve' printed");
  return {};
}

auto Guard::check_token(std::string_view authorization) const -> base::Result<void> {
  const bool right = authorization.starts_with(bearer) && same_secret(authorization.substr(bearer.size()), token_);
  if (right) return {};
  return base::error("server-token", "the token is missing or wrong; open the link that 'mansard serve' printed last");
}

}  // namespace mansard::server
