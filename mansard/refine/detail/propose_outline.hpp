// Rectangles for what stands in a part.
#pragma once

#include <optional>
#include <vector>

#include "mansard/refine/detail/propose_raster.hpp"
#include "mansard/refine/detail/propose_regions.hpp"

namespace mansard::refine::detail::carve {

/// The rectangle that covers the region best, its sides moved to the part's own edges where those are near. In the
/// raster's frame; it may reach beyond the part. None where too little of the region is in it. `across` is the raster
/// turned.
[[nodiscard]] auto outline_of(const Raster& raster, const Raster& across, const Region& region, const Options& options)
    -> std::optional<geometry::Polygon>;

/// The smallest rectangle around the region, where the region fills that and no rectangle along the raster's axes. In
/// the raster's frame.
[[nodiscard]] auto askew_outline_of(const Raster& raster, const Region& region, const Options& options)
    -> std::optional<geometry::Polygon>;

/// m; the roofs on both sides of a wall are read up to this distance from it.
[[nodiscard]] inline auto reach_beside(const Options& options) -> double { return 3 * options.samples.melt; }

/// The place x, or that of an edge of the part that is near and nearly parallel to y; what is cut goes from y to y.
[[nodiscard]] auto aligned(const Raster& raster, double at, double from, double to, const Options::Outlines& options)
    -> double;

/// Polygon clipped to the part: its pieces, the largest first.
[[nodiscard]] auto pieces_in_part(const geometry::Polygon& part, const geometry::Polygon& polygon,
                                  const Options::Pieces& options) -> std::vector<geometry::Polygon>;
/// The same of one in the frame.
[[nodiscard]] auto pieces_in_part(const geometry::Polygon& part, const geometry::Polygon& in_frame, const Frame& frame,
                                  const Options::Pieces& options) -> std::vector<geometry::Polygon>;

}  // namespace mansard::refine::detail::carve
