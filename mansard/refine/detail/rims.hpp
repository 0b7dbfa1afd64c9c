// Parapets: a strip all around a part that is higher than the roof within it. Profiles only climb, so that no plan has
// one; the strip is a part of its own.
#pragma once

#include <vector>

#include "mansard/refine/detail/propose.hpp"
#include "mansard/refine/detail/view.hpp"

namespace mansard::refine::detail {

/// What lies within such a strip, as a piece of the part that explains at least `least_gain`, m²·m²; none, or one.
/// Along a wall that is drawn beside its place a strip is higher, too, but on one or two sides.
/// Cost: samples × edges.
[[nodiscard]] auto within_rims(const Site& site, const View& roof, double least_gain, const Options& options)
    -> std::vector<Proposal>;

}  // namespace mansard::refine::detail
