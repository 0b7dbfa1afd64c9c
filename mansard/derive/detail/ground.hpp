// From a mesh to heights on a grid, and to the ground under everything that stands on it.
#pragma once

#include <optional>

#include "mansard/base/result.hpp"
#include "mansard/derive/detail/grid.hpp"
#include "mansard/derive/options.hpp"
#include "mansard/model/scene.hpp"

namespace mansard::derive::detail {

/// A grid over the mesh, with a rim of cells without height.
[[nodiscard]] auto place_of(const geometry::Mesh& mesh, double cell) -> Place;

/// z of the topmost surface at the centre of each cell.
[[nodiscard]] auto top_heights(const geometry::Mesh& mesh, const Place& place) -> Heights;

/// z of the ground under every cell of the grid, also where something stands on it. The lowest surface in any square
/// `widest`
/// metres wide is ground, if it is not a hole; what is joined to that without a step is ground; the rest is filled in
/// between. NaN everywhere where nothing is ground.
[[nodiscard]] auto ground_of(const Place& place, const Heights& top, const Options& options) -> Heights;

/// The same of a terrain that was given; filled in where that has no height.
[[nodiscard]] auto ground_of(const Place& place, const model::HeightGrid& terrain) -> Heights;

}  // namespace mansard::derive::detail
