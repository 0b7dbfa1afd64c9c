// Robust straight lines through heights over a distance: what a roof plane is, seen along its edge.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
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

/// Running sums: entry i is of the looks before i.
[[nodiscard]] auto sums_along(std::span<const Look> looks) -> std::vector<geometry::LineSums>;

/// What suits the looks before a place; those behind it have a line.
enum class Before : std::uint8_t { line, level };

/// Where looks may be parted.
struct Within {
  std::size_t fewest_before = 1, fewest_behind = 1;
  double from = 0, to = std::numeric_limits<double>::infinity();  ///< m inward
};

/// Looks parted in two.
struct Parting {
  std::size_t at = 0;  ///< the first look behind the place
  double left = 0;     ///< m²: what both leave of the squares
};

/// The parting that leaves least; none where none leaves less than `least`. `sums` along the looks, which are nearest
/// first. Cost: O(looks).
[[nodiscard]] auto best_parting(std::span<const Look> looks, std::span<const geometry::LineSums> sums, Before before,
                                const Within& within, double least) -> std::optional<Parting>;

/// Of what is left beyond the noise. A parting that explains less is of something else: a chimney, the edge of another
/// roof. Docs/decisions/0160-planes-that-bend.md.
constexpr double explained = 0.75;

/// Of the smallest detail: what is nearer than that to a plane on average is of no interest.
constexpr double of_detail = 0.5;

/// The median: looks where a level strip ends see some of the wall behind it.
[[nodiscard]] auto middle_height(std::span<const Look> looks) -> double;

}  // namespace mansard::refine::detail
