#include "mansard/pipeline/detail/city_tasks.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/pipeline/detail/every_block.hpp"

namespace mansard::pipeline::detail {

auto by_place(const std::vector<block::Group>& groups) -> std::vector<const block::Group*> {
  std::vector<const block::Group*> out;
  for (const auto& group : groups) out.push_back(&group);
  std::ranges::stable_sort(out, {}, [](const block::Group* group) {
    return along_curve(std::llround(group->box.least.x), std::llround(group->box.least.y));
  });
  return out;
}

auto in_tasks(std::span<const block::Group* const> groups, std::size_t most_features)
    -> std::vector<std::span<const block::Group* const>> {
  std::vector<std::span<const block::Group* const>> out;
  std::size_t first = 0, features = 0;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (i > first && features + groups[i]->features.size() > most_features) {
      out.push_back(groups.subspan(first, i - first));
      first = i;
      features = 0;
    }
    features += groups[i]->features.size();
  }
  if (first < groups.size()) out.push_back(groups.subspan(first));
  return out;
}

auto index_of(const model::Scene& scene) -> geometry::BoxIndex {
  std::vector<geometry::Box2> boxes;
  boxes.reserve(scene.footprints.size() + scene.surroundings.size());
  for (std::size_t f = 0; f < scene.footprints.size() + scene.surroundings.size(); ++f)
    boxes.push_back(geometry::bounds(scene.feature(f).polygons));
  return geometry::BoxIndex(boxes);
}

auto part_of(const model::Scene& scene, std::span<const block::Group* const> groups, const geometry::BoxIndex& index,
             bool attributes_around) -> Part {
  Part out;
  out.scene.frame = scene.frame;
  out.scene.terrain = scene.terrain;
  // Group by group: the box of several may span the city where the order by place jumps.
  std::vector<std::size_t> own, near;
  for (const auto* group : groups) {
    own.insert(own.end(), group->features.begin(), group->features.end());
    const auto found = index.overlapping(group->reach);
    near.insert(near.end(), found.begin(), found.end());
  }
  std::ranges::sort(own);
  std::ranges::sort(near);
  near.erase(std::unique(near.begin(), near.end()), near.end());
  for (const std::size_t f : own) {
    if (f >= scene.footprints.size()) continue;
    out.features.push_back(f);
    out.scene.footprints.push_back(scene.footprints[f]);
  }
  for (const std::size_t f : near) {
    if (f < scene.footprints.size() && std::ranges::binary_search(own, f)) continue;
    const auto& feature = scene.feature(f);
    model::Footprint shape;
    shape.id = feature.id;
    shape.polygons = feature.polygons;
    if (attributes_around) shape.attributes = feature.attributes;
    out.features.push_back(f);
    out.scene.surroundings.push_back(std::move(shape));
  }
  return out;
}

}  // namespace mansard::pipeline::detail
