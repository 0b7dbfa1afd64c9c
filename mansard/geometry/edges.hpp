// The edges of rings and polygons, one after the other.
#pragma once

#include "mansard/geometry/polygon.hpp"

namespace mansard::geometry {

/// Calls visit(from, to) for every edge.
template <class Visit>
void each_edge(const Ring& ring, Visit&& visit) {
  for (std::size_t i = 0; i < ring.size(); ++i) visit(ring[i], ring[(i + 1) % ring.size()]);
}

/// The same, of the outer ring and then of the holes.
template <class Visit>
void each_edge(const Polygon& polygon, Visit&& visit) {
  each_edge(polygon.outer, visit);
  for (const auto& hole : polygon.holes) each_edge(hole, visit);
}

}  // namespace mansard::geometry
