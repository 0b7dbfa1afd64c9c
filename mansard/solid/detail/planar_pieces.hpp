// A face that is not planar, as few planar pieces.
#pragma once

#include <functional>
#include <vector>

#include "mansard/solid/triangulator.hpp"

namespace mansard::solid::detail {

/// Pieces of a face that keep to its corners and are `good`; triangles are taken as they are. Most often rounding moved
/// one or two corners: a triangle at each of them leaves the rest as it was. Where that cannot be, `triangles` of the
/// face, put together again across the longest diagonals while what they make is good. The order of corners of `face`
/// decides nothing but which triangle goes first where two would do. Cost: O(n²) planes fitted for n corners.
[[nodiscard]] auto planar_pieces(const model::Solid& solid, const model::Face& face,
                                 const std::vector<Corners>& triangles,
                                 const std::function<bool(const model::Face&)>& good) -> std::vector<model::Face>;

}  // namespace mansard::solid::detail
