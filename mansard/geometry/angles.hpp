// Trigonometry with the same digits on every x86-64 processor.
#pragma once

#include <cmath>

namespace mansard::geometry {

/// glibc chooses among variants of sin, cos, tan, atan2, acos and exp by the processor: with and without fused
/// multiply-add, and their last bits differ. Its functions of long double have one variant only, with 11 bits more than
/// a double; rounded to double they are right in all but about one of 2000 cases, and the same everywhere. A decision
/// in the engine takes its angles from here.
[[nodiscard]] inline auto sine(double x) -> double {
  return static_cast<double>(std::sin(static_cast<long double>(x)));
}
[[nodiscard]] inline auto cosine(double x) -> double {
  return static_cast<double>(std::cos(static_cast<long double>(x)));
}
[[nodiscard]] inline auto tangent(double x) -> double {
  return static_cast<double>(std::tan(static_cast<long double>(x)));
}
[[nodiscard]] inline auto arc_tangent(double y, double x) -> double {
  return static_cast<double>(std::atan2(static_cast<long double>(y), static_cast<long double>(x)));
}
[[nodiscard]] inline auto arc_cosine(double x) -> double {
  return static_cast<double>(std::acos(static_cast<long double>(x)));
}
[[nodiscard]] inline auto exponential(double x) -> double {
  return static_cast<double>(std::exp(static_cast<long double>(x)));
}

}  // namespace mansard::geometry
