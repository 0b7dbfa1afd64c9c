// The open connections of the server: how many there may be, and how long a request may take to arrive.
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <mutex>
#include <string>
#include <utility>

namespace mansard::server {

/// The HTTP library does not expose its sockets: they are found by their local port. All functions may be called from
/// any thread.
class Connections {
 public:
  /// Of one address. Beyond it, the one that has waited longest for the end of a request is ended: a browser opens a
  /// new connection then, and nobody can occupy all threads of the server.
  static constexpr std::size_t most_of_an_address = 128;
  /// For the first line and the headers of a request, however slowly they come. Connections that are reused may be idle
  /// before that.
  static constexpr std::chrono::seconds head_limit{10}, idle_limit{15};

  void listen(int port) { port_ = port; }
  /// To be called when a connection was accepted.
  void accepted();
  /// The headers of a request from there have arrived; its answer has been sent.
  void arrived(const std::string& address, int port);
  void answered(const std::string& address, int port);
  /// Ends the connections whose time is over. To be called now and then.
  void end_slow();
  /// Ends what can be read from all of them; answers in progress are still sent.
  void end_reading();

 private:
  using Clock = std::chrono::steady_clock;
  using Peer = std::pair<std::string, int>;  // address and port
  struct Connection {
    int file = -1;
    Clock::time_point since;  // it has waited for a request, or has been served
    bool waits = true, served_before = false;
  };
  void look(Clock::time_point now);
  static void end(const Connection& connection);

  std::mutex mutex_;
  std::map<Peer, Connection> open_;
  int port_ = 0;
};

}  // namespace mansard::server
