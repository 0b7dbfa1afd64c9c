// Where the wall of a cluster stands.
#pragma once

#include <vector>

#include "mansard/slice/slice.hpp"
#include "mansard/sweep/detail/clusters.hpp"

namespace mansard::sweep::detail {

/// A stretch of wall foot, or of gutter where no wall was seen.
struct Base {
  geometry::Segment2 segment;  ///< outside on the left
  double area = 0;             ///< m²: its columns' share of the cluster
  double low = 0, high = 0;    ///< z, m
  bool wall = false;           ///< stands on a vertical part of a metre or more
};

/// The main bases of a cluster and those that stand off its median by a setback; none when nothing has a length.
/// `lines` from below upwards.
[[nodiscard]] auto find_bases(const std::vector<WeighedLine>& lines, const slice::SliceStack& stack, double ground,
                              const Options& options) -> std::vector<Base>;

}  // namespace mansard::sweep::detail
