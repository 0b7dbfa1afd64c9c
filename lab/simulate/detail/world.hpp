// All that is scanned: buildings, ground, objects.
#pragma once

#include <vector>

#include "lab/simulate/detail/surroundings.hpp"

namespace mansard::simulate::detail {

struct World {
  const Surface& surface;
  const Terrain& terrain;
  const std::vector<Object>& objects;
  geometry::Box2 area;  ///< what is scanned, in plan
};

}  // namespace mansard::simulate::detail
