// Solids that share ground, and what is left of those that have to give way.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mansard/geometry/polygon.hpp"
#include "mansard/model/solid.hpp"

namespace mansard::solid::detail {

/// Whether two solids share any area of ground at a common height, in whole units of files, exactly: validators find
/// that they intersect then. Where that cannot be computed they do. Solids with overhanging eaves are not compared.
[[nodiscard]] auto share_ground(const model::LabelledSolid& a, const model::LabelledSolid& b) -> bool;

/// Roof and ground of a solid over a part of its plan, and those of its walls that bound it still: not closed, but all
/// that a union needs. `over` in whole units of files. None where nothing is left.
[[nodiscard]] auto clipped(const model::LabelledSolid& solid, std::span<const geometry::Polygon> over)
    -> std::optional<model::LabelledSolid>;

/// What clipped() leaves of a solid when the ground of others is taken off, and of what is `gap` units around it.
/// None where nothing is left, or it cannot be computed.
[[nodiscard]] auto without(const model::LabelledSolid& solid, std::span<const model::LabelledSolid* const> others,
                           double gap) -> std::optional<model::LabelledSolid>;

/// Solids that share ground with higher ones, without it: of each, its new shape, and whether it has one. The others
/// stay as they are.
struct Parted {
  std::vector<std::optional<model::LabelledSolid>> changed;
  std::vector<bool> gone;
  bool any = false;
};
[[nodiscard]] auto parted(std::span<const model::LabelledSolid* const> solids) -> Parted;

}  // namespace mansard::solid::detail
