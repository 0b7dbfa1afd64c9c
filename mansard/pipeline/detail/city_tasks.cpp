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

auto boxes_of(const model::Scene& scene) -> std::vector<geometry::Box2> {
  std::vector<geometry::Box2> boxes;
  for (std::size_t f = 0; f < scene.footprints.size() + scene.surroundings.size(); ++f)
    boxes.push_back(geometry::bounds(scene.feature(f).polygons));
  return boxes;
}

auto part_of(const model::Scene& scene, const std::vector<const block::Group*>& groups,
             const std::vector<geometry::Box2>& boxes, bool attributes_around) -> Part {
  Part out;
  out.scene.frame = scene.frame;
  out.scene.terrain = scene.terrain;
  std::vector<bool> own(boxes.size(), false);
  std::vector<std::size_t> around;
  geometry::Box2 reach;
  for (const auto* group : groups) {
    reach.include(group->reach);
    for (const std::size_t f : group->features) own[f] = true;
  }
  for (std::size_t f = 0; f < boxes.size(); ++f) {
    if (own[f] && f < scene.footprints.size()) {
      out.features.push_back(f);
      out.scene.footprints.push_back(scene.footprints[f]);
    } else if (!boxes[f].empty() && boxes[f].overlaps(reach)) {
      around.push_back(f);
    }
  }
  for (const std::size_t f : around) {
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
