// What happens, told to every page that listens.
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

/// One page that listens. It is deaf no longer when it is destroyed.
class Listener {
 public:
  ~Listener();
  Listener(const Listener&) = delete;
  auto operator=(const Listener&) -> Listener& = delete;

  /// What is to be sent next, as server-sent events; a ping when nothing happens for that long; nothing at the end.
  [[nodiscard]] auto next(std::chrono::milliseconds patience) -> std::optional<std::string>;

 private:
  friend class Events;
  explicit Listener(Events& events) : events_(events) {}
  struct Waiting {
    std::string about;  ///< a later event about the same takes its place; empty: about nothing
    std::shared_ptr<const std::string> text;
  };
  Events& events_;
  std::deque<Waiting> waiting_;
  bool deaf_ = false;  ///< it fell too far behind: it has to connect again and ask for everything
};

class Events {
 public:
  /// Each listener holds a thread of the server.
  static constexpr std::size_t most_listeners = 12, most_waiting = 512;

  /// None where there are too many already.
  [[nodiscard]] auto listen() -> std::unique_ptr<Listener>;
  /// `json` on one line. Of waiting events about the same thing only the last is sent.
  void tell(const std::string& json, const std::string& about = {});
  /// Lets every listener go, and those to come.
  void close();

 private:
  friend class Listener;
  std::mutex mutex_;
  std::condition_variable something_;
  std::list<Listener*> listeners_;
  bool closed_ = false;
};

}  // namespace mansard::server
