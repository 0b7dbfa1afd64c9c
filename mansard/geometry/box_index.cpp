#include "mansard/geometry/box_index.hpp"

#include <algorithm>
#include <queue>
#include <utility>

namespace mansard::geometry {
namespace {

constexpr std::uint32_t leaf_size = 8;  // boxes; a compromise of memory and comparisons

}  // namespace

BoxIndex::BoxIndex(std::span<const Box2> boxes) : boxes_(boxes.begin(), boxes.end()) {
  for (std::uint32_t i = 0; i < boxes_.size(); ++i)
    if (!boxes_[i].empty()) order_.push_back(i);
  if (!order_.empty()) divide(0, static_cast<std::uint32_t>(order_.size()));
}

void BoxIndex::divide(std::uint32_t first, std::uint32_t last) {
  const auto number = nodes_.size();
  Node node{{}, first, last, order_[first], 0};
  Box2 centres;
  for (auto i = first; i < last; ++i) {
    const Box2& box = boxes_[order_[i]];
    node.box.include(box);
    node.least = std::min(node.least, order_[i]);
    centres.add(0.5 * (box.least + box.most));
  }
  nodes_.push_back(node);
  if (last - first <= leaf_size) return;
  const Point2 extent = centres.most - centres.least;
  const auto middle = first + (last - first) / 2;
  // Boxes at one place are divided by number, so that the least numbers are together.
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                   [&, along_x = extent.x >= extent.y](std::uint32_t a, std::uint32_t b) {
                     const Point2 at = boxes_[a].least + boxes_[a].most, to = boxes_[b].least + boxes_[b].most;
                     return along_x ? std::pair(at.x, a) < std::pair(to.x, b) : std::pair(at.y, a) < std::pair(to.y, b);
                   });
  divide(first, middle);
  nodes_[number].right = static_cast<std::uint32_t>(nodes_.size());
  divide(middle, last);
}

auto BoxIndex::overlapping(const Box2& box) const -> std::vector<std::uint32_t> {
  std::vector<std::uint32_t> found;
  if (nodes_.empty() || box.empty()) return found;
  std::vector<std::uint32_t> open{0};
  while (!open.empty()) {
    const auto at = open.back();
    const Node& node = nodes_[at];
    open.pop_back();
    if (!node.box.overlaps(box)) continue;
    if (node.right != 0) {
      open.push_back(at + 1);
      open.push_back(node.right);
      continue;
    }
    for (auto i = node.first; i < node.last; ++i)
      if (boxes_[order_[i]].overlaps(box)) found.push_back(order_[i]);
  }
  std::ranges::sort(found);
  return found;
}

auto BoxIndex::first_overlapping(const Box2& box, std::size_t most,
                                 const std::function<bool(std::uint32_t)>& accept) const -> std::vector<std::uint32_t> {
  // Nodes and boxes by their least number: a box that is taken before all nodes with lesser numbers is the next one.
  struct Entry {
    std::uint32_t least = 0, node = 0;
    bool is_box = false;
  };
  const auto later = [](const Entry& a, const Entry& b) {
    return std::pair(a.least, a.is_box) > std::pair(b.least, b.is_box);
  };
  std::vector<std::uint32_t> found;
  if (nodes_.empty() || box.empty()) return found;
  std::priority_queue<Entry, std::vector<Entry>, decltype(later)> open(later);
  const auto visit = [&](std::uint32_t node) {
    if (nodes_[node].box.overlaps(box)) open.push({nodes_[node].least, node, false});
  };
  visit(0);
  while (!open.empty() && found.size() < most) {
    const Entry next = open.top();
    open.pop();
    if (next.is_box) {
      found.push_back(next.least);
      continue;
    }
    const Node& node = nodes_[next.node];
    if (node.right != 0) {
      visit(next.node + 1);
      visit(node.right);
      continue;
    }
    for (auto i = node.first; i < node.last; ++i)
      if (boxes_[order_[i]].overlaps(box) && accept(order_[i])) open.push({order_[i], 0, true});
  }
  return found;
}

}  // namespace mansard::geometry
