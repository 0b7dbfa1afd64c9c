// What follows from the accuracy of a scan, for all stages after it was measured.
#pragma once

#include "mansard/pipeline/pipeline.hpp"

namespace mansard::pipeline::detail {

/// The options with everything that follows from the accuracy of the scan (docs/accuracy.md). `docs/pipeline.md` says
/// which options of one module set numbers of another.
[[nodiscard]] auto decided_by(Options options, const model::Accuracy& accuracy) -> Options;

}  // namespace mansard::pipeline::detail
