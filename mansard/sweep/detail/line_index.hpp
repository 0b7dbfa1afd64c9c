// Finds segments near a box.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "mansard/geometry/points.hpp"

namespace mansard::sweep::detail {

/// A grid of cells kept as a sorted vector: no iteration order but the cells' own.
class LineIndex {
 public:
  LineIndex() = default;
  LineIndex(const std::vector<geometry::Segment2>& lines, double cell) : cell_(cell) {
    for (std::uint32_t i = 0; i < lines.size(); ++i) {
      boxes_.push_back(geometry::Box2::of(lines[i]));
      const auto [x0, y0, x1, y1] = cells(boxes_.back());
      for (auto y = y0; y <= y1; ++y)
        for (auto x = x0; x <= x1; ++x) entries_.push_back({{y, x}, i});
    }
    std::sort(entries_.begin(), entries_.end());
  }

  /// Indices, ascending, of the segments whose boxes overlap this one.
  [[nodiscard]] auto near(const geometry::Box2& box) const -> std::vector<std::uint32_t> {
    std::vector<std::uint32_t> found;
    if (entries_.empty()) return found;
    const auto [x0, y0, x1, y1] = cells(box);
    for (auto y = y0; y <= y1; ++y) {
      auto at = std::lower_bound(entries_.begin(), entries_.end(), Entry{{y, x0}, 0});
      for (; at != entries_.end() && at->first <= std::pair{y, x1}; ++at)
        if (boxes_[at->second].overlaps(box)) found.push_back(at->second);
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

 private:
  using Entry = std::pair<std::pair<std::int32_t, std::int32_t>, std::uint32_t>;
  struct Cells {
    std::int32_t x0, y0, x1, y1;
  };
  [[nodiscard]] auto cells(const geometry::Box2& box) const -> Cells {
    const auto of = [this](double v) {
      return static_cast<std::int32_t>(std::clamp(std::floor(v / cell_), -1e9, 1e9));
    };
    return {of(box.least.x), of(box.least.y), of(box.most.x), of(box.most.y)};
  }

  double cell_ = 8;
  std::vector<geometry::Box2> boxes_;
  std::vector<Entry> entries_;
};

}  // namespace mansard::sweep::detail
