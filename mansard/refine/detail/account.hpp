// What a search has taken, and how much it may take: a count of work, since time would depend on the machine.
#pragma once

#include <atomic>
#include <cstdint>

#include "mansard/model/plan.hpp"
#include "mansard/refine/detail/site.hpp"

namespace mansard::refine::detail {

/// Work in samples: as long as a roof takes to be compared with one. The numbers of one roof, and of its corners one by
/// one and two by two (the wavefront looks for hits of each corner with each edge), are fitted to the CPU time of 263
/// buildings: 10 ns a sample, 50 µs a roof, 5 µs a corner and 0.1 µs a pair (28 November 2026).
constexpr std::uint64_t work_of_roof = 5000, work_of_corner = 500, work_of_corners = 10;
/// The same fit, of a sample in a search for cuts: 1.6 µs.
constexpr std::uint64_t work_of_cut = 160;

[[nodiscard]] inline auto samples_of(const Site& site) -> std::uint64_t { return site.cells.size() + site.z.size(); }

/// Of one roof over a site, whether it is made or known from before: what is known depends on the order of threads.
[[nodiscard]] inline auto work_of(const Site& site, std::uint64_t corners) -> std::uint64_t {
  return samples_of(site) + work_of_roof + work_of_corner * corners + work_of_corners * corners * corners;
}
[[nodiscard]] inline auto corners_of(const model::Plan& plan) -> std::uint64_t {
  std::uint64_t corners = plan.outer.points.size();
  for (const auto& hole : plan.holes) corners += hole.points.size();
  return corners;
}

/// As docs/decisions/0132-bounded-work.md measured it.
constexpr std::uint64_t samples_of_corner = 100;
/// What the search for roofs of that size may take in all; `most_work` of each sample.
[[nodiscard]] inline auto most_work_of(std::uint64_t samples, std::uint64_t corners, std::int64_t most_work)
    -> std::uint64_t {
  return static_cast<std::uint64_t>(most_work) * (samples + samples_of_corner * corners);
}

/// Of one owner. Calls may run on any thread; the sum is the same in any order, and is read between them.
class Account {
 public:
  void add(std::uint64_t work) { spent_.fetch_add(work, std::memory_order_relaxed); }
  [[nodiscard]] auto spent() const -> std::uint64_t { return spent_.load(std::memory_order_relaxed); }

  /// That something was left out because a bound was met.
  void met_a_bound() { met_a_bound_.store(true, std::memory_order_relaxed); }
  [[nodiscard]] auto has_met_a_bound() const -> bool { return met_a_bound_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::uint64_t> spent_{0};
  std::atomic<bool> met_a_bound_{false};
};

}  // namespace mansard::refine::detail
