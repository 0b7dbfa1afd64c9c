// Connected regions of a part that may be a part of their own.
#pragma once

#include <cstdint>
#include <vector>

#include "mansard/refine/detail/propose.hpp"
#include "mansard/refine/detail/propose_raster.hpp"

namespace mansard::refine::detail::carve {

struct Region {
  std::vector<std::uint8_t> mask;  ///< per cell of the raster
  int least_column = 0, most_column = 0, least_row = 0, most_row = 0;
  std::size_t cells = 0;
};

/// Islands above and below the model and, where one runs around something, what it runs around. In an order that
/// depends on the raster only.
[[nodiscard]] auto regions_of(const Raster& raster, const Options& options) -> std::vector<Region>;

/// Connected cells whose samples lie on one plane, or on planes that meet in ridges and hips, where that explains at
/// least `least_gain`, m²·m², of what the model leaves. In the order of the planes' numbers.
[[nodiscard]] auto regions_of_planes(const Raster& raster, const OnPlanes& samples, double least_gain,
                                     const Options& options) -> std::vector<Region>;

/// The mask, less what is within `by` metres of a cell that is not in it; a square's distance.
[[nodiscard]] auto shrunk(const Raster& raster, const std::vector<std::uint8_t>& mask, double by)
    -> std::vector<std::uint8_t>;
/// And with what is within `by` metres of it.
[[nodiscard]] auto grown(const Raster& raster, const std::vector<std::uint8_t>& mask, double by)
    -> std::vector<std::uint8_t>;

}  // namespace mansard::refine::detail::carve
