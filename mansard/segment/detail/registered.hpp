// A block's footprints where the mesh has them.
#pragma once

#include "mansard/block/block.hpp"
#include "mansard/sweep/sweep.hpp"

namespace mansard::segment::detail {

/// The block with its footprints displaced by the registration, without its mesh.
[[nodiscard]] inline auto registered(const block::Block& block, const sweep::Registration& registration)
    -> block::Block {
  block::Block moved{block.name, block.members, block.outline, {}, block.ground};
  const auto move_polygon = [&](geometry::Polygon& polygon) {
    for (auto& p : polygon.outer) p = p + registration.shift;
    for (auto& hole : polygon.holes)
      for (auto& p : hole) p = p + registration.shift;
  };
  for (auto& member : moved.members)
    for (auto& polygon : member.polygons) move_polygon(polygon);
  for (auto& polygon : moved.outline) move_polygon(polygon);
  return moved;
}

}  // namespace mansard::segment::detail
