#include "apps/server/connections.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <array>
#include <filesystem>
#include <optional>

#include "mansard/base/text.hpp"

namespace mansard::server {
namespace {

using Peer = std::pair<std::string, int>;

auto port_of(const sockaddr_storage& address) -> int {
  if (address.ss_family == AF_INET) return ntohs(reinterpret_cast<const sockaddr_in*>(&address)->sin_port);  // NOLINT
  if (address.ss_family == AF_INET6)
    return ntohs(reinterpret_cast<const sockaddr_in6*>(&address)->sin6_port);  // NOLINT
  return 0;
}

/// None if the file is no connection of that local port.
auto peer_of(int file, int port) -> std::optional<Peer> {
  sockaddr_storage local{}, remote{};
  socklen_t size = sizeof local;
  if (::getsockname(file, reinterpret_cast<sockaddr*>(&local), &size) != 0 || port_of(local) != port)  // NOLINT
    return std::nullopt;
  size = sizeof remote;
  if (::getpeername(file, reinterpret_cast<sockaddr*>(&remote), &size) != 0) return std::nullopt;  // NOLINT
  std::array<char, INET6_ADDRSTRLEN> host{};
  const void* number =
      remote.ss_family == AF_INET
          ? static_cast<const void*>(&reinterpret_cast<const sockaddr_in*>(&remote)->sin_addr)     // NOLINT
          : static_cast<const void*>(&reinterpret_cast<const sockaddr_in6*>(&remote)->sin6_addr);  // NOLINT
  if (::inet_ntop(remote.ss_family, number, host.data(), host.size()) == nullptr) return std::nullopt;
  return Peer{host.data(), port_of(remote)};
}

}  // namespace

void Connections::look(Clock::time_point now) {
  std::map<Peer, Connection> found;
  std::error_code status;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", status)) {
    const int file = static_cast<int>(base::to_integer(entry.path().filename().string()).value_or(-1));
    auto peer = peer_of(file, port_);
    if (!peer) continue;
    const auto known = open_.find(*peer);
    found[*peer] = known != open_.end() ? known->second : Connection{file, now};
  }
  open_ = std::move(found);
}

void Connections::end(const Connection& connection) { ::shutdown(connection.file, SHUT_RDWR); }

void Connections::accepted() {
  const std::scoped_lock lock(mutex_);
  look(Clock::now());
  std::map<std::string, std::size_t> count;
  for (const auto& [peer, connection] : open_) ++count[peer.first];
  for (const auto& [address, of_it] : count) {
    if (of_it <= most_of_an_address) continue;
    auto longest = open_.end();
    for (auto at = open_.begin(); at != open_.end(); ++at)
      if (at->first.first == address && at->second.waits &&
          (longest == open_.end() || at->second.since < longest->second.since))
        longest = at;
    if (longest == open_.end()) continue;
    end(longest->second);
    open_.erase(longest);
  }
}

void Connections::arrived(const std::string& address, int port) {
  const std::scoped_lock lock(mutex_);
  const auto at = open_.find({address, port});
  if (at != open_.end()) at->second.waits = false;
}

void Connections::answered(const std::string& address, int port) {
  const std::scoped_lock lock(mutex_);
  const auto at = open_.find({address, port});
  if (at == open_.end()) return;
  at->second.waits = at->second.served_before = true;
  at->second.since = Clock::now();
}

void Connections::end_slow() {
  const std::scoped_lock lock(mutex_);
  const auto now = Clock::now();
  look(now);
  for (const auto& [peer, connection] : open_) {
    const auto limit = connection.served_before ? idle_limit + head_limit : head_limit;
    if (connection.waits && now - connection.since > limit) end(connection);
  }
}

void Connections::end_reading() {
  const std::scoped_lock lock(mutex_);
  look(Clock::now());
  for (const auto& [peer, connection] : open_) ::shutdown(connection.file, SHUT_RD);
}

}  // namespace mansard::server
