// What a scan of a planted block looks like from above.
#pragma once

#include <vector>

#include "mansard/geometry/mesh.hpp"
#include "planted.hpp"

namespace mansard::planted {

/// A dormer, chimney or van: an upright box.
struct Box {
  geometry::Polygon polygon;
  double top = 0;  ///< z, metres
};

/// A 2.5-D mesh of the houses and boxes on their ground, 5 m farther than they reach.
[[nodiscard]] auto scan(const std::vector<House>& houses, const std::vector<Box>& boxes, const Recipe& recipe)
    -> geometry::Mesh;

}  // namespace mansard::planted
