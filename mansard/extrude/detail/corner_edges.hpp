// Corner edges in the kernel: apart from the outline until it is canonical, then exactly at its corners.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "mansard/extrude/detail/footprint.hpp"

namespace mansard::extrude::detail {

/// Whether a direction is that of a corner edge between two edges; all unit vectors.
[[nodiscard]] auto lies_between(geometry::Point2 before, geometry::Point2 along, geometry::Point2 after) -> bool;
/// The ends of a corner edge between two edges that meet at a corner; directions are unit vectors.
[[nodiscard]] auto ends_at(geometry::Point2 corner, geometry::Point2 before, geometry::Point2 along,
                           geometry::Point2 after) -> std::pair<geometry::Point2, geometry::Point2>;
/// Puts an edge with these ends in the place of a corner.
void insert(model::PlanRing& ring, std::size_t corner, std::pair<geometry::Point2, geometry::Point2> ends,
            std::uint32_t profile, double overhang = 0);

/// Takes the corner edges off a ring; its edges meet at the corners instead.
[[nodiscard]] auto without_corner_edges(SourceRing& ring, std::size_t number) -> std::vector<CornerEdge>;

/// The footprint with the corner edges of its source: each at the nearest corner within `tolerance`, a micrometre
/// inside of it. Those without such a corner, or whose direction is not between those of its edges any more, are left
/// out.
[[nodiscard]] auto with_corner_edges(const Footprint& footprint, const Source& source, const Options& options)
    -> Footprint;

/// A ring of a plan made from that of a footprint, corner for corner, with the corner edges that the source had there.
void put_corner_edges(model::PlanRing& made, const model::PlanRing& given, const Footprint& footprint, std::size_t ring,
                      const Source& source, const Options& options);

}  // namespace mansard::extrude::detail
