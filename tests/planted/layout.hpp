// Where the houses of a planted block stand, and how high. In the block's own frame: streets run along its axes and
// coordinates are multiples of 1/8 m, so that walls coincide exactly.
#pragma once

#include <vector>

#include "planted.hpp"

namespace mansard::planted {

[[nodiscard]] auto houses_of(const Recipe& recipe) -> std::vector<House>;

/// Walls between houses of that frame, by (left, right).
[[nodiscard]] auto walls_between(const std::vector<House>& houses) -> std::vector<Wall>;

/// A wall that can be seen from outside or over a lower neighbour.
struct Visible {
  geometry::Segment2 segment;  ///< outside, or the lower side, on the left
  double low = 0, high = 0;    ///< m; between which it can be seen
  double area = 0;             ///< m²
};
/// Walls in one line with each other are one.
[[nodiscard]] auto visible_walls(const std::vector<House>& houses, const std::vector<Wall>& walls, double seen_step)
    -> std::vector<Visible>;

/// A standard normal number, nearly: the same on every platform.
[[nodiscard]] inline auto normal(base::Random& random) -> double {
  double sum = -6;
  for (int k = 0; k < 12; ++k) sum += random.uniform();
  return sum;
}

}  // namespace mansard::planted
