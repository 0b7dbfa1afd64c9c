// The plan as the kernel takes it in, and the coarser versions of it that the ladder steps down to.
#pragma once

#include <optional>

#include "mansard/extrude/detail/footprint.hpp"

namespace mansard::extrude::detail {

/// m; no cap is higher. Heights in quanta stay below 2^33, where plane.cpp has room for 2^38 (`widest`).
inline constexpr double highest_cap = 1e5;

/// Oriented, repeated points dropped. Fails with "extrude-profile", "extrude-cap", "extrude-not-simple",
/// "extrude-no-area", and says where (the plan's edge numbers and coordinates) and what to do. Simple is decided
/// exactly; points within 2^-36 m of each other are one.
[[nodiscard]] auto prepared(const model::Plan& plan) -> base::Result<Source>;

/// Without details under `size` metres: corners nearer than that to the line past them, holes that small. Edges keep
/// the profile of the longer one they came from. Still simple.
[[nodiscard]] auto simplified(Source source, double size) -> Source;

/// Every profile reduced to its wall and one mean pitch.
[[nodiscard]] auto two_part(Source source) -> Source;

/// Vertical walls over the rings, flat below and above.
[[nodiscard]] auto prism_of(const Source& source, double base, double cap) -> model::Solid;

}  // namespace mansard::extrude::detail
