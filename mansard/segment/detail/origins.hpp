// What the origins of a half-edge say.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "mansard/fracture/fracture.hpp"
#include "mansard/segment/options.hpp"
#include "mansard/segment/segment.hpp"
#include "mansard/sweep/sweep.hpp"

namespace mansard::segment::detail {

[[nodiscard]] inline auto on_sweep_edge(const fracture::HalfEdge& h) -> bool {
  return std::ranges::any_of(
      h.origins, [](const fracture::Origin& o) { return o.kind == fracture::Kind::hard && o.source < gis_source; });
}
[[nodiscard]] inline auto on_gis_edge(const fracture::HalfEdge& h) -> bool {
  return std::ranges::any_of(
      h.origins, [](const fracture::Origin& o) { return o.kind == fracture::Kind::hard && o.source >= gis_source; });
}
/// isSweepEdge of the paper.
[[nodiscard]] inline auto is_sweep(const fracture::HalfEdge& h, const Options& options) -> bool {
  const auto continues_one = [](const fracture::Origin& o) {
    return o.kind == fracture::Kind::continuation && o.source < gis_source;
  };
  return on_sweep_edge(h) ||
         (options.continuations == Continuations::sweep && std::ranges::any_of(h.origins, continues_one));
}
/// Whether a footprint may have this edge without paying β.
[[nodiscard]] inline auto is_supported(const fracture::HalfEdge& h, const Options& options) -> bool {
  return is_sweep(h, options) || (options.gis_edges != GisEdges::ignore && on_gis_edge(h));
}
/// Whether leaving this edge out of the footprints pays for a GIS edge left unused.
[[nodiscard]] inline auto pays_as_gis(const fracture::HalfEdge& h, const Options& options) -> bool {
  return options.gis_edges == GisEdges::candidate && on_gis_edge(h) && !is_sweep(h, options);
}

/// The half-edges around a face, from its first.
[[nodiscard]] inline auto half_edges_around(const fracture::Arrangement& arrangement, std::uint32_t face)
    -> std::vector<std::uint32_t> {
  std::vector<std::uint32_t> around;
  std::uint32_t h = arrangement.faces[face].edge;
  do {
    around.push_back(h);
    h = arrangement.half_edges[h].next;
  } while (h != around.front());
  return around;
}
/// The face on the other side; none outside the bounding rectangle.
[[nodiscard]] inline auto face_across(const fracture::Arrangement& arrangement, std::uint32_t half_edge)
    -> std::optional<std::uint32_t> {
  return arrangement.half_edges[arrangement.half_edges[half_edge].twin].face;
}

[[nodiscard]] inline auto length_of(const fracture::Arrangement& arrangement, std::uint32_t half_edge) -> double {
  const geometry::Segment2 s = arrangement.segment(half_edge);
  return geometry::length(s.end - s.start);
}

}  // namespace mansard::segment::detail
