// LoD 1.2 of a solid with walls as long as they are straight.
#pragma once

#include "mansard/model/solid.hpp"

namespace mansard::solid {

/// The solid with one flat roof at z: guarantees 1 to 3 of main_roofs(). Walls that are one wall of the solid stay one,
/// which those over the edges of its ground (prism_over_ground) are not. Empty where that cannot be made: over
/// ground at several heights, or where z is not above the ground.
[[nodiscard]] auto flat_roof(const model::LabelledSolid& solid, double z) -> model::LabelledSolid;

}  // namespace mansard::solid
