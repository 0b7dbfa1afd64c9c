// Coarser levels of detail of a building's solid.
#pragma once

#include <span>

#include "mansard/base/options.hpp"
#include "mansard/model/solid.hpp"

namespace mansard::solid {

/// What the coarser levels of detail leave out.
struct LevelOptions {
  double lod13_step = 3;          ///< m; LoD 1.3 joins adjacent roofs that differ by less, LoD 2.0 fills small recesses
  double lod20_structure = 10;    ///< m²; LoD 2.0 leaves out roof structures with a smaller area in plan
  double lod20_surrounded = 0.5;  ///< share of its outline that a roof around it must touch, so that it is left out
};
[[nodiscard]] auto option_list(LevelOptions& options) -> base::OptionList;

/// LoD 2.0: the solid without dormers, chimneys and other small structures on its roofs and recesses in them, but for
/// light wells; the planes around each are continued over it. Guarantees: 1 the result is valid by written_rules()
/// where the solid is · 2 it has the same ground, so that solids that did not overlap do not overlap now · 3 it has no
/// more faces · 4 where that cannot be made, nothing is left out: the solid itself. Eaves do not overhang
/// (without_eaves). Solids with ground at several heights are returned as they are. Cost: O(n log n) for n edges, once
/// for structures on the roof and once for those on these.
[[nodiscard]] auto main_roofs(const model::LabelledSolid& solid, const LevelOptions& options = {})
    -> model::LabelledSolid;

/// LoD 1.3: every piece of roof that a step separates from the others is flat, at the height below which 70 % of its
/// area lies. Guarantees 1 to 3 of main_roofs(). Empty where there is one piece only, and where no valid solid can be
/// made: LoD 1.3 is LoD 1.2 there. Cost: as main_roofs().
[[nodiscard]] auto flat_pieces(const model::LabelledSolid& solid, const LevelOptions& options = {})
    -> model::LabelledSolid;

/// z below which that share of a roof's area in plan lies, exactly for plane triangles; 0 without roof.
[[nodiscard]] auto roof_percentile(const model::LabelledSolid& solid, double share) -> double;

/// The codes of val3dity (H. Ledoux, 2018) that the findings of check() stand for, rising, each once.
[[nodiscard]] auto val3dity_codes(std::span<const base::Diagnostic> findings) -> std::vector<int>;

}  // namespace mansard::solid
