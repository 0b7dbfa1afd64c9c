// What is known of the roofs that were judged over one site.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "mansard/model/plan.hpp"
#include "mansard/model/solid.hpp"

namespace mansard::refine::detail {

/// A roof without what is seen of it from above, which takes most of the memory and is quickly made again.
struct Known {
  model::Plan plan;
  model::Solid sketch;
  double misfit = 0;                ///< m²·m²
  std::vector<std::uint32_t> bare;  ///< faces
};

/// Roofs by plan: a search comes back to many, and a thorough one begins as a quick one did. Calls may run on any
/// thread; what is found is the same as if it were made again.
class KnownRoofs {
 public:
  /// Valid as long as this is.
  [[nodiscard]] auto find(const model::Plan& plan) const -> const Known*;
  /// m²·m²: a cost that the plan's roof is known to reach at least; 0 where nothing is known.
  [[nodiscard]] auto costs_at_least(const model::Plan& plan) const -> double;
  void add(Known roof);
  void add_too_dear(const model::Plan& plan, double least_cost);

 private:
  struct TooDear {
    std::uint64_t key = 0;
    model::Plan plan;
    double least_cost = 0;
  };
  mutable std::mutex mutex_;
  std::deque<Known> roofs_;          // addresses stay
  std::vector<std::uint64_t> keys_;  // of the roofs: equal plans have equal ones
  std::vector<TooDear> too_dear_;
};

}  // namespace mansard::refine::detail
