// The work on a city, in pieces that memory can hold.
#pragma once

#include <cstddef>
#include <vector>

#include "mansard/block/block.hpp"
#include "mansard/model/scene.hpp"

namespace mansard::pipeline::detail {

/// In an order in which neighbours are mostly near each other.
[[nodiscard]] auto by_place(const std::vector<block::Group>& groups) -> std::vector<const block::Group*>;

/// Of every feature; empty where it has no polygon.
[[nodiscard]] auto boxes_of(const model::Scene& scene) -> std::vector<geometry::Box2>;

/// Some groups of a scene as a scene of their own, without a mesh.
struct Part {
  model::Scene scene;
  std::vector<std::size_t> features;  ///< of the whole, by the numbers of the part
};
/// The features of the groups, and as surroundings what their blocks may depend on; these without attributes unless
/// asked for.
[[nodiscard]] auto part_of(const model::Scene& scene, const std::vector<const block::Group*>& groups,
                           const std::vector<geometry::Box2>& boxes, bool attributes_around) -> Part;

}  // namespace mansard::pipeline::detail
