// The unit in which the definitions of the form scores are written.
#pragma once

#include <numbers>

namespace mansard::evaluate::detail {

inline constexpr double degree = std::numbers::pi / 180;

}  // namespace mansard::evaluate::detail
