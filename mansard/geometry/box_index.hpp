// Which of many boxes overlap a box.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "mansard/geometry/points.hpp"

namespace mansard::geometry {

/// A static binary tree over boxes in plan. Guarantees: 1 every box that overlaps is found, also where they only touch,
/// and no other. Empty boxes overlap nothing. Cost: O(n log n) to make; O(√n + k) for a search with k results where
/// boxes overlap few others.
class BoxIndex {
 public:
  BoxIndex() = default;
  explicit BoxIndex(std::span<const Box2> boxes);

  /// The numbers of all boxes that overlap `box`, ascending.
  [[nodiscard]] auto overlapping(const Box2& box) const -> std::vector<std::uint32_t>;
  /// Of those that are accepted, the `most` least numbers, ascending. Cost: about O(most · log n), however many
  /// overlap, where few are not accepted.
  [[nodiscard]] auto first_overlapping(const Box2& box, std::size_t most,
                                       const std::function<bool(std::uint32_t)>& accept) const
      -> std::vector<std::uint32_t>;

 private:
  struct Node {
    Box2 box;
    std::uint32_t first = 0, last = 0;  ///< of `order_`
    std::uint32_t least = 0;            ///< number below this node
    std::uint32_t right = 0;            ///< the second child, after the first one's nodes; 0 for a leaf
  };
  void divide(std::uint32_t first, std::uint32_t last);

  std::vector<Box2> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;  ///< every one before its children
};

}  // namespace mansard::geometry
