// Connected regions of a part that stand above or below the model together.
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

/// Islands above and below the model at every level that parts the residuals, bands between such levels, and, where a
/// region runs around something, what it runs around. In an order that depends on the raster only.
[[nodiscard]] auto regions_of(const Raster& raster, const Options& options) -> std::vector<Region>;

/// What is farther from the model than differences count, and narrower than a structure, is as if it were unseen:
/// strips along walls that were sampled beside their place, chimneys, cables.
void leave_out_strays(Raster& raster, const Options& options);

/// Connected cells whose points lie on one plane, where that explains at least `least_gain`, m²·m², of what the model
/// leaves. In the order of the planes' numbers.
[[nodiscard]] auto regions_of_planes(const Raster& raster, const OnPlanes& points, double least_gain,
                                     const Options& options) -> std::vector<Region>;

/// The direction of the region's own walls where they agree on one, from how the residual rises at its rim.
[[nodiscard]] auto own_direction(const Raster& raster, const Region& region, const Options::Regions& options,
                                 Frame& direction) -> bool;

/// The mask, less what is within `by` metres of a cell that is not in it; a square's distance.
[[nodiscard]] auto shrunk(const Raster& raster, const std::vector<std::uint8_t>& mask, double by)
    -> std::vector<std::uint8_t>;
/// And with what is within `by` metres of it.
[[nodiscard]] auto grown(const Raster& raster, const std::vector<std::uint8_t>& mask, double by)
    -> std::vector<std::uint8_t>;

}  // namespace mansard::refine::detail::carve
