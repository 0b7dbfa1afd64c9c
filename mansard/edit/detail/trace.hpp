// Outlines from loose edges: what split and merge have in common.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/geometry/points.hpp"
#include "mansard/model/plan.hpp"

namespace mansard::edit::detail {

inline constexpr double snap = 0.01;        ///< m; what lies this near to an outline is taken to be on it
inline constexpr double least_area = 0.01;  ///< m²; less is no part, no hole and no overlap

/// A directed edge with the interior on its left; `label` is the caller's, kept.
struct Edge {
  geometry::Point2 from, to;
  std::uint32_t label = 0;
};

/// Indices of edges, each beginning where the one before ends.
using Cycle = std::vector<std::size_t>;

/// Goes from every edge to the sharpest turn to the left at its end, so that every cycle has nothing but interior on
/// its left. By first edge. Nothing where an end has no edge that goes on.
[[nodiscard]] auto cycles_of(std::span<const Edge> edges) -> std::optional<std::vector<Cycle>>;

/// The cycle's points; the labels of its edges are in `profile_of_edge`.
[[nodiscard]] auto ring_of(std::span<const Edge> edges, const Cycle& cycle) -> model::PlanRing;

struct Outline {
  model::PlanRing outer;
  std::vector<model::PlanRing> holes;
};
/// Cycles that run counter-clockwise with those clockwise ones that lie in them. Nothing where a hole lies nowhere.
[[nodiscard]] auto outlines_of(std::span<const Edge> edges, const std::vector<Cycle>& cycles)
    -> std::optional<std::vector<Outline>>;

/// The outline as a plan; its labels are indices into `profiles`, of which those in use are kept, in their order.
[[nodiscard]] auto plan_of(Outline outline, const std::vector<model::Profile>& profiles, double base, double cap)
    -> model::Plan;

/// Gives the edges of a plan the overhangs of those edges of others that their middles are on.
void keep_overhangs(std::span<const model::Plan* const> from, model::Plan& plan);

/// The edges of all rings of the plan, labelled by their profiles.
[[nodiscard]] auto edges_of(const model::Plan& plan) -> std::vector<Edge>;

/// The edges with corners at the points on each of them, in whatever order; the pieces keep their edge's label.
[[nodiscard]] auto broken_at(std::span<const Edge> edges, std::vector<std::vector<geometry::Point2>> on)
    -> std::vector<Edge>;

/// m²; of what two polygons share once a centimetre is taken off all around. Fails with "geometry-boolean".
[[nodiscard]] auto overlap(const geometry::Polygon& a, const geometry::Polygon& b) -> base::Result<double>;

}  // namespace mansard::edit::detail
