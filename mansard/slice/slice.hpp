// Cuts a block's mesh by horizontal planes.
#pragma once

#include <vector>

#include "mansard/base/options.hpp"
#include "mansard/base/run.hpp"
#include "mansard/block/block.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::slice {

struct Slice {
  double height = 0;                         ///< z, metres, local frame
  std::vector<geometry::Segment2> segments;  ///< directed so that outside is on the left (for outward triangles)
};

struct SliceStack {
  double interval = 0.2;      ///< m
  std::vector<Slice> slices;  ///< from below upwards, at ground + (i + ½) · interval
};

struct Options {
  double interval = 0.2;  ///< m between slices
  /// m above ground; higher vertices belong to a broken mesh; no building is 10 km high
  static constexpr double maximum_height = 10000.0;
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

/// Slices from the block's ground to the top of its mesh. A vertex on a plane counts as above it: one rule, so a
/// closed mesh gives closed curves. Guarantees: 1 every segment lies on its plane and on one triangle · 2 the order of
/// segments is the order of triangles, at any thread count · 3 a watertight mesh gives as many segment starts as ends
/// at each point. Cost: O(triangles + segments): each triangle is touched only by the slices that cross it.
[[nodiscard]] auto cut(const block::Block& block, const Options& options, const base::Run& run = {}) -> SliceStack;

}  // namespace mansard::slice
