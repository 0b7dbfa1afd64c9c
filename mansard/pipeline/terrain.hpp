// What the terrain around models is made from.
#pragma once

#include "mansard/ingest/ingest.hpp"
#include "mansard/terrain/terrain.hpp"

namespace mansard::pipeline {

/// Heights of the ground over an area: of the scene's terrain where it has one, else found in its mesh, in memory or in
/// cells. Fails with "terrain-no-ground", "file-write", "cancelled".
[[nodiscard]] auto terrain_heights(const model::Scene& scene, const ingest::MeshCells* cells,
                                   const geometry::Box2& area, const terrain::Options& options,
                                   const base::Run& run = {}) -> base::Result<terrain::Heights>;

}  // namespace mansard::pipeline
