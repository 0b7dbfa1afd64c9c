#include "mansard/pipeline/inputs.hpp"

namespace mansard::pipeline {

auto read_inputs(const InputPaths& paths, const Options& options, const base::Run& run) -> base::Result<model::Scene> {
  if (paths.footprints.empty() != paths.derive_footprints)
    return base::error("pipeline-footprints",
                       paths.derive_footprints
                           ? "footprints are given, and are to be drawn from the mesh too; leave one of the two"
                           : "there are no footprints; give some, or have them drawn from the mesh with "
                             "--derive-footprints",
                       paths.footprints.string());
  auto scene = ingest::read_scene(paths.meshes, paths.footprints, options.ingest, run);
  if (!scene || !paths.derive_footprints) return scene;
  auto derived = derive::footprints(*scene, options.derive, run);
  if (!derived) return derived.failure();
  scene->footprints = std::move(derived->footprints);
  scene->warnings.insert(scene->warnings.end(), derived->warnings.begin(), derived->warnings.end());
  return scene;
}

auto read_city_inputs(const InputPaths& paths, const Options& options, const base::Run& run)
    -> base::Result<ingest::CityScene> {
  if (!paths.footprints.empty() && !paths.derive_footprints)
    return ingest::read_city(paths.meshes, paths.footprints, options.ingest, run);
  auto scene = read_inputs(paths, options, run);
  if (!scene) return scene.failure();
  return ingest::CityScene{std::move(*scene), nullptr};
}

}  // namespace mansard::pipeline
