// What numbers have in common.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace mansard::base {

/// Of the values, which are not empty, the one in the middle; of two the higher.
[[nodiscard]] inline auto median(std::vector<double> values) -> double {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// The middle of the window of that breadth that holds most of the sorted, non-empty values; of two as full the lower.
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
