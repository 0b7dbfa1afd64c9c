// What a piece of work takes: processor time on all threads that do it, and time by the clock.
#pragma once

#include <chrono>
#include <memory>
#include <span>

namespace mansard::base {

struct Spent {
  /// Time that processors spent on the work: on the thread of the watch, and on every thread that ran its
  /// `parallel_for` or one inside it, waiting in a loop for the last of them included. Not counted: threads that a
  /// library starts by itself, as Embree does while it sorts the triangles of a large mesh.
  double cpu_seconds = 0;
  /// From the beginning of the work to its end. It includes pauses, and other work that the thread did meanwhile: a
  /// thread that waits for its own `parallel_for` may help with another one.
  double wall_seconds = 0;
  std::chrono::steady_clock::time_point begin;
};

/// What several pieces of work took, which may overlap in time: processor time adds up; time by the clock is that
/// during which at least one of them was under way.
[[nodiscard]] auto combined(std::span<const Spent> pieces) -> Spent;

/// Measures the work of the thread that makes it, from then on. Watches of a thread end in the reverse order of their
/// beginnings; what an inner one counts, the outer ones count too.
class Watch {
 public:
  Watch();
  ~Watch();
  Watch(const Watch&) = delete;
  auto operator=(const Watch&) -> Watch& = delete;

  /// Ends the measurement; only once, and on the thread that made the watch.
  [[nodiscard]] auto stop() -> Spent;

  struct Account;  ///< see watch.cpp

 private:
  std::unique_ptr<Account> account_;
  std::chrono::steady_clock::time_point begin_;
};

namespace detail {

/// The account that the calling thread's time goes to; null without a watch.
[[nodiscard]] auto current_account() -> Watch::Account*;

/// While it exists, the time of the calling thread goes to that account; afterwards to the one before it.
class Charge {
 public:
  explicit Charge(Watch::Account* account);
  ~Charge();
  Charge(const Charge&) = delete;
  auto operator=(const Charge&) -> Charge& = delete;

 private:
  Watch::Account* before_;
};

}  // namespace detail
}  // namespace mansard::base
