// Overhanging eaves on the solid of a building.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mansard/geometry/points.hpp"
#include "mansard/model/solid.hpp"

namespace mansard::solid {

/// Eaves above an edge of an outline; the building is on the left of it.
struct Eaves {
  geometry::Point2 from, to;
  double overhang = 0;  ///< m
};

struct WithEaves {
  model::LabelledSolid model;
  std::vector<bool> made;         ///< per wanted one: whether any of it overhangs
  std::vector<std::string> left;  ///< why some are not made, each reason once
};

/// The solid with its roof continued outward and downward over the walls that are wanted, and a level soffit below.
/// Where eaves meet at a corner they have one soffit, and the steeper of the roofs overhangs by less: their drop is the
/// mean of what is wanted. Eaves end in the plane of a gable, or upright across their wall. Guarantees: 1 the result is
/// valid by written_rules() where the solid is · 2 its ground is that of the solid · 3 without its soffits' area, it
/// covers the same plan, with the same heights there · 4 what cannot be made is left out, and the rest is made. Cost: a
/// check() of the solid, and one for each of its eaves where they cannot all be made.
[[nodiscard]] auto with_eaves(const model::LabelledSolid& solid, std::span<const Eaves> wanted) -> WithEaves;

/// The solid without what with_eaves() adds, for the coarser levels of detail: its walls go up to its roofs. The solid
/// itself where it has no soffits, or where nothing valid comes of it.
[[nodiscard]] auto without_eaves(const model::LabelledSolid& solid) -> model::LabelledSolid;

}  // namespace mansard::solid
