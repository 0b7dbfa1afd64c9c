// What all stages of a run share: the request to stop, the report of progress, the threads, the seed.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace mansard::base {

/// Set from a signal handler or another thread; read between pieces of work.
class Cancel {
 public:
  void request() noexcept { asked_.store(true, std::memory_order_relaxed); }
  [[nodiscard]] auto requested() const noexcept -> bool { return asked_.load(std::memory_order_relaxed); }

 private:
  std::atomic<bool> asked_{false};
};

/// Passed by const reference to every public function that takes long. All members are optional.
struct Run {
  const Cancel* cancel = nullptr;
  /// Called with (stage, subject, fraction done 0..1), from the thread that runs the stage only.
  std::function<void(std::string_view, std::string_view, double)> progress;
  std::uint64_t seed = 1;

  [[nodiscard]] auto cancelled() const -> bool { return cancel != nullptr && cancel->requested(); }
  void report(std::string_view stage, std::string_view subject, double fraction) const {
    if (progress) progress(stage, subject, fraction);
  }
};

/// Calls work(0) … work(count − 1), in any order and on any thread; each call must only write to what belongs to its
/// index, so that results are the same at any thread count. Exceptions are thrown again in the caller's thread.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& work);

/// Limits `parallel_for` to that many threads from now on (process-wide); 0 restores all cores.
void limit_threads(std::size_t threads);

/// A small seeded generator (SplitMix64), the same on every platform.
class Random {
 public:
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0) : state_(seed + 0x9e3779b97f4a7c15ULL * (stream + 1)) {}

  auto next() -> std::uint64_t {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  /// Uniform in [0, 1).
  auto uniform() -> double { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  /// Uniform in [least, most).
  auto uniform(double least, double most) -> double { return least + (most - least) * uniform(); }
  /// Uniform in 0 … count − 1.
  auto index(std::size_t count) -> std::size_t { return static_cast<std::size_t>(next() % count); }

 private:
  std::uint64_t state_;
};

}  // namespace mansard::base
