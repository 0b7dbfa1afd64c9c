// Where wings meet: along the lines of edges that go on inside beyond a reflex corner.
#pragma once

#include <vector>

#include "mansard/geometry/polygon.hpp"
#include "mansard/refine/options.hpp"

namespace mansard::refine::detail {

/// A piece that a wing's line cuts off a part.
struct Wing {
  geometry::Polygon polygon;
  geometry::Point2 middle;  ///< of the line that is new
  double length = 0;        ///< m; of that line
};

/// One side of every such line; and both once more with a wedge of half the line's length beyond it, which is where
/// the roof of a wing runs into the slope of another as high. A bent plan has a roof that profiles around it cannot
/// raise where one wing runs through and ends in a gable; its wings have. In the order of the edges.
[[nodiscard]] auto wings_of(const geometry::Polygon& part, const Options& options) -> std::vector<Wing>;

}  // namespace mansard::refine::detail
