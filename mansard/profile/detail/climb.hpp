// Follows one vertical section of the mesh up a building's wall and roof, and down to the ground.
// Reference: the paper's "Assigning Profiles as a Postprocess", Figure 4 a and b.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mansard/profile/detail/section_index.hpp"
#include "mansard/profile/options.hpp"

namespace mansard::profile::detail {

/// A raw profile: never decreasing in height, from the lowest point reached to the highest; `height` is z.
struct Climb {
  std::vector<SectionPoint> points;
};

/// `ground`: z, metres. Starts at the wall near the foot, or where the scan shows none at the first roof piece inward.
/// Nothing when there is nothing above the ground near the foot.
[[nodiscard]] auto climb(std::span<const Piece> pieces, const Options& options, double ground = 0)
    -> std::optional<Climb>;

/// The wall's median distance inward of the foot, by length; metres. Nothing when the climb shows no wall_minimum of
/// wall.
[[nodiscard]] auto wall_position(const Climb& climb, const Options& options) -> std::optional<double>;

}  // namespace mansard::profile::detail
