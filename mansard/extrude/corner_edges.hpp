// Edges of no extent at the corners of a plan: they give a roof plane a direction that no wall has.
//
//   o--.      An edge's roof rises across the edge. Where a side is not parallel to the ridge, its wall goes up to the
//   |   `--+  roof (a profile that is wall alone), and the roof rises from an edge at one of its corners, o, whose
//   |      |  direction is that of the roof's eaves. The edge is shorter than a millimetre: no wall of it is seen,
//   +------+  and in the solid it is a corner like any other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "mansard/geometry/polygon.hpp"
#include "mansard/model/plan.hpp"

namespace mansard::extrude {

/// m; a shorter edge is a corner edge, where is_corner_edge() holds. The kernel's own are a micrometre from the corner,
/// and what is shorter than this in the solid is drawn together (Options::short_arc).
inline constexpr double longest_corner_edge = 1e-3;

/// Whether an edge is a corner edge: shorter than that, between two edges that are not, and its direction between
/// theirs, at a corner that turns to the inside by at most 150°, at least half a degree away from both.
[[nodiscard]] auto is_corner_edge(const geometry::Ring& ring, std::size_t edge) -> bool;

/// Which edges of a ring are.
[[nodiscard]] auto corner_edges_of(const geometry::Ring& ring) -> std::vector<bool>;

/// The ring with a corner edge at one of its corners, of a direction (unit), that carries a profile. None where that
/// would be no corner edge. Edges from the corner on have numbers one higher.
[[nodiscard]] auto with_corner_edge(const model::PlanRing& ring, std::size_t corner, geometry::Point2 along,
                                    std::uint32_t profile) -> std::optional<model::PlanRing>;

/// The plan with plain corners in their place, for another roof.
[[nodiscard]] auto without_corner_edges(model::Plan plan) -> model::Plan;

/// Where two lines meet at a corner; the corner of a corner edge.
[[nodiscard]] auto corner_at(const geometry::Ring& ring, std::size_t corner_edge) -> geometry::Point2;

}  // namespace mansard::extrude
