// Models: the scores of the run as it is now, after edits.
#include <algorithm>

#include "apps/server/models.hpp"

namespace mansard::server {

auto Models::measured(const std::vector<std::string>& blocks, const SceneOrNone& scene) -> base::Result<Measured> {
  const std::scoped_lock lock(measured_mutex_);
  if (measured_with_ != scene) measured_.clear();
  measured_with_ = scene;
  const auto now = view();
  Measured out;
  out.applied = now->applied;
  for (const auto& name : blocks) {
    const auto* block = scene->block_named(name);
    if (block == nullptr)
      return base::error("server-unknown", "the scene has no such block any more: read the inputs of the run again",
                         name);
    std::vector<std::shared_ptr<const Seen>> buildings;
    std::vector<geometry::Polygon> footprints;
    std::shared_ptr<const rays::Scene> mesh;
    for (const auto& member : block->members) {
      const auto& id = scene->scene().feature(member.feature).id;
      footprints.insert(footprints.end(), member.polygons.begin(), member.polygons.end());
      if (mesh == nullptr) mesh = scene->rays_of(id);
      if (const auto at = index_.find(id); at != index_.end()) buildings.push_back(now->buildings[at->second]);
    }
    auto& known = measured_[name];
    if (known.comparison == nullptr || known.buildings != buildings) {
      std::vector<model::LabelledSolid> models;
      for (const auto& building : buildings) {
        const auto made = this->made(index_.find(building->id)->second, *now);
        models.insert(models.end(), made->models.begin(), made->models.end());
      }
      known.comparison = mesh == nullptr ? std::make_shared<const evaluate::Comparison>()
                                         : std::make_shared<const evaluate::Comparison>(evaluate::compare(
                                               models, *mesh, footprints, block->ground, options_.evaluate));
      known.buildings = std::move(buildings);
    }
    out.blocks.push_back(known.comparison);
  }
  return out;
}

}  // namespace mansard::server
