// A grid smoothed as a scan smooths steps: by a kernel of five cells in both directions.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace mansard::refine::detail {

/// Cells of nothing that a grid needs on every side.
constexpr std::size_t blur_reach = 2;

/// The weights of a cell and of those one and two beside it; sixteen together along a row.
struct Kernel {
  double here = 6, beside = 4, beyond = 1;

  /// With that standard deviation, in cells: none at 0, the binomial of five at 1, five alike at √2 and above.
  [[nodiscard]] static auto of(double deviation) -> Kernel {
    constexpr double widest = 2;  // the variance of five cells alike
    const double v = std::min(deviation * deviation, widest);
    Kernel k;
    k.beyond = v <= 1 ? v * v : 1 + 2.2 * (v - 1);
    k.beside = 8 * v - 4 * k.beyond;  // 2 beside + 8 beyond = 16 v
    k.here = 16 - 2 * k.beside - 2 * k.beyond;
    return k;
  }
};

/// Sums along rows, 16 times the mean: of every cell but the first and last two.
inline void blur_rows(const Kernel& k, const std::vector<double>& of, std::vector<double>& sums) {
  for (std::size_t i = blur_reach; i + blur_reach < of.size(); ++i)
    sums[i] = k.here * of[i] + k.beside * (of[i - 1] + of[i + 1]) + k.beyond * (of[i - 2] + of[i + 2]);
}

/// 256 times the mean about one cell of the padded grid, from the sums along rows.
[[nodiscard]] inline auto blurred(const Kernel& k, const std::vector<double>& sums, std::size_t i, std::size_t stride)
    -> double {
  return k.here * sums[i] + k.beside * (sums[i - stride] + sums[i + stride]) +
         k.beyond * (sums[i - 2 * stride] + sums[i + 2 * stride]);
}

}  // namespace mansard::refine::detail
