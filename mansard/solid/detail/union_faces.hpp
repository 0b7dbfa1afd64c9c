// The faces of the union of solids whose sheets conform.
#pragma once

#include <string>
#include <vector>

#include "mansard/solid/detail/sheets.hpp"

namespace mansard::solid::detail {

/// A solid, from the sheets' origin and level, or what is wrong with it. `solid_of_face` says which of the solids each
/// face comes from.
struct Union {
  model::LabelledSolid model;
  std::vector<std::uint32_t> solid_of_face;
  std::vector<std::uint8_t> pinned;  ///< by vertex
  std::string why;
};

/// Roofs as they are; walls where one side of a step reaches higher or lower than the other, put together again where
/// they were one wall; ground of one height put together.
[[nodiscard]] auto union_of(const Sheets& sheets, std::span<const model::LabelledSolid* const> parts) -> Union;

/// Takes corners out that lie on a straight line between two faces; cuts faces that are not planar to `planar` metres,
/// or have needles, into pieces that are. False where a face cannot be cut. `level`: corners of one roof alone go into
/// its plane before.
[[nodiscard]] auto finish(Union& made, double planar, bool level = true) -> bool;

}  // namespace mansard::solid::detail
