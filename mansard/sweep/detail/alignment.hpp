// Turns lines to the GIS.
#pragma once

#include <vector>

#include "mansard/block/block.hpp"
#include "mansard/sweep/detail/line_index.hpp"
#include "mansard/sweep/sweep.hpp"

namespace mansard::sweep::detail {

/// The footprints' edges, prepared for queries.
class GisEdges {
 public:
  GisEdges(const block::Block& block, const Options& options);

  /// The line turned about its midpoint to the direction of the GIS edge it most likely follows, or perpendicular to
  /// one; unchanged when there is none.
  [[nodiscard]] auto aligned(const geometry::Segment2& line) const -> geometry::Segment2;

 private:
  Options options_;
  std::vector<geometry::Segment2> edges_;
  LineIndex index_;
};

}  // namespace mansard::sweep::detail
