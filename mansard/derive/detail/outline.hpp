// From cells to polygons: the boundary of each building as the grid has it.
#pragma once

#include <cstdint>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/derive/detail/grid.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::derive::detail {

/// The polygons of the cells numbered 1 … `count` − 1, along the cells' sides; cells that have only a corner in common
/// are apart. Fails with "derive-outline" (the library's words).
[[nodiscard]] auto polygons_of(const Place& place, const std::vector<std::int32_t>& of, std::size_t count)
    -> base::Result<std::vector<std::vector<geometry::Polygon>>>;

}  // namespace mansard::derive::detail
