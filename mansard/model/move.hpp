// Buildings and meshes in another frame.
#pragma once

#include "mansard/geometry/change.hpp"
#include "mansard/model/city.hpp"

namespace mansard::model {

/// Moves by whole metres, as far as frames are apart, so that nothing is rounded where it is near to both origins.
inline void move(Building& building, geometry::Point3 by) {
  const auto there = [by](geometry::Point2 p) { return p + xy(by); };
  const auto move_solid = [by](LabelledSolid& model) {
    for (auto& p : model.solid.vertices) p = p + by;
  };
  building.ground += by.z;
  for (auto& polygon : building.footprint) geometry::move(polygon, xy(by));
  for (auto& part : building.parts) {
    geometry::change_corners(part.plan.outer.points, there);
    for (auto& hole : part.plan.holes) geometry::change_corners(hole.points, there);
    part.plan.base += by.z;
    move_solid(part.model);
  }
  for (auto& solid : building.solids) move_solid(solid.model);
}

/// What to add to places in one frame to have them in another, m.
[[nodiscard]] inline auto between(const Frame& from, const Frame& to) -> geometry::Point3 {
  const auto along = [&](std::size_t axis) { return static_cast<double>(from.origin[axis] - to.origin[axis]); };
  return {along(0), along(1), along(2)};
}

}  // namespace mansard::model
