// The strip along the boundary of polygons.
#pragma once

#include <span>
#include <vector>

#include "mansard/evaluate/detail/grid.hpp"

namespace mansard::evaluate::detail {

/// Places no farther than `width` metres from the boundary of polygons, on either side of it.
class Strip {
 public:
  /// Along the boundary of each polygon. Without width there are no such places.
  [[nodiscard]] static auto along_each(std::span<const geometry::Polygon> polygons, double width) -> Strip;
  /// Along the boundary of their union, gaps under 0.1 m closed. Fails as geometry::unite does.
  [[nodiscard]] static auto along_union(std::span<const geometry::Polygon> polygons, double width)
      -> base::Result<Strip>;
  /// Per column of row `j`: whether its centre is in the strip.
  [[nodiscard]] auto row(const Grid& grid, std::int64_t j) const -> std::vector<bool>;

 private:
  std::vector<geometry::Segment2> boundary_;
  double width_ = 0;
};

}  // namespace mansard::evaluate::detail
