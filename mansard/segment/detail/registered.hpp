// A block's footprints where the mesh has them.
#pragma once

#include "mansard/block/block.hpp"
#include "mansard/geometry/change.hpp"
#include "mansard/sweep/sweep.hpp"

namespace mansard::segment::detail {

/// The block with its footprints displaced by the registration, without its mesh.
[[nodiscard]] inline auto registered(const block::Block& block, const sweep::Registration& registration)
    -> block::Block {
  block::Block moved{block.name, block.members, block.outline, {}, block.ground};
  for (auto& member : moved.members)
    for (auto& polygon : member.polygons) geometry::move(polygon, registration.shift);
  for (auto& polygon : moved.outline) geometry::move(polygon, registration.shift);
  return moved;
}

}  // namespace mansard::segment::detail
