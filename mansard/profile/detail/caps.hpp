// Where a roof may end: candidate heights for the extrusion's cap, from the mesh and the profiles.
#pragma once

#include <span>
#include <vector>
#include "mansard/profile/options.hpp"

namespace mansard::profile::detail {

/// The top of one run's profile and how long the run is, metres.
struct ProfileTop {
  double height = 0, length = 0;
};

/// Candidates, the likeliest first: none nearer to an earlier one than cap_distinct, all within `heights` (sorted) and
/// above 0. `pitched`: some profile has a roof, whose own closing is likelier than a flat top. With no heights: the
/// profiles' top, or `assumed`.
[[nodiscard]] auto caps_from(std::span<const double> heights, std::vector<ProfileTop> tops, bool pitched,
                             double assumed, const Options& options = {}) -> std::vector<double>;

}  // namespace mansard::profile::detail
