// Medians, percentiles and modes of values. All are deterministic: equal values in another order give the same answer.
#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <functional>
#include <ranges>
#include <span>
#include <utility>
#include <vector>

namespace mansard::base {

/// The rank that a share (0 to 1) of the way from the lowest to the highest of `count` values falls on, where it is
/// between two ranks: the nearest, of two equally near the higher; or the one below.
enum class Rank { nearest, below };

/// 0 for the lowest of `count` ≥ 1 values, `count` − 1 for the highest.
[[nodiscard]] inline auto rank_at(std::size_t count, double share, Rank rank = Rank::nearest) -> std::size_t {
  assert(count > 0 && share >= 0 && share <= 1);
  return static_cast<std::size_t>(share * static_cast<double>(count - 1) + (rank == Rank::nearest ? 0.5 : 0));
}

/// The value with that rank; 0 is the lowest.
template <class T>
[[nodiscard]] auto ranked(std::vector<T> values, std::size_t rank) -> T {
  assert(rank < values.size());
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::ranges::nth_element(values, at);
  return *at;
}

/// Of values, which are not empty, the one a share of the way from the lowest to the highest.
template <class T>
[[nodiscard]] auto percentile(std::vector<T> values, double share, Rank rank = Rank::nearest) -> T {
  const auto at = rank_at(values.size(), share, rank);
  return ranked(std::move(values), at);
}
[[nodiscard]] inline auto percentile_of_sorted(std::span<const double> sorted, double share, Rank rank = Rank::nearest)
    -> double {
  return sorted[rank_at(sorted.size(), share, rank)];
}

/// Of values, which are not empty, the one in the middle; of two the higher.
template <class T>
[[nodiscard]] auto median(std::vector<T> values) -> T {
  const auto middle = values.size() / 2;
  return ranked(std::move(values), middle);
}
[[nodiscard]] inline auto median_of_sorted(std::span<const double> sorted) -> double {
  assert(!sorted.empty());
  return sorted[sorted.size() / 2];
}

/// Of values, which are not empty, the one in the middle; of two their mean.
[[nodiscard]] inline auto mean_median(std::vector<double> values) -> double {
  assert(!values.empty());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return values.size() % 2 == 1 ? *middle : 0.5 * (*std::max_element(values.begin(), middle) + *middle);
}
[[nodiscard]] inline auto mean_median_of_sorted(std::span<const double> sorted) -> double {
  assert(!sorted.empty());
  const auto middle = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
}

/// Of items sorted by value, which are not empty: the first value with which that share of the total weight is reached.
/// Weights are added in the order given.
template <std::ranges::forward_range Items, class Value, class Weight>
[[nodiscard]] auto weighted_percentile_of_sorted(const Items& sorted, double share, Value value, Weight weight)
    -> double {
  assert(!std::ranges::empty(sorted));
  double total = 0, passed = 0, last = 0;
  for (const auto& item : sorted) total += std::invoke(weight, item);
  for (const auto& item : sorted) {
    last = std::invoke(value, item);
    if ((passed += std::invoke(weight, item)) >= share * total) return last;
  }
  return last;
}

/// The middle of the window of that breadth that contains most of the sorted, non-empty values; of two with equally
/// many values the lower.
[[nodiscard]] inline auto commonest(std::span<const double> sorted, double breadth) -> double {
  std::size_t best = 0, most = 0;
  for (std::size_t low = 0, high = 0; low < sorted.size(); ++low) {
    while (high < sorted.size() && sorted[high] <= sorted[low] + breadth) ++high;
    if (high - low > most) {
      most = high - low;
      best = low;
    }
  }
  return sorted[best + most / 2];
}

}  // namespace mansard::base
