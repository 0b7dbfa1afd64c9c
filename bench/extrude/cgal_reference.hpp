// The reference of the benchmark: CGAL's unweighted straight skeleton.
#pragma once

#include <cstddef>

#include "mansard/geometry/polygon.hpp"

namespace mansard::bench {

/// CGAL's skeleton of the ring's interior, made and thrown away: how many inner nodes it has, 0 where CGAL gives up.
[[nodiscard]] auto nodes_of_cgal_skeleton(const geometry::Ring& ring) -> std::size_t;

}  // namespace mansard::bench
