// The roof that the planes of a scan's points make over a plan.
#pragma once

#include <optional>
#include <vector>

#include "mansard/model/plan.hpp"
#include "mansard/refine/detail/site.hpp"

namespace mansard::refine::detail {

struct SidesByPlanes {
  model::Plan plan;           ///< its cap is the given one's
  std::vector<bool> carries;  ///< per profile whether a plane rises from its sides
};

/// Each side with the plane that rises from it, nearest to it, and a flatter one behind that it meets; a wall where no
/// plane does, up to the mean gutter of the others. So a roof of unlike sides is found at once. None of a scan without
/// points, or where no plane rises from any side. Cost: O(samples · edges).
[[nodiscard]] auto by_planes(const model::Plan& plan, const Site& site, const Options& options)
    -> std::optional<SidesByPlanes>;

}  // namespace mansard::refine::detail
