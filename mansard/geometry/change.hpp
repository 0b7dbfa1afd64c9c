// Polygons from loops of any corners, and polygons with all their corners changed in the same manner.
#pragma once

#include "mansard/geometry/polygon.hpp"

namespace mansard::geometry {

/// A ring of each loop, outer first, with the corner `on(c)` for every c of the loop; in the orientation of the loops.
template <class Loops, class On>
[[nodiscard]] auto polygon_of(const Loops& loops, const On& on) -> Polygon {
  Polygon out;
  bool first = true;
  for (const auto& loop : loops) {
    Ring& ring = first ? out.outer : out.holes.emplace_back();
    first = false;
    ring.reserve(loop.size());
    for (const auto& corner : loop) ring.push_back(on(corner));
  }
  return out;
}

/// Every corner p becomes change(p).
template <class Change>
void change_corners(Ring& ring, const Change& change) {
  for (Point2& p : ring) p = change(p);
}
template <class Change>
void change_corners(Polygon& polygon, const Change& change) {
  change_corners(polygon.outer, change);
  for (Ring& hole : polygon.holes) change_corners(hole, change);
}

inline void move(Polygon& polygon, Point2 by) {
  change_corners(polygon, [by](Point2 p) { return p + by; });
}

}  // namespace mansard::geometry
