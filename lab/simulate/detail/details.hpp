// What makes houses less plain: dormers, plant rooms, bay windows, rear extensions, overhanging eaves.
#pragma once

#include <vector>

#include "lab/simulate/detail/lots.hpp"

namespace mansard::simulate::detail {

/// Adds what the options ask for to the houses whose first lot is a rectangle. Draws from a seed of its own, so that
/// the houses themselves are the same with and without.
void add_details(std::vector<House>& houses, const BlockOptions& options, std::uint64_t seed);

}  // namespace mansard::simulate::detail
