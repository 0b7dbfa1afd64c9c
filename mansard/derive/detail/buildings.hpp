// Which cells of what stands on the ground are buildings.
#pragma once

#include "mansard/derive/derive.hpp"
#include "mansard/derive/detail/grid.hpp"

namespace mansard::derive::detail {

/// Cells that stand at least `above` over the ground.
[[nodiscard]] auto standing(const Heights& top, const Heights& ground, double above) -> Mask;

/// The standing cells that lie in a plane that is large enough and not too steep. Roofs do, cluttered ones in part; the
/// crowns of trees
/// do not, whatever their height and density.
[[nodiscard]] auto in_planes(const Place& place, const Heights& top, const Mask& standing, const Options& options)
    -> Mask;

/// How smooth what stands is around each cell, 0 … 1: the share of the standing cells in a square that lie in
/// planes.
/// NaN where nothing stands.
[[nodiscard]] auto smoothness(const Place& place, const Mask& standing, const Mask& planes, const Options& options)
    -> Heights;

/// Which of the standing cells are buildings: pieces without steps are judged as wholes, and their cells beside that.
/// Holes
/// less than `least_area` large are closed; what is narrower than minimum_width, and blobs of less than `least_area`,
/// are left out.
[[nodiscard]] auto buildings(const Place& place, const Heights& top, const Mask& standing, const Mask& planes,
                             const Options& options) -> Mask;

/// The building of each cell, from 1 on, 0 for none: the blobs of `mask`, cut where pieces of at least `least_area`
/// stand `options.step`
/// or more above what they touch.
struct Cut {
  std::vector<std::int32_t> of;
  std::vector<double> height{0};  ///< z, median, of each
};
[[nodiscard]] auto cut_at_steps(const Place& place, const Heights& top, const Mask& mask, const Options& options)
    -> Cut;

}  // namespace mansard::derive::detail
