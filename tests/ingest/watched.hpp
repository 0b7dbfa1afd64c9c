// What reading a file touches: a port that counts who calls, and a folder that counts who opens its files.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/inotify.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <string>

namespace mansard::ingest::test {

/// A port of this machine that counts who calls, and answers nobody.
class Listening {
 public:
  Listening() : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* at = reinterpret_cast<sockaddr*>(&address);
    EXPECT_EQ(::bind(socket_, at, size), 0);
    EXPECT_EQ(::listen(socket_, 16), 0);
    EXPECT_EQ(::getsockname(socket_, at, &size), 0);
    port_ = ntohs(address.sin_port);
  }
  Listening(const Listening&) = delete;
  auto operator=(const Listening&) -> Listening& = delete;
  ~Listening() { ::close(socket_); }
  [[nodiscard]] auto port() const -> std::string { return std::to_string(port_); }
  [[nodiscard]] auto address() const -> std::string { return "http://127.0.0.1:" + port(); }
  [[nodiscard]] auto called() const -> bool {
    pollfd one{socket_, POLLIN, 0};
    return ::poll(&one, 1, 0) > 0;
  }

 private:
  int socket_, port_ = 0;
};

/// A folder whose files nobody should open.
class WatchedFolder {
 public:
  explicit WatchedFolder(const std::filesystem::path& folder) : events_(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
    EXPECT_GE(::inotify_add_watch(events_, folder.c_str(), IN_OPEN), 0);
  }
  WatchedFolder(const WatchedFolder&) = delete;
  auto operator=(const WatchedFolder&) -> WatchedFolder& = delete;
  ~WatchedFolder() { ::close(events_); }
  /// Since it was last asked; opening the folder itself, to list it, counts too.
  [[nodiscard]] auto opened() const -> bool {
    std::array<char, 4096> events{};
    bool any = false;
    while (::read(events_, events.data(), events.size()) > 0) any = true;
    return any;
  }

 private:
  int events_;
};

}  // namespace mansard::ingest::test
