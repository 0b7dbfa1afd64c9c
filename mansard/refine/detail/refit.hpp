// Every plane of a raised roof moved to where the looks on its own faces put it.
#pragma once

#include <cstdint>

#include "mansard/refine/detail/judge.hpp"

namespace mansard::refine::detail {

enum class Used : std::uint8_t {
  all,     ///< every look
  middle,  ///< those that no wall, ridge or gutter is near: scans melt there
};

/// The plan with gutter heights, pitches and knots of its profiles, and its cap, refitted to the faces that they made.
/// Profiles whose refit would fall or lean out stay as they are.
[[nodiscard]] auto refitted(const Judged& judged, const Site& site, const Options& options, Used used = Used::all)
    -> model::Plan;

}  // namespace mansard::refine::detail
