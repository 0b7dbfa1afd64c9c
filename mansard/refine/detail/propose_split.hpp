// Straight lines across a part with another roof on either side.
#pragma once

#include <vector>

#include "mansard/refine/detail/propose.hpp"
#include "mansard/refine/detail/propose_raster.hpp"

namespace mansard::refine::detail::carve {

struct SplitLine {
  double at = 0;      ///< m along the raster's x; the line goes along y
  double gain = 0;    ///< m² × cells, what two surfaces explain beyond one
  bool step = false;  ///< the two roofs differ in height at the line; else they meet there, as in a valley
};

/// The best lines across the raster's x, few and apart from each other (`Options::splits`); best first. Each explains
/// `least_gain`, m²·m².
[[nodiscard]] auto split_lines(const Raster& raster, double least_gain, const Options& options)
    -> std::vector<SplitLine>;

}  // namespace mansard::refine::detail::carve
