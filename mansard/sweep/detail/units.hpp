// What lengths and areas are compared by where they only give an order.
#pragma once

#include <cmath>
#include <cstdint>

namespace mansard::sweep::detail {

/// A length in cm, an area in hundredths of m². Walls go up many slices with one length, so that without this rounding
/// would choose between their lines (decision 35); so something that does not depend on it decides. Two values that a
/// micrometre parts are in one unit but in one case of ten thousand.
[[nodiscard]] inline auto in_units(double value) -> std::int64_t { return std::llround(value * 1e2); }

}  // namespace mansard::sweep::detail
