// The polygons that the benchmark runs on: generic ones, and ones full of ties, at any number of corners.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mansard/base/run.hpp"
#include "mansard/model/plan.hpp"

namespace mansard::bench {

/// A star around the origin with spikes of very different lengths: no ties, half its corners reflex. Corners lie
/// between a third of and the whole radius, 12 m at 16 corners and growing with their number to the power of 3/4, so
/// that the gaps between the spikes stay wider than the tolerance of a canonical footprint.
[[nodiscard]] auto star(base::Random& random, std::size_t corners) -> geometry::Ring;

/// The outline of a branching set of cells of 3 m without holes: at least that many corners, all edges along the axes
/// and a multiple of 3 m long, so that nearly every event happens together with many others.
[[nodiscard]] auto grid(base::Random& random, std::size_t corners) -> geometry::Ring;

/// Every corner moved by up to a quarter of a cell in x and in y: what was tied no longer is. Stays simple.
[[nodiscard]] auto jittered(base::Random& random, geometry::Ring ring) -> geometry::Ring;

[[nodiscard]] auto turned(geometry::Ring ring, double angle) -> geometry::Ring;

/// A house of 8 to 20 corners: a body with wings and bays at right angles, some corners cut off; turned.
[[nodiscard]] auto house(base::Random& random) -> geometry::Ring;

/// A footprint of 4 to 10 corners as they come by the thousand: a box, an L, a T or a bay, sides within 1 % of square.
[[nodiscard]] auto small_footprint(base::Random& random) -> geometry::Ring;

/// One profile for all edges; what is left at `cap` becomes flat.
[[nodiscard]] auto plan_of(geometry::Ring ring, model::Profile profile, double cap = 10'000) -> model::Plan;

/// A mansard on most edges, upright gables and plain pitches on the others; corners in the order given.
[[nodiscard]] auto mixed_plan_of(base::Random& random, geometry::Ring ring) -> model::Plan;

inline const model::Profile hip{{0, 0}, {0, 3}, {1, 4}};
inline const model::Profile mansard{{0, 0}, {0, 6}, {0.8, 8.4}, {3.8, 9.6}};

}  // namespace mansard::bench
