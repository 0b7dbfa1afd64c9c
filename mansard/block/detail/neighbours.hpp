// Which footprints touch, and what they look like from outside together.
#pragma once

#include <cstddef>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::block::detail {

using Polygons = std::vector<geometry::Polygon>;

/// m between two closed segments; 0 where they meet.
[[nodiscard]] auto distance(const geometry::Segment2& a, const geometry::Segment2& b) -> double;

/// Whether two areas are nearer than `touch` or have a point in common.
[[nodiscard]] auto are_near(const Polygons& a, const Polygons& b, double touch) -> bool;

/// Groups of shapes linked by nearness: each ascending, ordered by their first. Boxes are swept along x, so the cost
/// is O(m log m + pairs whose boxes come near).
[[nodiscard]] auto groups_of(const std::vector<Polygons>& shapes, double touch)
    -> std::vector<std::vector<std::size_t>>;

/// The union, with gaps narrower than `touch` closed. Where those have less than `gap_area` m², or there are none, its
/// points are those of the shapes. Where an operation fails, the gaps stay open, or the shapes are as they are, and a
/// warning "block-outline" says so.
[[nodiscard]] auto outline_of(const Polygons& shapes, double touch, double gap_area,
                              std::vector<base::Diagnostic>& warnings) -> Polygons;

}  // namespace mansard::block::detail
