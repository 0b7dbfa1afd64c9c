// The union of the parts of one building, in one attempt.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mansard/solid/detail/sheets.hpp"
#include "mansard/solid/unite.hpp"

namespace mansard::solid::detail {

/// How a union is made: points nearer than `near` quanta become one, and what stays a solid of its own is its part as
/// it is or, with `prisms`, a prism over the plan of all.
struct Reach {
  std::int64_t near = model::least_apart;
  bool prisms = false;
  bool corners = true;  ///< whether corners are cut where solids would meet in an vertical line only
};

/// Over the plan of the parts and their neighbours where one is given; else of the parts alone. No two of the solids
/// that it makes of several parts, or of one, share ground; those that could not be joined may.
[[nodiscard]] auto united_by(std::span<const model::LabelledSolid* const> parts, const Reach& reach,
                             std::optional<Sheets> plan = std::nullopt) -> United;

/// The ground of a part of which no valid solid can be made, raised to half-way between its lowest and its highest roof
/// corner: its outline closed, or else opened, where it is narrower than 4 mm, 2 cm or 10 cm. Valid solids; none where
/// that helps nothing, or changes its area by more than 1 %.
[[nodiscard]] auto prisms_without_narrow_places(const model::LabelledSolid& part) -> std::vector<model::LabelledSolid>;

/// Half-way between the lowest and the highest corner of its roof, m.
[[nodiscard]] auto roof_middle(const model::LabelledSolid& solid) -> double;

}  // namespace mansard::solid::detail
