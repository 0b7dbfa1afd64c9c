// The local metric frame, and the files that a result was made from.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>

namespace mansard::model {

/// From local to file coordinates: add the origin. The origin is whole metres, so that adding and taking off is exact
/// for coordinates that are multiples of 2^-20 m, and for every coordinate at least as far from zero as from the
/// origin.
struct Frame {
  std::array<std::int64_t, 3> origin{0, 0, 0};
  std::string crs;  ///< "EPSG:n" where known, WKT otherwise, empty for a local frame
};

/// What is computed from footprints and meshes starts from coordinates rounded to whole multiples of this, in metres:
/// such coordinates can be shifted by whole metres without a rounding, up to 2³² m, so that the same data at another
/// place have the same digits. One micrometre is a thousandth of what any scan or survey resolves.
inline constexpr double coordinate_unit = 0x1p-20;

/// To the nearest or second nearest whole multiple of `unit`, a power of two: what is more than 0.382 units above one
/// goes up. A shift by whole units does not matter. Halves, quarters and tenths of a unit are frequent in files of
/// floats and decimals; with the limit at the golden section none of them is near to it, so that the last digit of a
/// file seldom decides.
[[nodiscard]] inline auto rounded(double value, double unit = coordinate_unit) -> double {
  constexpr double golden = 0.6180339887498949;
  return std::floor(value / unit + golden) * unit;
}

struct InputFile {
  std::string path;
  std::uint64_t bytes = 0;
  std::string sha256;
};

}  // namespace mansard::model
