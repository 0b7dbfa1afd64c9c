// From lots and plans to a city of labelled solids.
#pragma once

#include <vector>

#include "lab/simulate/detail/lots.hpp"

namespace mansard::simulate::detail {

/// One outline of polygons that touch. Seams are closed by a centimetre and opened again.
[[nodiscard]] auto outline_of(const std::vector<geometry::Polygon>& parts)
    -> base::Result<std::vector<geometry::Polygon>>;

/// A building without models yet, and the solids of its parts.
struct Raised {
  model::Building building;
  std::vector<model::Solid> solids;
};

/// Fails with "simulate-solid" where a lot cannot be extruded in full.
[[nodiscard]] auto raise_house(const House& house, const base::Run& run) -> base::Result<Raised>;

/// A building of plans as they are, with the outline of those that stand on the ground where it has none. Fails as
/// extrude::raise.
[[nodiscard]] auto raise_again(model::Building building, const base::Run& run) -> base::Result<Raised>;

/// All solids labelled, all party walls found.
[[nodiscard]] auto truth_over(std::vector<Raised> buildings, const base::Run& run) -> Truth;

}  // namespace mansard::simulate::detail
