// Every plane of a raised roof moved to where the looks on its own faces put it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mansard/model/solid.hpp"
#include "mansard/refine/detail/judge.hpp"
#include "mansard/refine/detail/lines.hpp"

namespace mansard::refine::detail {

enum class Used : std::uint8_t {
  all,     ///< every look
  middle,  ///< those that no wall, ridge or gutter is near: scans melt there
};

/// The plan with gutter heights, pitches and knots of its profiles, and its cap, refitted to the faces that they made.
/// Profiles whose refit would fall or lean out stay as they are.
[[nodiscard]] auto refitted(const Judged& judged, const Site& site, const Options& options, Used used = Used::all)
    -> model::Plan;

/// What is seen of the middle of the roof's faces, by profile and by the part of it.
[[nodiscard]] auto middles_of(const Judged& judged, const Site& site, const Options& options)
    -> std::vector<std::vector<std::vector<Look>>>;

/// The profile's part from point i to i + 1 as a line; none for walls.
[[nodiscard]] auto line_of(const model::Profile& profile, std::size_t i) -> std::optional<RoofLine>;

/// m; at the end of a profile that has points. A point that is there already is not repeated.
inline void add_point(model::Profile& profile, double inward, double height) {
  const model::ProfilePoint next{inward, height};
  if (!(next == profile.back())) profile.push_back(next);
}

/// The profile with other lines for its parts, as many as it has, none for walls. A profile is a chain: where its lines
/// were joined they are joined again, walls between them stay where they stand. None where it would fall or lean out.
[[nodiscard]] auto chained(const model::Profile& profile, std::span<const std::optional<RoofLine>> lines)
    -> std::optional<model::Profile>;

/// An edge of a plan.
struct Edge {
  geometry::Point2 start;
  geometry::Point2 inward;  ///< unit
  std::uint32_t profile = 0;
  /// m inward.
  [[nodiscard]] auto to(geometry::Point2 at) const -> double { return dot(at - start, inward); }
};
/// By ring and edge, as a face's provenance has them: the outer ring, then the holes.
[[nodiscard]] auto edges_of(const model::Plan& plan) -> std::vector<std::vector<Edge>>;

}  // namespace mansard::refine::detail
