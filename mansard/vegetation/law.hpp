// What tells crowns from roofs in a scan of a given noise.
#pragma once

#include "mansard/model/accuracy.hpp"
#include "mansard/vegetation/vegetation.hpp"

namespace mansard::vegetation {

/// The options with everything that follows from the accuracy of the scan (docs/accuracy.md). Called before find.
[[nodiscard]] auto decided_by(Options options, const model::Accuracy& accuracy) -> Options;

}  // namespace mansard::vegetation
