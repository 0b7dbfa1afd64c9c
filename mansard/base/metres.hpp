// Lengths in sentences.
#pragma once

#include <string>

#include "mansard/base/text.hpp"

namespace mansard::base {

/// "1.5 m".
[[nodiscard]] inline auto metres(double length) -> std::string { return to_text(length, 1) + " m"; }

}  // namespace mansard::base
