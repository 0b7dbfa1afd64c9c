// Events that are sent to every connected page.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace mansard::server {

class Events;

/// The connection of one page. The destructor disconnects it.
class Listener {
 public:
  ~Listener();
  Listener(const Listener&) = delete;
  auto operator=(const Listener&) -> Listener& = delete;

  /// The next server-sent events; a ping when there are none for `timeout`; nothing when the connection ends.
  [[nodiscard]] auto next(std::chrono::milliseconds timeout) -> std::optional<std::string>;

 private:
  friend class Events;
  explicit Listener(Events& events) : events_(events) {}
  struct Waiting {
    std::string about;  ///< replaced by a later event with the same value; empty: never replaced
    std::shared_ptr<const std::string> text;
  };
  Events& events_;
  std::deque<Waiting> waiting_;
  bool overrun_ = false;  ///< too many events were waiting: the page must reconnect and fetch everything again
};

class Events {
 public:
  /// Each listener occupies a thread of the server.
  static constexpr std::size_t most_listeners = 12, most_waiting = 512;

  /// Null if there are `most_listeners` already.
  [[nodiscard]] auto listen() -> std::unique_ptr<Listener>;
  /// Sends JSON on one line. Of the waiting events with the same `about` only the last is sent.
  void send(const std::string& json, const std::string& about = {});
  /// Disconnects every listener, and refuses new ones.
  void close();

 private:
  friend class Listener;
  std::mutex mutex_;
  std::condition_variable something_;
  std::list<Listener*> listeners_;
  bool closed_ = false;
};

}  // namespace mansard::server
