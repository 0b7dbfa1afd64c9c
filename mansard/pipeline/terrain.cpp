#include "mansard/pipeline/terrain.hpp"

namespace mansard::pipeline {

auto terrain_heights(const model::Scene& scene, const ingest::MeshCells* cells, const geometry::Box2& area,
                     const terrain::Options& options, const base::Run& run) -> base::Result<terrain::Heights> {
  if (scene.terrain) return terrain::heights_of(scene, area, options);
  terrain::MeshGround ground(area, options);
  if (cells != nullptr) {
    for (const auto& cell : cells->cells_in(area)) {
      if (run.cancelled()) return base::error("cancelled", "stopped on request; nothing was written");
      const auto mesh = cells->load({cell});
      if (!mesh) return mesh.failure();
      ground.add(*mesh);
    }
  } else {
    ground.add(scene.mesh);
  }
  std::vector<geometry::Polygon> footprints;
  for (const auto* all : {&scene.footprints, &scene.surroundings})
    for (const auto& footprint : *all)
      if (!footprint.defect) footprints.insert(footprints.end(), footprint.polygons.begin(), footprint.polygons.end());
  return ground.heights(footprints);
}

}  // namespace mansard::pipeline
