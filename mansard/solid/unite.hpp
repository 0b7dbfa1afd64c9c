// The solids of a building: the union of its parts, as it is written to files.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mansard/solid/solid.hpp"

namespace mansard::solid {

/// Solids made of parts.
struct United {
  struct One {
    std::vector<std::size_t> of;  ///< the parts in it, rising
    model::LabelledSolid model;
    std::vector<std::uint32_t> part_of_face;  ///< the part that each face comes from
  };
  std::vector<One> solids;                 ///< by their first part
  std::vector<base::Diagnostic> warnings;  ///< what could not be made as asked, without subject
  std::vector<std::size_t> simplified;     ///< parts that became prisms, each a solid of its own
  std::vector<std::size_t> lost;           ///< parts of which there is no valid solid: nothing of them is written
  std::size_t loose = 0;                   ///< solids whose walls may lie off those of their neighbours by rounding
};

/// The union of parts that are vertical walls under a roof, as are those that extrude::raise() makes without
/// overhanging eaves: what one part's wall has behind it of another part goes. Vertices are multiples of 0.1 mm.
/// Guarantees: 1 every solid passes check() by the rules for files, written_rules(); if no valid solid can be made of
/// a part, nor of its ground without what is narrower than 10 cm, it is left out with a warning and among the lost · 2
/// there is one solid for parts that share walls, unless their union is no 2-manifold: then they are joined neighbour
/// by neighbour as far as they can be · 3 the volume is that of the parts within 0.1 mm times their surface, overlaps
/// of parts counted once · 4 the same parts give the same solids. · 5 no two solids share ground. Warnings:
/// "solid-not-united" (parts that touch stay apart, or a part with overhanging eaves stays by itself), "solid-parted"
/// (a part is cut where a higher one stands on its ground, too), "solid-simplified" (a part became a prism, or a solid
/// was cut back from another one), "solid-left-out". Cost: O(n log n) for n edges spread in plan; a group that has no
/// union costs that for every two neighbours.
[[nodiscard]] auto unite(std::span<const model::LabelledSolid* const> parts) -> United;

/// The same for every building of a city, over one plan of each group of buildings that touch: walls of neighbours lie
/// on the same points, so that solids of different buildings share walls exactly, or leave a gap, and overlap only
/// where their parts do by more than 1 mm. A building that has no valid solid over that plan is made by itself. Cost:
/// as unite(), for all parts of a group. With `families`, a number for each of `buildings`, those of one number are
/// layers of one building (stack.hpp), whose solids share no space either.
[[nodiscard]] auto unite_all(std::span<const std::vector<const model::LabelledSolid*>> buildings,
                             std::span<const std::size_t> families = {}) -> std::vector<United>;

/// A solid for each part of one building. Validators compare solids of one building exactly, so that walls that parts
/// share are the same faces in both, piece by piece.
[[nodiscard]] auto unite_each(std::span<const model::LabelledSolid* const> parts) -> std::vector<United>;

/// Whether parts are valid by the rules for files and share their walls exactly already, corner for corner: then
/// unite_each() has nothing to do. Parts with overhanging eaves are only checked for validity.
[[nodiscard]] auto share_walls(std::span<const model::LabelledSolid* const> parts) -> bool;

/// "solid-overlap" of each solid of a building that shares space with one before it, by its place: val3dity's 601.
/// Exact over whole units of files, and surfaces that touch share none. Solids with overhanging eaves are not compared.
struct Overlapping {
  std::size_t solid = 0;
  base::Diagnostic what;
};
[[nodiscard]] auto overlapping(std::span<const model::LabelledSolid* const> solids) -> std::vector<Overlapping>;

/// The ground of a model raised to a flat roof at z. It is based on the corners of the model's ground, and its walls
/// are party walls where the model's are. Empty where z is not above the ground.
[[nodiscard]] auto prism_over_ground(const model::LabelledSolid& model, double z) -> model::LabelledSolid;

/// The same over the outline of all its ground, at the height of the lowest, where gaps and corners that are too narrow
/// for a valid solid are filled, up to 5 cm. Empty where that is not one valid solid.
[[nodiscard]] auto prism_over_outline(const model::LabelledSolid& model, double z) -> model::LabelledSolid;

}  // namespace mansard::solid
