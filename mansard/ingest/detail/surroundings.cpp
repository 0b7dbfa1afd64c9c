#include "mansard/ingest/detail/surroundings.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "mansard/geometry/polygon.hpp"

namespace mansard::ingest::detail {
namespace {

using geometry::Box2;
using geometry::Point2;
using geometry::Ring;
using geometry::Segment2;

auto side(const Ring& ring, std::size_t i) -> Segment2 { return {ring[i], ring[(i + 1) % ring.size()]}; }

auto near(const Segment2& a, const Segment2& b) -> bool {
  return std::min({geometry::distance(a, b.start), geometry::distance(a, b.end), geometry::distance(b, a.start),
                   geometry::distance(b, a.end)}) <= touching;
}

auto near(const Ring& a, const Ring& b, const Box2& within) -> bool {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Segment2 edge = side(a, i);
    const Box2 reach = Box2::of(edge).grown(touching);
    if (!reach.overlaps(within)) continue;
    for (std::size_t k = 0; k < b.size(); ++k)
      if (const Segment2 other = side(b, k); reach.overlaps(Box2::of(other)) && near(edge, other)) return true;
  }
  return false;
}

/// Rings may be broken here: what is inside is not asked exactly, and one that crosses another without an end near it
/// is near enough to some side of it in every building there is; if not, it is inside.
auto touch(const formats::RawFeature& a, const formats::RawFeature& b, const Box2& box_b) -> bool {
  for (const auto& part : a.parts)
    for (const auto& ring : part)
      for (const auto& other_part : b.parts)
        for (const auto& other : other_part)
          if (!ring.empty() && !other.empty() &&
              (near(ring, other, box_b.grown(touching)) || geometry::contains(ring, other.front()) ||
               geometry::contains(other, ring.front())))
            return true;
  return false;
}

}  // namespace

void close_under_touching(const std::vector<formats::RawFeature>& features, std::vector<bool>& marked) {
  std::vector<Box2> boxes;
  double widest = 0;
  for (const auto& feature : features) {
    boxes.push_back(bounds(feature));
    if (!boxes.back().empty()) widest = std::max(widest, boxes.back().most.x - boxes.back().least.x);
  }
  std::vector<std::size_t> order(features.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return std::pair(boxes[i].least.x, i); });
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < features.size(); ++i)
    if (marked[i]) open.push_back(i);
  while (!open.empty()) {
    const std::size_t i = open.back();
    open.pop_back();
    if (boxes[i].empty()) continue;
    const Box2 reach = boxes[i].grown(touching);
    auto at =
        std::ranges::lower_bound(order, reach.least.x - widest, {}, [&](std::size_t j) { return boxes[j].least.x; });
    for (; at != order.end() && boxes[*at].least.x <= reach.most.x; ++at) {
      if (marked[*at] || !reach.overlaps(boxes[*at]) || !touch(features[i], features[*at], boxes[*at])) continue;
      marked[*at] = true;
      open.push_back(*at);
    }
  }
}

}  // namespace mansard::ingest::detail
