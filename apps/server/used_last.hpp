// What was made of blocks and may be needed again: as much of it as memory has room for.
#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <iterator>
#include <list>
#include <memory>
#include <mutex>
#include <utility>

namespace mansard::server {

/// Those used last are kept, up to a sum of their sizes, and the last one always. From any thread.
template <class T>
class UsedLast {
 public:
  UsedLast(std::size_t count, std::size_t most) : slots_(count), most_(most) {}

  /// What is kept under that number or still used by somebody, else what `make()` gives: a std::shared_ptr<const T>, or
  /// null, which is not kept.
  template <class Make>
  auto get(std::size_t number, std::size_t size, Make make) -> std::shared_ptr<const T> {
    auto& slot = slots_[number];
    const std::scoped_lock making(slot.mutex);
    auto made = slot.made.lock();
    if (!made) slot.made = made = make();
    if (made) keep(number, size, made);
    return made;
  }

 private:
  struct Slot {
    std::mutex mutex;
    std::weak_ptr<const T> made;
  };
  struct Kept {
    std::size_t number = 0, size = 0;
    std::shared_ptr<const T> made;
  };

  void keep(std::size_t number, std::size_t size, std::shared_ptr<const T> made) {
    std::list<Kept> dropped;  // outlives the lock: to free it takes time
    const std::scoped_lock lock(mutex_);
    const auto known = std::ranges::find(kept_, number, &Kept::number);
    if (known != kept_.end()) dropped.splice(dropped.end(), kept_, known);
    kept_.push_front({number, size, std::move(made)});
    std::size_t sum = 0;
    for (auto one = kept_.begin(); one != kept_.end();) {
      const auto next = std::next(one);
      sum += one->size;
      if (sum > most_ && one != kept_.begin()) dropped.splice(dropped.end(), kept_, one);
      one = next;
    }
  }

  std::deque<Slot> slots_;
  std::size_t most_;
  std::mutex mutex_;
  std::list<Kept> kept_;  ///< the last one first
};

}  // namespace mansard::server
