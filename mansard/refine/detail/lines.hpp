// Robust straight lines through heights over a distance: what a roof plane is, seen along its edge.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mansard/geometry/fit.hpp"
#include "mansard/refine/options.hpp"

namespace mansard::refine::detail {

struct Look {
  double inward = 0, height = 0;  ///< m
  double weight = 1;
};

/// height = at_edge + slope · inward.
struct RoofLine {
  double at_edge = 0;  ///< m
  double slope = 0;    ///< m per m
};

/// The line with the least sum of weighed robust squares, from `start`. None where the looks are too few or lie within
/// too narrow a band to give a slope.
[[nodiscard]] auto line_through(std::span<const Look> looks, RoofLine start, const Options::Lines& options)
    -> std::optional<RoofLine>;
/// The same with the slope given: the weighed robust height at the edge.
[[nodiscard]] auto raised_line(std::span<const Look> looks, RoofLine start, const Options::Lines& options) -> RoofLine;

/// m²: sums of some thousand squares of up to 100 m² are exact to 1e-10.
constexpr double same_rest = 1e-9;

/// Running sums: entry i is of the looks before i.
[[nodiscard]] auto sums_along(std::span<const Look> looks) -> std::vector<geometry::LineSums>;

/// The median: looks where a level strip ends see some of the wall behind it.
[[nodiscard]] auto middle_height(std::span<const Look> looks) -> double;

}  // namespace mansard::refine::detail
