// Who is whose neighbour on a solid: its half-edges, and its lines by the words of the trade.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::solid {

/// The half-edges of a solid: one per corner of a loop, numbered face by face, loop by loop, corner by corner.
/// Half-edge h goes from origin[h] to origin[next[h]] with its face on the left, seen from outside. The exact plane of
/// a face is that of its provenance: the plan's edge moved in and up along the profile part (docs/extrude.md).
struct HalfEdges {
  static constexpr std::uint32_t none = UINT32_MAX;

  std::vector<std::uint32_t> origin;  ///< vertex of the solid
  std::vector<std::uint32_t> face;    ///< face of the solid
  std::vector<std::uint32_t> next;    ///< half-edge
  std::vector<std::uint32_t> twin;    ///< half-edge: the same line walked by the face on the other side

  std::vector<std::uint32_t> first_of_loop;  ///< loop k is half-edges first_of_loop[k] … first_of_loop[k + 1] − 1
  std::vector<std::uint32_t> first_loop_of_face;  ///< face f has loops first_loop_of_face[f] … [f + 1] − 1, outer first
  std::vector<std::uint32_t> leaving;             ///< a half-edge that leaves the vertex; none where no face comes

  [[nodiscard]] auto size() const -> std::size_t { return origin.size(); }
  [[nodiscard]] auto target(std::uint32_t h) const -> std::uint32_t { return origin[next[h]]; }
};

/// The half-edges of a closed 2-manifold. Fails with "solid-degenerate" (a loop of fewer than three vertices, or one
/// that names a vertex that is not there), "solid-open" and "solid-non-manifold", as check() does. O(n log n).
[[nodiscard]] auto half_edges(const model::Solid& solid) -> base::Result<HalfEdges>;

/// What a line of a building is called, by the two faces that meet in it. These are *base*; *wall* (a connector, or a
/// side that stands upright); *roof* (a side that leans inward); *flat* (terrace or cap); *soffit*. A line is *level*
/// when their planes meet in a horizontal line; *convex* when the solid fills less than half a turn about it, *reflex*
/// when more.
enum class LineKind : std::uint8_t {
  foot,          ///< base with anything: where the building meets the ground
  corner,        ///< wall with wall, convex
  inner_corner,  ///< wall with wall, reflex
  eave,          ///< wall or soffit with roof, level and convex, the roof rising from it
  mono_ridge,    ///< wall with roof, level and convex, the roof falling from it: the high edge of a single pitch
  verge,         ///< wall with roof, sloping and convex: the edge of a gable
  abutment,      ///< wall with roof, reflex: roof against a wall that rises behind it, level or sloping
  ridge,         ///< roof with roof, level, both falling from it: convex
  hip,           ///< roof with roof, sloping and convex
  valley,        ///< roof with roof, reflex: sloping, or level with both rising from it
  pitch_break,   ///< roof with roof, level, one rising and one falling from it: convex on a mansard, reflex on a
                 ///< bell-cast
  flat_edge,     ///< flat with wall, convex: the outer edge of a terrace or flat roof
  flat_break,    ///< flat with roof, convex: the slopes end in a flat top
  upstand,       ///< flat with wall or roof, reflex: the foot of what stands back from it
  soffit_line,   ///< soffit with wall: reflex over the wall that stands below it, convex under one that goes on above
  seam,          ///< two faces in one plane, where one part of the plan or profile ends and the next begins
};

/// "eave", "mono ridge", …
[[nodiscard]] auto name(LineKind kind) -> std::string_view;

/// One edge of a solid, seen from outside.
struct Line {
  std::uint32_t from = 0, to = 0;  ///< vertices
  std::uint32_t left_face = 0, right_face = 0;
  LineKind kind = LineKind::foot;
  friend auto operator==(const Line&, const Line&) -> bool = default;
};

/// Every edge of the solid once, in the order of its half-edges: each in the direction in which the face of the lower
/// number walks it, or, inside one face, that of the half-edge of the lower number. Reads the faces' kinds and normals.
/// Fails as half_edges() does.
[[nodiscard]] auto lines(const model::Solid& solid) -> base::Result<std::vector<Line>>;

}  // namespace mansard::solid
