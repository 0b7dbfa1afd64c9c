// Follows one vertical section of the mesh up a building's wall and roof, and down to the ground.
// Reference: the paper's "Assigning Profiles as a Postprocess", Figure 4 a and b.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mansard/profile/detail/section_index.hpp"

namespace mansard::profile::detail {

struct ClimbOptions {
  double step = 1.0;        ///< m; goes on to a piece this near
  double jump = 3.0;        ///< m; failing that, to one this near
  double low_height = 2.0;  ///< m above ground; walls are looked for above
  double ground = 0;        ///< z, metres
  double near = 1.5;        ///< m; the climb starts this near to the foot
};

/// A raw profile: never decreasing in height, from the lowest point reached to the highest; `height` is z.
struct Climb {
  std::vector<SectionPoint> points;
  [[nodiscard]] auto top() const -> double { return points.back().height; }
};

/// Starts at the wall near the foot, or where the scan shows none at the first roof piece inward. Nothing when there is
/// nothing above the ground near the foot.
[[nodiscard]] auto climb(std::span<const Piece> pieces, const ClimbOptions& options) -> std::optional<Climb>;

/// The wall's median distance inward of the foot, by length; metres. Nothing when the climb shows no metre of wall.
[[nodiscard]] auto wall_position(const Climb& climb, const ClimbOptions& options, double vertical_angle)
    -> std::optional<double>;

}  // namespace mansard::profile::detail
