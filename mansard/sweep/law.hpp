// What belongs to a wall's line, for the noise that the scan has.
#pragma once

#include "mansard/model/accuracy.hpp"
#include "mansard/sweep/options.hpp"

namespace mansard::sweep {

/// The options with everything that follows from the accuracy of the scan (docs/accuracy.md). Called before
/// find_edges.
[[nodiscard]] auto decided_by(Options options, const model::Accuracy& accuracy) -> Options;

}  // namespace mansard::sweep
