// LoD 1.2 of a solid, and the levels between it and LoD 2.2.
#pragma once

#include "mansard/formats/cityjson/quantised.hpp"
#include "mansard/formats/detail/drawn.hpp"
#include "mansard/formats/levels.hpp"
#include "mansard/model/attributes.hpp"

namespace mansard::formats::detail {

/// LoD 1.2 of a solid, with a flat roof at `top`. Over ground at several heights it is the union of a prism on each;
/// where that is not one valid solid, all stand at the lowest, and then over an outline without what is too narrow for
/// one. Empty where none of these is valid.
[[nodiscard]] auto flat_model(const model::LabelledSolid& model, const std::vector<Surface>& fine, double top)
    -> std::vector<Surface>;

/// z of the flat roof of LoD 1.2: the 70th percentile of the roof's heights where it was measured and lies within the
/// model, else half-way between the lowest and the highest point of the roof. From what is written rather than from
/// the model, so that what was read back gives the same. `origin`: z of the frame, m.
[[nodiscard]] auto roof_height(const std::vector<Surface>& surfaces, const model::Attributes& attributes,
                               std::int64_t origin) -> double;

/// The corners of surfaces on the grid, as a solid.
[[nodiscard]] auto solid_of(const std::vector<Surface>& surfaces) -> model::LabelledSolid;

/// The surfaces of a solid at the levels that are wanted; no surfaces at the others. A solid that is not the only one
/// of its building keeps every corner of its ground at all levels: on a wall that it shares with another one, a corner
/// that only one of them has would make them overlap by rounding.
struct LevelSurfaces {
  std::vector<Surface> lod12, lod13, lod20, lod22;
  [[nodiscard]] auto at(Lod lod) const -> const std::vector<Surface>&;
};
[[nodiscard]] auto level_surfaces(const model::LabelledSolid& model, const model::Attributes& attributes,
                                  const model::Frame& frame, const Lods& wanted, const solid::LevelOptions& options,
                                  bool alone) -> LevelSurfaces;
/// The same of all solids of a building. Of solids above each other, a flat roof of the lower one could reach into the
/// higher one: two that share space at a coarser level are as at LoD 2.2 there.
[[nodiscard]] auto level_surfaces(const Drawn& drawn, const model::Frame& frame, const Lods& wanted,
                                  const solid::LevelOptions& options) -> std::vector<LevelSurfaces>;

/// Solids at another level of detail. One that has no valid solid there stays as it is.
struct LevelOf {
  Lod lod = Lod::lod22;
  solid::LevelOptions options;
  [[nodiscard]] static auto of(const WriteOptions& options, Format format) -> base::Result<LevelOf>;
  void apply(Drawn& drawn, const model::Frame& frame) const;
};

}  // namespace mansard::formats::detail
