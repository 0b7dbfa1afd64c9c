// Where a roof may end: candidate heights for the extrusion's cap, from the mesh and the profiles.
#pragma once

#include <span>
#include <vector>
#include "mansard/profile/options.hpp"

namespace mansard::profile::detail {

/// Candidates, the likeliest first: none nearer to an earlier one than cap_distinct, all within `heights` (sorted) and
/// above 0. `tops`: those of the runs' profiles, m. `pitched`: some profile has a roof, whose own closing is likelier
/// than a flat top. With no heights: the profiles' top, or `assumed`.
[[nodiscard]] auto caps_from(std::span<const double> heights, std::span<const double> tops, bool pitched,
                             double assumed, const Options& options = {}) -> std::vector<double>;

}  // namespace mansard::profile::detail
