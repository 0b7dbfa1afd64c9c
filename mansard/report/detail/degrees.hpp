// Radians as degrees, for files and pictures.
#pragma once

#include <numbers>

namespace mansard::report::detail {

[[nodiscard]] inline auto degrees(double radians) -> double { return radians * 180 / std::numbers::pi; }

}  // namespace mansard::report::detail
