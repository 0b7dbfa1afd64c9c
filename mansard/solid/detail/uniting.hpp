// The union of the parts of one building, in one attempt.
#pragma once

#include <optional>
#include <span>
#include <string>

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

/// Half-way between the lowest and the highest corner of its roof, m.
[[nodiscard]] auto roof_middle(const model::LabelledSolid& solid) -> double;

}  // namespace mansard::solid::detail
