// Straight walks through the fractured ground.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "mansard/segment/detail/origins.hpp"

namespace mansard::segment::detail {

/// Where a walk leaves a face.
struct Exit {
  std::uint32_t half_edge = 0;  ///< of the face
  double distance = 0;          ///< m from the start
};

/// The first edge in the way of a walk through a face, which starts on its half-edge `from`; `direction` is of unit
/// length. None where rounding leaves no way.
[[nodiscard]] inline auto exit_of(const fracture::Arrangement& arrangement, std::uint32_t from, geometry::Point2 start,
                                  geometry::Point2 direction) -> std::optional<Exit> {
  std::optional<Exit> first;
  for (std::uint32_t h = arrangement.half_edges[from].next; h != from; h = arrangement.half_edges[h].next) {
    const geometry::Segment2 s = arrangement.segment(h);
    const geometry::Point2 along = s.end - s.start, towards = s.start - start;
    const double across = geometry::cross(direction, along);
    if (!(across > 0)) continue;  // the face lies on its left: a way out crosses to its right
    const double at = geometry::cross(towards, direction) / across;
    const double distance = geometry::cross(towards, along) / across;
    if (at < 0 || at > 1 || distance < 0) continue;
    if (!first || distance < first->distance) first = Exit{h, distance};
  }
  return first;
}

}  // namespace mansard::segment::detail
