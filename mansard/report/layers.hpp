// Layers for a GIS: why walls were drawn, and what went otherwise than it should.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mansard/formats/layers.hpp"
#include "mansard/report/report.hpp"

namespace mansard::report {

/// Why a wall was drawn or not, as layers for formats::geopackage: gis_footprints, sweep_edges, faces, edges,
/// conflicts, footprints, made_by. Their fields are listed in docs/report.md. Heights are z of the file frame.
/// `buildings`: what was made of the blocks; where there are any, the layers tell what became of each wall.
[[nodiscard]] auto segment_layers(const model::Scene& scene, const std::vector<SegmentedBlock>& blocks,
                                  const model::MadeBy& made_by, std::span<const model::Building> buildings = {})
    -> std::vector<formats::Layer>;

/// What went otherwise than it should, as one more layer: `diagnostics`, a row per reason of a building and per
/// warning. `reconstruction` must be of the whole scene.
[[nodiscard]] auto diagnostics_layer(const Reconstruction& reconstruction, const model::Scene& scene) -> formats::Layer;

/// Solids that share ground, as one more layer: `overlaps`, a row for each two of them. None where there are none.
[[nodiscard]] auto overlaps_layer(const Summary& summary) -> std::optional<formats::Layer>;

}  // namespace mansard::report
