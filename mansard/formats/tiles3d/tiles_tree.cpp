#include "mansard/formats/tiles3d/tiles_tree.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace mansard::formats::detail {
namespace {

struct Range {
  std::size_t first = 0, count = 0;
};

class Builder {
 public:
  Builder(const std::vector<TileItem>& items, double most) : items_(&items), most_(most) {
    tree_.order.resize(items.size());
    std::iota(tree_.order.begin(), tree_.order.end(), 0U);
  }

  auto made() -> TileTree {
    tree_.tiles.push_back({0, items_->size(), {}, {}});
    for (std::size_t t = 0; t < tree_.tiles.size(); ++t) divide(t);
    return std::move(tree_);
  }

 private:
  auto triangles(Range r) const -> double {
    double sum = 0;
    for (std::size_t i = r.first; i < r.first + r.count; ++i) sum += (*items_)[tree_.order[i]].triangles;
    return sum;
  }

  /// Two ranges that are not empty.
  auto halves(Range r) -> std::array<Range, 2> {
    const auto begin = tree_.order.begin() + static_cast<std::ptrdiff_t>(r.first);
    const auto end = begin + static_cast<std::ptrdiff_t>(r.count);
    geometry::Box2 box;
    for (auto i = begin; i != end; ++i) box.add((*items_)[*i].centre);
    const bool across_x = box.most.x - box.least.x >= box.most.y - box.least.y;
    std::sort(begin, end, [&](std::uint32_t a, std::uint32_t b) {
      const auto &p = (*items_)[a].centre, &q = (*items_)[b].centre;
      const double u = across_x ? p.x : p.y, v = across_x ? q.x : q.y;
      return u != v ? u < v : a < b;
    });
    const double half = triangles(r) / 2;
    std::size_t count = 0;
    for (double sum = 0; count + 1 < r.count && (count == 0 || sum < half); ++count)
      sum += (*items_)[tree_.order[r.first + count]].triangles;
    return {Range{r.first, count}, Range{r.first + count, r.count - count}};
  }

  void divide(std::size_t t) {
    const Range all{tree_.tiles[t].first, tree_.tiles[t].count};
    if (all.count < 2 || triangles(all) <= most_) return;
    std::vector<Range> quarters;
    for (const Range& half : halves(all)) {
      if (half.count < 2 || triangles(half) <= most_) {
        quarters.push_back(half);
        continue;
      }
      for (const Range& quarter : halves(half)) quarters.push_back(quarter);
    }
    for (const Range& quarter : quarters) {
      Tile child{quarter.first, quarter.count, {}, tree_.tiles[t].path};
      child.path.push_back(static_cast<std::uint8_t>(tree_.tiles[t].children.size()));
      tree_.tiles[t].children.push_back(tree_.tiles.size());
      tree_.tiles.push_back(std::move(child));
    }
  }

  const std::vector<TileItem>* items_;
  double most_;
  TileTree tree_;
};

}  // namespace

auto tile_tree(const std::vector<TileItem>& items, double triangles) -> TileTree {
  return Builder(items, triangles).made();
}

}  // namespace mansard::formats::detail
