// The work on a city, in pieces that memory can hold.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "mansard/block/block.hpp"
#include "mansard/geometry/box_index.hpp"
#include "mansard/model/scene.hpp"

namespace mansard::pipeline::detail {

/// In an order in which neighbours are mostly near each other: along a curve through the plane of the file's
/// coordinates, so that it does not change with the frame of a scene.
[[nodiscard]] auto by_place(const std::vector<block::Group>& groups, const model::Frame& frame)
    -> std::vector<const block::Group*>;

/// Groups that are worked on together.
struct Task {
  std::span<const block::Group* const> groups;
  std::string name;  ///< the cell of the plane that it is made of: its lower left corner and its size, whole metres
};
/// The same order in pieces, each of groups with at most so many features together, or of one group with more. The
/// plane is halved until the groups of each half are few enough: a group more or less changes its own piece only, or
/// halves it, or joins it with the one beside it.
[[nodiscard]] auto in_tasks(std::span<const block::Group* const> groups, std::size_t most_features,
                            const model::Frame& frame) -> std::vector<Task>;

/// Which of a scene's features are near a box. Features without polygons are near nothing.
[[nodiscard]] auto index_of(const model::Scene& scene) -> geometry::BoxIndex;

/// Some groups of a scene as a scene of their own, without a mesh.
struct Part {
  model::Scene scene;
  std::vector<std::size_t> features;  ///< of the whole, by the numbers of the part
};
/// The features of the groups, and as surroundings what their blocks may depend on; these without attributes unless
/// asked for. Cost: that of the features near the groups, however many others the scene has.
[[nodiscard]] auto part_of(const model::Scene& scene, std::span<const block::Group* const> groups,
                           const geometry::BoxIndex& index, bool attributes_around) -> Part;

}  // namespace mansard::pipeline::detail
