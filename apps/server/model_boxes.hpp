// Bounding boxes and hashes of buildings: shared by models.cpp and its siblings.
#pragma once

#include <string>
#include <vector>

#include "mansard/edit/edit.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::server {

[[nodiscard]] inline auto box_of(const std::vector<edit::NamedPlan>& parts) -> geometry::Box2 {
  geometry::Box2 box;
  for (const auto& part : parts) box.include(geometry::Box2::of(part.plan.outer.points));
  return box;
}

/// Hash of the plans of a building.
[[nodiscard]] auto hash_of(const std::vector<edit::NamedPlan>& parts) -> std::string;

/// Whether two boxes are so close that the buildings in them may share a party wall or overlap.
[[nodiscard]] inline auto touch(const geometry::Box2& a, const geometry::Box2& b) -> bool {
  constexpr double margin = 1.0;  // m
  return a.least.x <= b.most.x + margin && b.least.x <= a.most.x + margin && a.least.y <= b.most.y + margin &&
         b.least.y <= a.most.y + margin;
}

}  // namespace mansard::server
