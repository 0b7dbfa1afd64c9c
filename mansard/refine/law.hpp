// The law by which refine decides: what a number must explain to be real, for the noise that the scan has.
#pragma once

#include "mansard/model/accuracy.hpp"
#include "mansard/refine/options.hpp"

namespace mansard::refine {

/// The options with everything that follows from the accuracy of the scan: prices, margins, tolerances
/// (docs/accuracy.md derives them). Called before refine.
[[nodiscard]] auto decided_by(Options options, const model::Accuracy& accuracy) -> Options;

}  // namespace mansard::refine
