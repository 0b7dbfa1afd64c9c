// Polygons with all their corners changed in the same manner.
#pragma once

#include "mansard/geometry/polygon.hpp"

namespace mansard::geometry {

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
