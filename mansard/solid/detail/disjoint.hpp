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
/// that they intersect then. Of solids whose bases are at different heights, whether the lower one reaches the base of
/// the other one where they share ground. Where that cannot be computed they do. Solids with overhanging eaves are not
/// compared.
[[nodiscard]] auto share_ground(const model::LabelledSolid& a, const model::LabelledSolid& b) -> bool;

/// The same, or their walls pass through each other: by rounding, a wall that is not on shared corners leans a little,
/// and one around a corner that another solid has, too, does not keep to it. Exact, as insides_meet(); or
/// it is chance whether they do, by touch_by_chance().
[[nodiscard]] auto overlap(const model::LabelledSolid& a, const model::LabelledSolid& b) -> bool;

/// Of each solid the others whose boxes in plan meet its own, ascending: no others can share ground or overlap.
/// Cost: O(n log n) where few do.
[[nodiscard]] auto near_each(std::span<const model::LabelledSolid* const> solids)
    -> std::vector<std::vector<std::uint32_t>>;

/// Whether there is ground wider than two points that become one, `near` units apart.
[[nodiscard]] auto wider_than_points(const model::LabelledSolid& solid, double near) -> bool;

/// Roof and ground of a solid over a part of its plan, and those of its walls that bound it still: not closed, but all
/// that a union needs. `over` in whole units of files. None where nothing is left.
[[nodiscard]] auto clipped(const model::LabelledSolid& solid, std::span<const geometry::Polygon> over)
    -> std::optional<model::LabelledSolid>;

/// What is left of a solid, and why it is nothing: because others cover it, or because it cannot be computed.
struct Rest {
  std::optional<model::LabelledSolid> solid;
  bool failed = false;
};

/// What clipped() leaves of a solid when the ground of others is taken off, and of what is `gap` units around it.
[[nodiscard]] auto without(const model::LabelledSolid& solid, std::span<const model::LabelledSolid* const> others,
                           double gap) -> Rest;

/// Solids that share ground with others, without it: of each, its new shape where it has one, and whether others cover
/// it. The rest stay as they are. The higher of two keeps what they share, as the height of a union is the greater of
/// both; but those that are `firm` keep theirs before all others.
struct Parted {
  std::vector<std::optional<model::LabelledSolid>> changed;
  std::vector<bool> covered;
  std::vector<bool> failed;  ///< it shares ground still: taking that off cannot be computed
  bool any = false;
};
/// `Shared::wide` leaves what is as narrow as what becomes one point: the rounding of walls that two have in common.
enum class Shared { any, wide };
[[nodiscard]] auto parted(std::span<const model::LabelledSolid* const> solids, const std::vector<bool>& firm,
                          Shared shared) -> Parted;

}  // namespace mansard::solid::detail
