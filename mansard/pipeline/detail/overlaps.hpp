// Solids that overlap: no fault of any of them, and yet nothing that a city can be.
#pragma once

#include <vector>

#include "mansard/pipeline/pipeline.hpp"

namespace mansard::pipeline::detail {

/// Says of every two parts whose ground floors share more than a strip as wide as the rounding, and whose heights do,
/// what they share: "pipeline-overlap" among the reasons of both buildings, and once for all among the warnings.
/// Two parts whose ground cannot be intersected are reported in the same places as "pipeline-overlap-unchecked".
/// `buildings[i]` is the report on `city.buildings[i]`. Overhanging eaves are not looked at.
void report_overlaps(report::Reconstruction& reconstruction);

}  // namespace mansard::pipeline::detail
