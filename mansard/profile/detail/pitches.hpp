// One clean profile from pooled columns: a vertical wall, then one to three pitches.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mansard/model/plan.hpp"
#include "mansard/profile/detail/columns.hpp"

namespace mansard::profile::detail {

/// A roof line that bends upwards or downwards at its inner points; at least two points, `height` above the base.
using RoofLine = std::vector<model::ProfilePoint>;

/// The continuous piecewise linear function with at most `most` (1 to 3) pieces that explains the columns best, a
/// further piece having to earn its place. Empty for fewer than four columns. Cost: O(n²) for n columns.
[[nodiscard]] auto fit_line(std::span<const Pooled> columns, std::size_t most) -> RoofLine;

struct SupportOptions {
  double share = 0.2;       ///< of all slices
  double tolerance = 0.3;   ///< m; a slice within it, over half of what it shows of a piece, supports the piece
  double low_height = 2.0;  ///< m above ground; below, the tolerance is five times as wide
};
/// Cuts the line off at the first piece without enough support.
[[nodiscard]] auto supported(RoofLine line, std::span<const SliceColumns> slices, const SupportOptions& options)
    -> RoofLine;

/// The line under the urban prior: wall up to the gutter, then pitches that never fall; pieces within `vertical_angle`
/// of vertical become wall; nearly level ends are left to the cap. Just a wall when nothing remains.
[[nodiscard]] auto profile_from(const RoofLine& line, double vertical_angle) -> model::Profile;

/// A wall of that height, metres.
[[nodiscard]] auto vertical_profile(double height) -> model::Profile;

}  // namespace mansard::profile::detail
