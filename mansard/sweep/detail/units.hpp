// What lengths and areas are compared by where they only give an order.
#pragma once

#include <cmath>
#include <cstdint>
#include <tuple>

#include "mansard/geometry/points.hpp"

namespace mansard::sweep::detail {

/// A length in cm, an area in hundredths of m². Walls go up many slices with one length, so that without this rounding
/// would choose between their lines (decision 35); so something that does not depend on it decides. Two values that a
/// micrometre parts are in one unit but in one case of ten thousand.
[[nodiscard]] inline auto in_units(double value) -> std::int64_t { return std::llround(value * 1e2); }

/// An order of segments by their places in cm, then exactly: that of the ends of walls that start on one line of a
/// raster would be rounding's choice.
[[nodiscard]] inline auto comes_before(const geometry::Segment2& a, const geometry::Segment2& b) -> bool {
  const auto place = [](const geometry::Segment2& s) {
    return std::tuple(in_units(s.start.x), in_units(s.start.y), in_units(s.end.x), in_units(s.end.y));
  };
  return place(a) != place(b) ? place(a) < place(b) : a < b;
}

}  // namespace mansard::sweep::detail
