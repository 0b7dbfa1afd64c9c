// A grid smoothed by a binomial of five cells in both directions; its variance is one cell squared.
#pragma once

#include <cstddef>
#include <vector>

namespace mansard::refine::detail {

/// Cells of nothing that a grid needs on every side.
constexpr std::size_t blur_reach = 2;

/// Sums along rows, 16 times the mean: of every cell but the first and last two.
inline void blur_rows(const std::vector<double>& of, std::vector<double>& sums) {
  for (std::size_t i = blur_reach; i + blur_reach < of.size(); ++i)
    sums[i] = 6 * of[i] + 4 * (of[i - 1] + of[i + 1]) + (of[i - 2] + of[i + 2]);
}

/// 256 times the mean about one cell of the padded grid, from the sums along rows.
[[nodiscard]] inline auto blurred(const std::vector<double>& sums, std::size_t i, std::size_t stride) -> double {
  return 6 * sums[i] + 4 * (sums[i - stride] + sums[i + stride]) + (sums[i - 2 * stride] + sums[i + 2 * stride]);
}

}  // namespace mansard::refine::detail
