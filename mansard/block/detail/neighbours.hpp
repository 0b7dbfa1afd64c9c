// Which footprints touch, and what they look like from outside together.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::block::detail {

using Polygons = std::vector<geometry::Polygon>;

/// m between two closed segments; 0 where they meet.
[[nodiscard]] auto distance(const geometry::Segment2& a, const geometry::Segment2& b) -> double;

/// Whether two areas are nearer than `touch` or have a point in common.
[[nodiscard]] auto are_near(const Polygons& a, const Polygons& b, double touch) -> bool;

/// A shape by its number. The reference is good until the next call but one.
using ShapeOf = std::function<const Polygons&(std::size_t)>;

/// Groups of shapes linked by nearness: each ascending, ordered by their first. `boxes` are those of the shapes; only
/// shapes whose boxes come near are asked for. Cost: O(m log m + pairs whose boxes come near), where boxes overlap few
/// others.
[[nodiscard]] auto groups_of(const std::vector<geometry::Box2>& boxes, const ShapeOf& shape_of, double touch)
    -> std::vector<std::vector<std::size_t>>;

/// The union, with gaps narrower than `touch` closed. Where those have less than `gap_area` m², or there are none, its
/// points are those of the shapes. Where an operation fails, the gaps stay open, or the shapes are as they are, and a
/// warning "block-outline" says so.
[[nodiscard]] auto outline_of(const Polygons& shapes, double touch, double gap_area,
                              std::vector<base::Diagnostic>& warnings) -> Polygons;

}  // namespace mansard::block::detail
