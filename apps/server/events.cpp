#include "apps/server/events.hpp"

#include <algorithm>

namespace mansard::server {

Listener::~Listener() {
  const std::scoped_lock lock(events_.mutex_);
  events_.listeners_.remove(this);
}

auto Listener::next(std::chrono::milliseconds timeout) -> std::optional<std::string> {
  std::unique_lock lock(events_.mutex_);
  events_.something_.wait_for(lock, timeout, [&] { return !waiting_.empty() || overrun_ || events_.closed_; });
  if (overrun_ || events_.closed_) return std::nullopt;
  if (waiting_.empty()) return "data: {\"type\":\"ping\"}\n\n";
  std::string all;
  for (const auto& event : waiting_) all += "data: " + *event.text + "\n\n";
  waiting_.clear();
  return all;
}

auto Events::listen() -> std::unique_ptr<Listener> {
  const std::scoped_lock lock(mutex_);
  if (closed_ || listeners_.size() >= most_listeners) return nullptr;
  std::unique_ptr<Listener> listener(new Listener(*this));
  listeners_.push_back(listener.get());
  return listener;
}

void Events::send(const std::string& json, const std::string& about) {
  const auto text = std::make_shared<const std::string>(json);
  {
    const std::scoped_lock lock(mutex_);
    for (auto* listener : listeners_) {
      if (!about.empty()) std::erase_if(listener->waiting_, [&](const auto& event) { return event.about == about; });
      listener->waiting_.push_back({about, text});
      if (listener->waiting_.size() > most_waiting) listener->overrun_ = true;
    }
  }
  something_.notify_all();
}

void Events::close() {
  {
    const std::scoped_lock lock(mutex_);
    closed_ = true;
  }
  something_.notify_all();
}

}  // namespace mansard::server
