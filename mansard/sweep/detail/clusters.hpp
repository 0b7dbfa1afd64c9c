// Lines of neighbouring slices that follow one side of a building.
#pragma once

#include <vector>

#include "mansard/base/run.hpp"
#include "mansard/sweep/sweep.hpp"

namespace mansard::sweep::detail {

/// A line and how much it is to be believed.
struct WeighedLine {
  Line line;
  double length = 0;  ///< m
  double good = 0;    ///< m; what is left of the length after the bus filter
};

/// Lines by slice.
using LineStack = std::vector<std::vector<WeighedLine>>;

/// Takes from each line's `good` length what faces the other side of a thin object (buses, fences) in its own slice.
void weigh_thin(std::vector<WeighedLine>& lines, const Options& options);

/// Grows clusters from the best line left (what is left of its length; ties by height and coordinates), so that the
/// result does not depend on any order of its input. Lines from below upwards.
[[nodiscard]] auto grow_clusters(const LineStack& stack, const Options& options, const base::Run& run)
    -> std::vector<std::vector<WeighedLine>>;

}  // namespace mansard::sweep::detail
