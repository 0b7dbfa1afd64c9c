// One clean profile from pooled columns: a vertical wall, then one to three pitches.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mansard/model/plan.hpp"
#include "mansard/profile/detail/columns.hpp"
#include "mansard/profile/options.hpp"

namespace mansard::profile::detail {

/// A roof line that bends upwards or downwards at its inner points; at least two points, `height` above the base.
using RoofLine = std::vector<model::ProfilePoint>;

/// The continuous piecewise linear function with at most `most` (1 to 3) pieces that explains the columns best, a
/// further piece having to earn its place. Empty for fewer than four columns. Cost: O(n²) for n columns.
[[nodiscard]] auto fit_line(std::span<const Pooled> columns, std::size_t most, const Options& options = {}) -> RoofLine;

/// Cuts the line off at the first piece without enough support. A slice supports a piece when it lies within
/// `tolerance` metres of it, more near the ground, over half of what it shows of it.
[[nodiscard]] auto supported(RoofLine line, std::span<const SliceColumns> slices, double tolerance,
                             const Options& options = {}) -> RoofLine;

/// The line under the urban prior: wall up to the gutter, then pitches that never fall; pieces within `vertical_angle`
/// of vertical become wall; nearly level ends are left to the cap. Just a wall when nothing remains.
[[nodiscard]] auto profile_from(const RoofLine& line, const Options& options = {}) -> model::Profile;

/// A wall of that height, metres.
[[nodiscard]] auto vertical_profile(double height, const Options& options = {}) -> model::Profile;

}  // namespace mansard::profile::detail
