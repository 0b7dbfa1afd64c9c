// The terrain at the walls of a building: where it meets them, not somewhere in a ring around them.
#pragma once

#include <optional>
#include <vector>

#include "mansard/block/block.hpp"
#include "mansard/block/detail/ground.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/model/scene.hpp"

namespace mansard::block::detail {

/// The terrain along an outline, and the height of its lowest place.
struct TerrainFound {
  double lowest = 0;  ///< z
  AtWalls walls;
};

/// From samples of what may be ground around a shape (ground_samples). Nothing where no sample is farther from the
/// shape than Options::overhang and nearer than 3 m more.
///
/// 1. The outline is divided into stations of `terrain_step` at most. A sample belongs to the station that it is
/// nearest
///    to; from `overhang` outward every half metre has the median of its samples.
/// 2. What rises or falls by more than 45° from one such height to the next is not one surface (steeper is no ground
///    elsewhere either: Options::ground_cosine). Stations that follow each other on one surface are a run. A run that
///    is above its neighbours and shorter than a quarter of the outline is an object beside the wall (car, hedge, tree,
///    shed); one that is below them and shorter than `ground_percentile` of it is a pit. Both are left out. What is
///    left touches the wall: a street behind the edge of a quay or a retaining wall is not, since the surface ends
///    there.
/// 3. All heights that are left are fitted by a plane and a slope away from the walls (a house on a mound, or in a
///    hollow). Where the surface departs from that, the departure counts as far as places 3 m along the wall
///    share it: terrain continues, noise does not (the regression of one on the other, as in kriging).
/// 4. Heights are those on the outline itself.
[[nodiscard]] auto terrain_at_walls(const std::vector<geometry::Polygon>& shape, const std::vector<Sample>& samples,
                                    const Options& options) -> std::optional<TerrainFound>;

/// From a terrain model, which has a height on the outline itself, along `terrain_share` of it or more. `origin`: of
/// the shape's frame, in the terrain's; heights are in the shape's frame.
[[nodiscard]] auto terrain_at_walls(const std::vector<geometry::Polygon>& shape, const model::HeightGrid& terrain,
                                    geometry::Point3 origin, const Options& options) -> std::optional<TerrainFound>;

}  // namespace mansard::block::detail
