// The diagnostics that writers of buildings, and readers of what they wrote, fail with.
#pragma once

#include <vector>

#include "mansard/base/result.hpp"

namespace mansard::formats {

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::formats
