// The bounds of options in words.
#pragma once

#include <string>

namespace mansard::base {

/// A bound as people write it: 1e6 rather than 1e+06.
[[nodiscard]] auto bound_text(double bound) -> std::string;

}  // namespace mansard::base
