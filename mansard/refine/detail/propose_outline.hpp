// Outlines with walls along two directions for what stands in a part.
#pragma once

#include <vector>

#include "mansard/refine/detail/propose_raster.hpp"
#include "mansard/refine/detail/propose_regions.hpp"

namespace mansard::refine::detail::carve {

/// Along the raster's axes, metres.
struct Rectangle {
  geometry::Point2 least, most;
};

/// Outlines of one, two and more rectangles that cover the region best, their sides moved to where the heights step,
/// then to the part's own edges where those are near. In the raster's frame; they may reach beyond the part.
/// `across` is the raster turned.
[[nodiscard]] auto outlines_of(const Raster& raster, const Raster& across, const Region& region, const Options& options)
    -> std::vector<geometry::Polygon>;

/// Where along x the heights step near `at`, over some rows; `at` itself where they do not. Metres in the
/// raster's frame.
/// m; the roofs on both sides of a wall are read up to this distance from it.
[[nodiscard]] inline auto reach_beside(const Options& options) -> double { return 3 * options.samples.melt; }

[[nodiscard]] auto step_near(const Raster& raster, double at, const std::vector<int>& rows, const Options& options)
    -> double;

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
