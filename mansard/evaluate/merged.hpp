// Error maps of any number as one.
#pragma once

#include <functional>

#include "mansard/base/result.hpp"
#include "mansard/evaluate/evaluate.hpp"

namespace mansard::evaluate {

/// Calls its argument with one map after the other, in the same order each time.
using EachMap = std::function<base::Result<void>(const std::function<void(const ErrorMap&)>&)>;

/// As merged, of maps of which one at a time is in memory; goes through them twice. Fails as `each` does.
[[nodiscard]] auto merged_from(const EachMap& each, std::size_t most) -> base::Result<ErrorMap>;

}  // namespace mansard::evaluate
