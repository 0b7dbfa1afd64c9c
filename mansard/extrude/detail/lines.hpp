// From a source outline to exact lines: one pass, with so much care.
#pragma once

#include <optional>
#include <string>

#include "mansard/extrude/detail/footprint.hpp"

namespace mansard::extrude::detail {

/// No edge is shorter, m; and unless there is no other way, none is that does not lie on exact lines already. The first
/// is 1 µm: a sixteenth of a quantum, and 500 times what corners in doubles are off by (2⁻³⁰ m for outlines 4,000 km
/// wide). The second is four quanta: an edge whose ends are rounded to the grid keeps its direction to a quarter.
inline constexpr double shortest = 0x1.0p-20, shortest_made = 0x1.0p-14;

struct Care {
  double straighten = 0;  ///< m; corners at shallow turns go that stray from a chord by no more
  double least = 0;       ///< m; edges that would come out shorter go
};

/// As canonical(), in one pass.
[[nodiscard]] auto put_on_lines(const Source& source, const Options& options, const Care& care, std::string& why)
    -> std::optional<Footprint>;

}  // namespace mansard::extrude::detail
