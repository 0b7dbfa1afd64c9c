// Overhanging eaves: the one step of an extrusion that goes outwards, taken before the sweep.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mansard/extrude/detail/footprint.hpp"

namespace mansard::extrude::detail {

/// At the height of the soffit the roofs that rise from the lowest eaves begin, as far out as their pitch has it.
struct Eaves {
  std::int64_t soffit = 0;                        ///< quanta above the base
  std::vector<std::vector<bool>> overhangs;       ///< by ring and edge
  std::vector<std::vector<CanonicalEdge>> rings;  ///< the outline at the soffit
};

/// The eaves of a footprint whose edges all rise upright at first. The edge of the shallowest pitch among the lowest
/// eaves overhangs by `Options::overhang`, steeper ones by less. Nothing, and why, when that cannot be; no reason when
/// no roof rises from a wall below the cap. `why` is also set when eaves at other heights stay as they are.
[[nodiscard]] auto eaves_of(const Footprint& footprint, const Rational& cap, const Options& options, std::string& why)
    -> std::optional<Eaves>;

}  // namespace mansard::extrude::detail
