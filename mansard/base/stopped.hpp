// The failure of a run that was stopped on request.
#pragma once

#include "mansard/base/result.hpp"

namespace mansard::base {

/// What every stage returns where `Run::cancelled()`: until results are committed, none of them is in its place.
[[nodiscard]] inline auto stopped() -> Diagnostic {
  return error("cancelled", "stopped on request; nothing was written");
}

}  // namespace mansard::base
